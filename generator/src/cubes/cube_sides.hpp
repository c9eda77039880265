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

/// How the polygons of a side are divided in squares, as fans.
///
/// `lowest`: from the lowest corner, or from the middle one of three.
///
/// `even`, `odd`: from an even corner (or an odd one), if the polygon has one. A corner is even if the sum of its
/// coordinates is. So diagonals alternate, as in the division of a cube into five tetrahedra. Of two such corners, the
/// lower one; of the two at the ends of three corners, the one along the higher axis from the middle.
enum class SquareFans : std::uint8_t { lowest, even, odd };

/// One side of a cube with its contour: the part with the high corners, or the one with the low corners.
struct CubeSide {
  unsigned signature, high_squares;
  bool is_high;
  SquareFans fans = SquareFans::lowest;

  /// The boundary of the side, given its contour's triangles, by connected component: of each region of the side.
  /// Adjacent cubes get the same triangles in their square (`even` and `odd` ones if they are at different ends of
  /// their axes). Oriented outwards for the low side, inwards for the high side: this continues the contour, which is
  /// oriented towards high.
  [[nodiscard]] std::vector<std::vector<RegionTriangle>> regions(std::span<const RegionTriangle> contour) const;

 private:
  [[nodiscard]] bool has(unsigned corner) const { return ((signature >> corner & 1u) != 0) == is_high; }
  [[nodiscard]] bool is_preferred(unsigned corner) const;
  [[nodiscard]] std::uint8_t apex_of(std::span<const std::uint8_t> outline, unsigned corners) const;
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
