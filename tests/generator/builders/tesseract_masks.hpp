// SPDX-License-Identifier: BSD-3-Clause
//
// The masks of the own vertices of a tesseract's filling, by definition (ResolvedView::masks in builder4.hpp). A
// filling is divided into its connected parts. A part with own vertices is either a cone, whose apex is the mean of all
// edges with vertices of the part, or the copy of regions of the boundary: then the part, with each own vertex named by
// its mask, has exactly the tetrahedra of the cubes' regions, lifted here by the table contract.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../definition_oracle.hpp"
#include "builder4.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::test {

/// The corners of a sign as sets that are connected in the boundary, by edges and by the centres of squares and cubes.
inline std::vector<std::uint32_t> regions_of_side(const builders::ResolvedKey& key, bool high) {
  const std::uint32_t corners = high ? key.signature : ~std::uint32_t{key.signature} & 0xffffu;
  std::vector<std::uint32_t> faces;
  const auto add_face = [&](unsigned base, unsigned axes) {
    std::uint32_t face = 0;
    for (unsigned v = 0; v < 16; ++v)
      if ((v & ~axes) == base) face |= 1u << v;
    faces.push_back(face & corners);
  };
  for (unsigned axis = 0; axis < 4; ++axis)
    for (unsigned v = 0; v < 16; ++v)
      if ((v >> axis & 1u) == 0 && (corners >> v & corners >> (v | 1u << axis) & 1u) != 0) add_face(v, 1u << axis);
  for (unsigned q = 0; q < 24; ++q)
    if ((key.squares >> q & 1u) == (high ? 1u : 0u))
      add_face(builders::kTesseractSquares[q].base, builders::kTesseractSquares[q].axes);
  for (unsigned f = 0; f < 8; ++f)
    if (((high ? key.high_cubes & ~unsigned{key.low_cubes} : key.low_cubes) >> f & 1u) != 0)
      add_face((f % 2) << f / 2, 15u ^ 1u << f / 2);
  std::vector<std::uint32_t> regions;
  for (std::uint32_t rest = corners; rest != 0; rest &= ~regions.back()) {
    std::uint32_t reached = rest & (0u - rest);
    for (std::uint32_t before = 0; before != reached;) {
      before = reached;
      for (const std::uint32_t face : faces) reached |= (face & reached) != 0 ? face : 0u;
    }
    regions.push_back(reached);
  }
  return regions;
}

/// Compares the masks of one filling with the definition.
class TesseractMasks {
 public:
  TesseractMasks(const builders::ResolvedKey& key, const builders::ResolvedView& view, Triangulation triangulation)
      : key_(key),
        view_(view),
        is_barycentric_(triangulation == Triangulation::barycentric),
        regions_(builders::CubeRegions::instance(triangulation)) {}

  /// "" if every mask is as defined.
  [[nodiscard]] std::string fault() const {
    if (view_.own_vertices == 0) return "";
    if (std::string wrong = fault_of_repeats(); !wrong.empty()) return wrong;
    std::vector<VertexSet> simplices(view_.simplex_count);
    for (std::size_t s = 0; s < simplices.size(); ++s) std::copy_n(view_.simplices + 4 * s, 4, simplices[s].begin());
    std::array<std::size_t, 256> part_of;
    part_of.fill(~std::size_t{0});
    std::vector<Part> parts;
    for (const Piece& piece : pieces_of(simplices, 4)) {
      for (const std::uint8_t v : piece.vertices) part_of[v] = parts.size();
      parts.push_back({piece.vertices, {}});
    }
    for (unsigned j = 0; j < view_.own_vertices; ++j)
      if (part_of[kFirstOwn + j] == ~std::size_t{0}) return fmt::format("no simplex has own vertex {}", j);
    for (const VertexSet& simplex : simplices) parts[part_of[simplex[0]]].simplices.push_back(simplex);
    for (const Part& part : parts) {
      if (part.vertices.back() < kFirstOwn) continue;
      std::string wrong = is_mean(part) ? fault_of_mean(part) : fault_of_copy(part);
      if (!wrong.empty()) return wrong;
    }
    return "";
  }

