// SPDX-License-Identifier: BSD-3-Clause
//
// The facets of the faces of a grid as symbols: for each dimension and signature, which facets a face has, and which
// facets of its own faces each of them is bounded by. No positions and no triangulation.
//
// Based on: M. Liversage, thesis, 1994, section 7.6 (facets by recursion over dimension). A facet is a component of
// what the facets in the face's own faces make up. In squares, cubes and tesseracts with every ambiguity resolved the
// same way, each component bounds a facet of its own. Where the data resolve them, a face's signature does not say all:
// it has a type. A cube may then have a tunnel, between several components: its triangles, which are in the table of
// the cube (table_contract.hpp), are the facets there, and have points and segments inside the cube.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/extract.hpp"
#include "tile/cube_subcases.hpp"

namespace tegl::detail {

/// One facet of those that bound another: facet `number` of face 2 a + side, which is at the lower (side 0) or upper
/// end of axis a and has the other axes in ascending order; face 6 of a cube: the segments inside it. `sign`: its
/// incidence number.
struct FacetEntry {
  std::uint8_t face;
  std::uint8_t number;
  std::int8_t sign;
};

/// Faces have up to kMaxDim dimensions; corner v has coordinate v >> a & 1 on axis a.
///
/// Orientation: a facet followed by a normal towards the high side is positive in its face's axes. Then the incidence
/// number of a facet in the boundary of another is that of their faces (outward normal first). Points have none: the
/// start of a 1-facet has -1, its end +1.
///
/// Order of the entries: of a segment, its start and its end; of a polygon, head to tail, along its orientation; of a
/// polyhedron, by face and number.
class FacetTables {
 public:
  static constexpr unsigned kMaxDim = 4;
  static constexpr unsigned kInside = 6;      ///< FacetEntry::face
  static constexpr unsigned kCubeEdges = 12;  ///< edge e of a cube: table_contract.hpp

  /// What a cube has inside where the data resolve it.
  struct Inside {
    std::vector<std::uint8_t> points;  ///< which own vertices of the cube's list
    std::vector<std::array<std::uint8_t, 2>>
        segments;  ///< start and end: the point on an edge, or kCubeEdges + a point
    /// Choice of the cube's centre where there is a tunnel: what has its sign hangs together in the cube.
    facets::Choice joins = facets::Choice::separate;
  };

  /// Makes those of edges, squares and cubes. Types are signatures; where the data decide, of squares square_type, of
  /// cubes the numbers of ResolvedCubes' lists.
  explicit FacetTables(Ambiguity ambiguity);
  static constexpr unsigned square_type(unsigned signature, bool high) noexcept {
    return signature | (high && (signature == 6 || signature == 9) ? 16u : 0u);
  }
  /// Makes those of the tesseracts with these signatures, which are asked for alone. Not while others read. (Where the
  /// data decide, see resolved_facets.hpp.)
  void add_tesseracts(std::span<const std::uint16_t> signatures);

  /// How many facets a face of dimension `dim` has, 1 to kMaxDim.
  [[nodiscard]] unsigned count(unsigned dim, unsigned type) const noexcept {
    const Lists& lists = lists_[dim];
    return lists.first_facet[type + 1] - lists.first_facet[type];
  }
  /// What bounds facet `number`.
  [[nodiscard]] std::span<const FacetEntry> entries(unsigned dim, unsigned type, unsigned number) const noexcept {
    const Lists& lists = lists_[dim];
    const std::size_t facet = lists.first_facet[type] + number;
    return {lists.entries.data() + lists.first_entry[facet], lists.first_entry[facet + 1] - lists.first_entry[facet]};
  }
  /// What bounds all of them together.
  [[nodiscard]] std::size_t entry_count(unsigned dim, unsigned type) const noexcept {
    const Lists& lists = lists_[dim];
    return lists.first_entry[lists.first_facet[type + 1]] - lists.first_entry[lists.first_facet[type]];
  }
  /// Of cubes that the data resolve.
  [[nodiscard]] const Inside& inside(unsigned type) const noexcept { return inside_[type]; }
  /// The points of facet `number` of such a cube: bit e that on edge e, bit kCubeEdges + j point j inside.
  [[nodiscard]] std::uint16_t points(unsigned type, unsigned number) const noexcept {
    return points_[lists_[3].first_facet[type] + number];
  }

 private:
  /// Of the faces of a face, in the order of FacetEntry::face.
  using FaceTypes = std::array<unsigned, std::size_t{2} * kMaxDim>;
  struct Lists {
    std::vector<std::uint32_t> first_facet;  ///< by type, and the end
    std::vector<std::uint32_t> first_entry;  ///< by facet, and the end
    std::vector<FacetEntry> entries;
  };
  /// A facet of one of the face's own faces.
  struct Part {
    FacetEntry entry;
    std::size_t component;
    std::array<unsigned, 2> ends{};  ///< of a segment: the names of the edges that it runs from and to
  };

  using Triangle = std::array<std::uint8_t, 3>;

  void add_signature(unsigned dim, unsigned signature);
  void add_square(unsigned signature, bool high);
  void add_cube(unsigned list);
  void add_loop(const std::vector<Part>& parts, std::size_t first);
  void add_triangle(const Triangle& triangle, const std::vector<Part>& parts, Inside& inside);
  static FaceTypes face_types(unsigned dim, unsigned signature) noexcept;
  [[nodiscard]] std::vector<Part> parts(unsigned dim, const FaceTypes& types) const;
  void join_parts(unsigned dim, const FaceTypes& types, std::vector<Part>& parts) const;
  /// Numbers of the parts from `first` on, head to tail.
  static std::vector<std::size_t> loop(const std::vector<Part>& parts, std::size_t first);

  Ambiguity ambiguity_;
  std::array<Lists, kMaxDim + 1> lists_;  ///< by dimension; 0: none
  std::vector<Inside> inside_;            ///< by type of cubes
  std::vector<std::uint16_t> points_;     ///< by facet of cubes
};

/// The signature of the face of a `dim`-cube at the lower (side 0) or upper end of an axis.
constexpr unsigned face_signature(unsigned dim, unsigned signature, unsigned axis, unsigned side) noexcept {
  unsigned result = 0;
  for (unsigned v = 0, to = 0; v < 1u << dim; ++v)
    if ((v >> axis & 1u) == side) result |= (signature >> v & 1u) << to++;
  return result;
}

/// The incidence number of that face in the cube: outward normal first, axes ascending.
constexpr int face_sign(unsigned axis, unsigned side) noexcept { return (axis % 2 == 0) == (side == 1) ? 1 : -1; }

}  // namespace tegl::detail
