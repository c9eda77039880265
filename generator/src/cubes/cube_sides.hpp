// SPDX-License-Identifier: BSD-3-Clause
//
// The two sides of a cube with its contour: their boundaries, and their division into tetrahedra that are positive
// wherever the contour meets the cube's edges.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "embedding/region_maker.hpp"

namespace tegl::gen {

using RegionTriangle = std::array<std::uint8_t, 3>;  ///< by local vertices of RegionVertices

/// One side of a cube with its contour: the part with the high corners, or the one with the low corners.
struct CubeSide {
  unsigned signature, high_squares;
  bool is_high;

  /// The boundary of the side, given its contour's triangles, by connected component: of each region of the side. In
  /// squares, each polygon is a fan from its lowest corner, or from the middle one of three. Adjacent cubes get the
  /// same triangles. Oriented outwards for the low side, inwards for the high side: this continues the contour, which
  /// is oriented towards high.
  [[nodiscard]] std::vector<std::vector<RegionTriangle>> regions(std::span<const RegionTriangle> contour) const;

 private:
  [[nodiscard]] bool has(unsigned corner) const { return ((signature >> corner & 1u) != 0) == is_high; }
  void add_square(unsigned square, std::vector<RegionTriangle>& to) const;
};

/// The own vertices of a contour, with the masks of tables::ResolvedTable, and its triangles, for divide_region. The
/// first `barycentres` own vertices lie inside of polygons.
[[nodiscard]] RegionFrame region_frame(std::span<const std::uint32_t> masks, std::size_t barycentres,
                                       std::span<const RegionTriangle> contour, bool is_cap);

/// The division of a region with this boundary, with the orientation of the boundary: the same tetrahedra, whichever
/// side is high. Empty if divide_region finds none.
[[nodiscard]] std::optional<RegionDivision> divide_side_region(const RegionProof& proof, const RegionFrame& frame,
                                                               std::vector<RegionTriangle> surface, bool is_high);

}  // namespace tegl::gen