 private:
  using Tesseract = builders::ResolvedTesseract;
  using CubeRegions = builders::CubeRegions;
  static constexpr unsigned kFirstOwn = Tesseract::kFirstOwn;

  /// A vertex of Sigma, or its copy, as kOfSigma and the local vertex; any other vertex as its mask without repeats.
  using Point = std::uint64_t;
  static constexpr Point kOfSigma = Point{1} << 61;
  using Tetrahedra = std::vector<std::array<Point, 4>>;

  struct Part {
    std::vector<std::uint8_t> vertices;  ///< ascending
    std::vector<VertexSet> simplices;

    [[nodiscard]] bool has(unsigned v) const { return std::binary_search(vertices.begin(), vertices.end(), v); }
  };

  [[nodiscard]] Point mask(unsigned v) const { return view_.masks[v - kFirstOwn]; }

  /// Equal masks are numbered in order.
  [[nodiscard]] std::string fault_of_repeats() const {
    for (unsigned j = 0; j < view_.own_vertices; ++j) {
      std::uint64_t earlier = 0;
      for (unsigned i = 0; i < j; ++i)
        earlier += ((view_.masks[i] ^ view_.masks[j]) & ~Tesseract::kRepeats) == 0 ? 1 : 0;
      const std::uint64_t repeats = (view_.masks[j] & Tesseract::kRepeats) >> Tesseract::kRepeat;
      if (repeats != earlier) return fmt::format("own vertex {} repeats {} others; expected {}", j, repeats, earlier);
    }
    return "";
  }

  /// Whether all simplices have the only own vertex, and it is the copy of no corner.
  [[nodiscard]] bool is_mean(const Part& part) const {
    const unsigned apex = part.vertices.back();
    if (apex < kFirstOwn || (mask(apex) & 0xffffu) != 0 || (mask(apex) & Tesseract::kIsDouble) != 0) return false;
    return part.vertices[part.vertices.size() - 2] < kFirstOwn &&
           std::all_of(part.simplices.begin(), part.simplices.end(), [apex](const VertexSet& simplex) {
             return std::find(simplex.begin(), simplex.end(), apex) != simplex.end();
           });
  }

  [[nodiscard]] std::string fault_of_mean(const Part& part) const {
    Point expected = is_barycentric_ ? Tesseract::kIsBarycentre : 0;
    for (const std::uint8_t v : part.vertices) expected |= v < 32 ? Point{1} << (16 + v) : 0;
    const Point found = mask(part.vertices.back());
    return found == expected ? ""
                             : fmt::format("the mean of a cone has the mask {:#x}; expected {:#x}", found, expected);
  }

  [[nodiscard]] std::string fault_of_copy(const Part& part) const {
    std::array<Point, 256> points{};
    Point doubled = 0;
    std::uint32_t corners = 0;
    for (const unsigned v : part.vertices) {
      points[v] = v < kFirstOwn ? kOfSigma | v : mask(v) & ~Tesseract::kRepeats;
      if (v < kFirstOwn) continue;
      const Point local = points[v] ^ Tesseract::kIsDouble;
      // The first double of a vertex that the part does not have is its copy. Others are centres of regions.
      if (local < kFirstOwn && !part.has(static_cast<unsigned>(local)) && (doubled >> local & 1u) == 0) {
        doubled |= Point{1} << local;
        points[v] = kOfSigma | local;
      }
      if (points[v] >= 0x10000u || !std::has_single_bit(points[v])) continue;
      if ((corners & points[v]) != 0) return fmt::format("two copies of the corners {:#x} in one part", points[v]);
      corners |= static_cast<std::uint32_t>(points[v]);
    }
    for (unsigned e = 0; e < 32; ++e) {
      if (!part.has(e) && (doubled >> e & 1u) == 0) continue;
      const unsigned low_end = detail::edge_base(4, e), high_end = low_end | 1u << e / 8;
      const bool is_passed = (corners >> low_end & corners >> high_end & 1u) != 0;
      if (is_passed != ((doubled >> e & 1u) != 0))
        return fmt::format("a copy that {} the vertex on edge {}", is_passed ? "passes and has" : "ends at a double of",
                           e);
    }
    return fault_of_tetrahedra(part, points, corners);
  }

