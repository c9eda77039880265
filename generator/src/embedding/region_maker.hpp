// SPDX-License-Identifier: BSD-3-Clause
//
// Divides a ball in a cube into tetrahedra that are positive wherever the contour meets the cube's edges.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "embedding/region_proof.hpp"
#include "embedding/region_vertices.hpp"

namespace tegl::gen {

/// What a division may not do, and where its vertices lie.
struct RegionFrame {
  using Set = std::uint64_t;                                   ///< bit set of local vertices (RegionVertices)
  static constexpr unsigned kEnd = RegionVertices::kVertices;  ///< one past the last local vertex

  RegionFrame();  ///< squares, and the points of corners and edges

  std::array<Set, 6> squares{};                    ///< local vertices in each square
  bool is_cap = false;                             ///< the division stays in the cube: without a copy in a tesseract
  Set on_contour = 0;                              ///< vertices of the list; 0 for a cap
  std::array<RegionProof::Points, kEnd> points{};  ///< by vertex
  Set barycentres = 0;  ///< vertices of the list inside of polygons, on whose rays a centre may lie
};

/// A division of a region, with the orientation that its surface has towards the inside.
struct RegionDivision {
  std::vector<RegionVertices::Tetrahedron> tetrahedra;
  std::vector<std::uint32_t> centres;  ///< as CubeRegions::centres: masks of the vertices from kFirstCentre on
};

/// Searches for a division into positive tetrahedra without other vertices than those of the surface; if there is none,
/// with one centre. Tetrahedra of a centre on the ray of a barycentre and of triangles around the barycentre are walls
/// between the contour and the copy, parallel to the rays. Simplices whose vertices all lie in one square or on the
/// contour belong to the surface; in a cap, those on the contour need not. `surface`: triangles oriented outwards.
/// Empty if the search fails.
[[nodiscard]] std::optional<RegionDivision> divide_region(const RegionProof& proof, const RegionFrame& frame,
                                                          std::span<const std::array<std::uint8_t, 3>> surface);

}  // namespace tegl::gen
