// SPDX-License-Identifier: BSD-3-Clause
//
// The oracle of the tables, by definition: components and Euler characteristics of the high and of the low part of the
// boundary of a cube or another polytope, from the signs of its corners and the centres of its ambiguous squares. It
// shares no code with the builders of the tables.
//
// Each component of a part within a face of the polytope is contractible: a point, an edge or a piece of one, and for a
// polygon or a 3-face a region of a ball that disjoint discs cut. So the part has the homotopy type of the order
// complex of its components in all proper faces, ordered by inclusion (the nerve of a cover by contractible sets whose
// intersections are such sets again).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace tegl::test {

/// A set of corners, bit v for corner v. In an n-cube, n <= 5, it has coordinate v >> a & 1 along axis a.
using Corners = std::uint32_t;

/// Merges sets that have a corner in common.
inline std::vector<Corners> merged(std::vector<Corners> sets) {
  std::vector<Corners> result;
  for (Corners set : sets) {
    std::erase_if(result, [&](Corners other) {
      const bool meets = (other & set) != 0;
      if (meets) set |= other;
      return meets;
    });
    result.push_back(set);
  }
  return result;
}

/// A face of a polytope.
struct PolytopeFace {
  int dim;
  Corners corners;
  unsigned base = 0, axes = 0;        ///< of a cube
  std::vector<std::size_t> facets{};  ///< of one dimension less
  std::vector<std::size_t> below{};   ///< all proper faces
};

/// The faces of the n-cube, by dimension; the cube is the last.
struct CubeFaces {
  using Face = PolytopeFace;
  std::vector<Face> faces;

  explicit CubeFaces(int n) {
    for (int dim = 0; dim <= n; ++dim)
      for (unsigned axes = 0; axes < 1u << n; ++axes)
        for (unsigned base = 0; base < 1u << n; ++base)
          if (std::popcount(axes) == dim && (base & axes) == 0) {
            Corners corners = 0;
            for (unsigned v = 0; v < 1u << n; ++v) corners |= Corners{(v & ~axes) == base} << v;
            faces.push_back({dim, corners, base, axes});
          }
    for (Face& face : faces)
      for (std::size_t other = 0; other < faces.size(); ++other) {
        const auto [base, axes] = std::pair(faces[other].base, faces[other].axes);
        if (axes == face.axes || (axes & ~face.axes) != 0 || ((base ^ face.base) & ~face.axes) != 0) continue;
        face.below.push_back(other);
        if (std::popcount(axes) + 1 == std::popcount(face.axes)) face.facets.push_back(other);
      }
  }
  static const std::vector<Face>& of(int n) {
    static const std::vector<CubeFaces> all = {CubeFaces(0), CubeFaces(1), CubeFaces(2), CubeFaces(3), CubeFaces(4)};
    return all[static_cast<std::size_t>(n)].faces;
  }
};

/// The part of the boundary of an n-cube, n = 1 to 4, or of a polytope that contains the corners `inside`.
class BoundaryPart {
 public:
  /// Whether the centre of the ambiguous square along `axes` from corner `base` is in the part.
  using HasCentre = std::function<bool(unsigned base, unsigned axes)>;

  BoundaryPart(int n, Corners inside, const HasCentre& has_centre)
      : BoundaryPart(CubeFaces::of(n), inside,
                     [&](const PolytopeFace& square) { return has_centre(square.base, square.axes); }) {}

  /// Whether the centre of an ambiguous polygon is in the part.
  using HasCentreOf = std::function<bool(const PolytopeFace& polygon)>;

  /// `faces`: by dimension, the polytope itself the last; they must outlive this object.
  BoundaryPart(const std::vector<PolytopeFace>& faces, Corners inside, const HasCentreOf& has_centre)
      : faces_(faces), in_face_(faces.size()) {
    for (std::size_t face = 0; face < faces_.size(); ++face) find_in_face(face, inside, has_centre);
    std::vector<Corners> all;
    for (std::size_t face = 0; face + 1 < faces_.size(); ++face)
      all.insert(all.end(), in_face_[face].begin(), in_face_[face].end());
    components_ = merged(all);
    find_eulers();
  }

  [[nodiscard]] std::size_t components() const noexcept { return components_.size(); }
  /// The component that has a corner of the part.
  [[nodiscard]] std::size_t of_corner(unsigned corner) const noexcept {
    std::size_t c = 0;
    while ((components_[c] >> corner & 1u) == 0) ++c;
    return c;
  }
  [[nodiscard]] long euler(std::size_t component) const noexcept { return eulers_[component]; }
  /// The components in the cube itself, if disjoint discs or balls fill all that separates the parts.
  [[nodiscard]] const std::vector<Corners>& regions_of_cube() const noexcept { return in_face_.back(); }