  /// `points`: by vertex of the part. `corners`: those with copies.
  [[nodiscard]] std::string fault_of_tetrahedra(const Part& part, const std::array<Point, 256>& points,
                                                std::uint32_t corners) const {
    Tetrahedra found, expected;
    for (const VertexSet& simplex : part.simplices) {
      auto& tetrahedron = found.emplace_back();
      for (unsigned i = 0; i < 4; ++i) tetrahedron[i] = points[simplex[i]];
      std::sort(tetrahedron.begin(), tetrahedron.end());
    }
    const auto lists = Tesseract::lists_of(key_);
    for (const bool high : {false, true})
      for (const std::uint32_t region : regions_of_side(key_, high)) {
        if ((region & corners) == 0) continue;
        if ((region & ~corners) != 0)
          return fmt::format("a copy of the region {:#x} without the corners {:#x}", region, region & ~corners);
        for (unsigned f = 0; f < 8; ++f)
          for (const CubeRegions::Region& in_cube : regions_.regions(lists[f], high))
            if ((lifted(f, in_cube.corners) & region) != 0) add(f, in_cube, expected);
      }
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    if (found == expected) return "";
    return fmt::format("a copy of the corners {:#x} has {} tetrahedra, other than the {} of its regions", corners,
                       found.size(), expected.size());
  }

  void add(unsigned cube, const CubeRegions::Region& region, Tetrahedra& to) const {
    const auto centres = regions_.centres(region);
    for (const CubeRegions::Tetrahedron& tetrahedron : regions_.tetrahedra(region)) {
      std::array<Point, 4> points{};
      for (unsigned i = 0; i < 4; ++i) {
        const unsigned v = tetrahedron[i];
        points[i] =
            v < CubeRegions::kFirstCentre ? local(cube, v) : lifted(cube, centres[v - CubeRegions::kFirstCentre]);
      }
      std::sort(points.begin(), points.end());
      to.push_back(points);
    }
  }

  /// The point for a local vertex of a cube's region that is no centre.
  static Point local(unsigned cube, unsigned v) {
    if (v < CubeRegions::kFirstEdge) return Point{1} << detail::lifted_corner(cube, v);
    if (v < CubeRegions::kFirstOwn) return kOfSigma | detail::lifted_edge(4, cube, v - CubeRegions::kFirstEdge);
    return kOfSigma | (32 + 4 * cube + v - CubeRegions::kFirstOwn);
  }

  /// The mask in the tesseract for a mask of CubeRegions::centres.
  static Point lifted(unsigned cube, std::uint32_t mask) {
    Point result = 0;
    for (unsigned v = 0; v < CubeRegions::kFirstCentre; ++v) {
      if ((mask >> v & 1u) == 0) continue;
      if (v < CubeRegions::kFirstEdge)
        result |= local(cube, v);
      else if (v < CubeRegions::kFirstOwn)
        result |= Point{1} << (16 + detail::lifted_edge(4, cube, v - CubeRegions::kFirstEdge));
      else
        result |= Tesseract::kIsDouble | (local(cube, v) ^ kOfSigma);
    }
    return result;
  }

  const builders::ResolvedKey& key_;
  const builders::ResolvedView& view_;
  bool is_barycentric_;
  const CubeRegions& regions_;
};

}  // namespace tegl::test
