// SPDX-License-Identifier: BSD-3-Clause
//
// Levels of the rays from the centre of a 4D tile to points of its boundary, in the lanes of registers: copies of a
// side of a tile's boundary have their vertices there.
#pragma once

#include <array>
#include <cstddef>

namespace tegl::detail {

/// Rays from the centre of one tesseract.
struct TesseractRays {
  static constexpr std::size_t kMost = 192;  ///< the own vertices that a tile may have

  std::size_t count = 0;
  /// By axis: the ends, in the unit tile. `find_levels` writes to the entries from `count` up to the next whole
  /// register.
  alignas(64) std::array<std::array<double, kMost>, 4> ends;
  alignas(64) std::array<double, kMost> levels;

  void add(const std::array<double, 4>& end) noexcept {
    for (std::size_t a = 0; a < 4; ++a) ends[a][count] = end[a];
    ++count;
  }
};

/// Sets the levels, equal to TileHeights<4>::level. `products`: of TileHeights.
void find_levels(const std::array<double, 16>& products, double epsilon, TesseractRays& rays) noexcept;

}  // namespace tegl::detail
