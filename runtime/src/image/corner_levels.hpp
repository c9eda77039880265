// SPDX-License-Identifier: BSD-3-Clause
//
// Levels of the rays from the centre of a 4D tile to its corners, by registers: copies of a side of a tile's boundary
// have a vertex on most of these rays.
#pragma once

#include <array>
#include <cstdint>

namespace tegl::detail {

/// Equal to TileHeights<4>::level for each of `corners`; the other entries of `out` are undefined. `products`: of
/// TileHeights.
void corner_levels(const std::array<double, 16>& products, double epsilon, std::uint32_t corners,
                   std::array<double, 16>& out) noexcept;

}  // namespace tegl::detail
