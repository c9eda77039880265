// SPDX-License-Identifier: BSD-3-Clause
//
// Divides a ball in a cube into tetrahedra that are positive wherever the contour meets the cube's edges.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "builders/region_vertices.hpp"
#include "filling/region_proof.hpp"

namespace tegl::gen {

/// What a division may not do, and where its vertices lie.
struct RegionFrame {
  using Set = std::uint64_t;                                          ///< bit set of local vertices (RegionVertices)
  static constexpr unsigned kEnd = RegionVertices::kFirstSquare + 6;  ///< one past the last local vertex

  std::array<Set, 6> squares{};                    ///< local vertices in each square
  Set on_contour = 0;                              ///< vertices of the list
  std::array<RegionProof::Points, kEnd> points{};  ///< by vertex
  Set barycentres = 0;  ///< vertices of the list inside of polygons, on whose rays a centre may lie
};

/// A division of a region, with the orientation that its surface has towards the inside.
struct RegionDivision {
  std::vector<RegionVertices::Tetrahedron> tetrahedra;  ///< the centre: vertex kFirstCentre
  std::uint32_t centre = 0;                             ///< as CubeRegions::centres; 0: without a centre
};

/// Searches for a division into positive tetrahedra without other vertices than those of the surface; if there is none,
/// with one centre. Tetrahedra of a centre on the ray of a barycentre and of triangles around the barycentre are walls
/// between the contour and the copy, parallel to the rays. Simplices whose vertices all lie in one square or on the
/// contour belong to the surface. `surface`: triangles oriented outwards. Empty if the search fails.
[[nodiscard]] std::optional<RegionDivision> divide_region(const RegionProof& proof, const RegionFrame& frame,
                                                          std::span<const std::array<std::uint8_t, 3>> surface);

}  // namespace tegl::gen