 private:
  void find_in_face(std::size_t number, Corners inside, const HasCentreOf& has_centre) {
    const PolytopeFace& face = faces_[number];
    std::vector<Corners>& components = in_face_[number];
    if (face.dim == 0 && (inside & face.corners) != 0) components.push_back(face.corners);
    if (face.dim == 0) return;
    std::vector<Corners> below;
    for (const std::size_t facet : face.facets)
      below.insert(below.end(), in_face_[facet].begin(), in_face_[facet].end());
    components = merged(below);
    // An edge joins its two corners. A quadrilateral with two separate corners inside is ambiguous.
    if (components.size() == 2 && (face.dim == 1 || (face.dim == 2 && has_centre(face))))
      components = {components[0] | components[1]};
  }

  /// The Euler characteristic of the order complex: the sum of w(e) = 1 - sum of w(d) over d < e.
  void find_eulers() {
    eulers_.assign(components_.size(), 0);
    std::vector<std::vector<long>> weights(faces_.size());
    for (std::size_t face = 0; face + 1 < faces_.size(); ++face)
      for (const Corners corners : in_face_[face]) {
        long weight = 1;
        for (const std::size_t below : faces_[face].below)
          for (std::size_t i = 0; i < in_face_[below].size(); ++i)
            if ((in_face_[below][i] & ~corners) == 0) weight -= weights[below][i];
        weights[face].push_back(weight);
        for (std::size_t c = 0; c < components_.size(); ++c)
          if ((corners & components_[c]) != 0) eulers_[c] += weight;
      }
  }

  const std::vector<PolytopeFace>& faces_;
  std::vector<std::vector<Corners>> in_face_;  ///< components, by face
  std::vector<Corners> components_;
  std::vector<long> eulers_;
};

/// A simplex by its vertices, 0xff for none.
using VertexSet = std::array<std::uint8_t, 4>;

/// A connected part of a simplicial complex.
struct Piece {
  std::vector<std::uint8_t> vertices;  ///< ascending
  long euler = 0;
};

/// The connected parts of a complex of simplices with `size` vertices each.
inline std::vector<Piece> pieces_of(const std::vector<VertexSet>& simplices, unsigned size) {
  std::array<std::uint8_t, 256> root;
  for (unsigned v = 0; v < root.size(); ++v) root[v] = static_cast<std::uint8_t>(v);
  const auto find = [&](std::uint8_t v) {
    while (root[v] != v) v = root[v];
    return v;
  };
  std::vector<VertexSet> faces;
  for (const VertexSet& simplex : simplices) {
    for (unsigned j = 1; j < size; ++j) root[find(simplex[j])] = find(simplex[0]);
    for (unsigned subset = 1; subset < 1u << size; ++subset) {
      VertexSet face;
      face.fill(0xff);
      for (unsigned j = 0, k = 0; j < size; ++j)
        if ((subset >> j & 1u) != 0) face[k++] = simplex[j];
      std::sort(face.begin(), face.end());
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  std::vector<Piece> pieces;
  std::array<std::size_t, 256> piece_of;
  piece_of.fill(~std::size_t{0});
  for (const VertexSet& face : faces) {
    std::size_t& piece = piece_of[find(face[0])];
    if (piece == ~std::size_t{0}) {
      piece = pieces.size();
      pieces.emplace_back();
    }
    const auto count = std::count_if(face.begin(), face.end(), [](std::uint8_t v) { return v != 0xff; });
    pieces[piece].euler += count % 2 == 1 ? 1 : -1;
    if (count == 1) pieces[piece].vertices.push_back(face[0]);
  }
  return pieces;
}

/// The facets of simplices with `size` vertices each that only one of them has.
inline std::vector<VertexSet> boundary_of(const std::vector<VertexSet>& simplices, unsigned size) {
  std::vector<VertexSet> facets, result;
  for (const VertexSet& simplex : simplices)
    for (unsigned omitted = 0; omitted < size; ++omitted) {
      VertexSet facet = simplex;
      facet[omitted] = 0xff;
      std::sort(facet.begin(), facet.end());
      facets.push_back(facet);
    }
  std::sort(facets.begin(), facets.end());
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const bool is_before = i > 0 && facets[i - 1] == facets[i];
    const bool is_behind = i + 1 < facets.size() && facets[i + 1] == facets[i];
    if (!is_before && !is_behind) result.push_back(facets[i]);
  }
  return result;
}

}  // namespace tegl::test
