// SPDX-License-Identifier: BSD-3-Clause
//
// The 48 ways to number the corners of a cube along its axes.
#pragma once

#include <algorithm>
#include <array>
#include <bit>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// A frame of a cube: the corner at its origin and its axes.
struct CubeFrame {
  unsigned origin;
  std::array<unsigned, 3> axes;

  /// Frames: six orders of the axes for each origin. Number 0 is the cube's own frame.
  static constexpr unsigned kCount = 48;
  static constexpr std::array<std::array<unsigned, 3>, 6> kAxisOrders = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  static CubeFrame of_number(unsigned number) noexcept { return {number / 6, kAxisOrders[number % 6]}; }
  /// The number of the frame that begins at the smallest number of `corners` and has its axes in ascending order.
  static unsigned number_of(const Index* corners) noexcept {
    const auto origin = static_cast<unsigned>(std::min_element(corners, corners + 8) - corners);
    std::array<unsigned, 3> axes = {0, 1, 2};
    std::sort(axes.begin(), axes.end(),
              [&](unsigned a, unsigned b) { return corners[origin ^ 1u << a] < corners[origin ^ 1u << b]; });
    return 6 * origin +
           static_cast<unsigned>(std::find(kAxisOrders.begin(), kAxisOrders.end(), axes) - kAxisOrders.begin());
  }

  /// The cube's corner for a corner of the frame.
  [[nodiscard]] unsigned corner(unsigned v) const noexcept {
    unsigned of_cube = origin;
    for (unsigned i = 0; i < 3; ++i) of_cube ^= (v >> i & 1u) << axes[i];
    return of_cube;
  }
  /// The corners of a set, as corners of the frame.
  [[nodiscard]] unsigned signature(unsigned of_cube) const noexcept {
    unsigned in_frame = 0;
    for (unsigned v = 0; v < 8; ++v) in_frame |= (of_cube >> corner(v) & 1u) << v;
    return in_frame;
  }
  /// The cube's square for a square of the frame (2 * axis + side).
  [[nodiscard]] unsigned square(unsigned q) const noexcept {
    return 2 * axes[q / 2] + ((q ^ origin >> axes[q / 2]) & 1u);
  }
  [[nodiscard]] bool is_mirrored() const noexcept {
    const bool odd = (axes[0] > axes[1]) != ((axes[0] > axes[2]) != (axes[1] > axes[2]));
    return odd != (std::popcount(origin) % 2 == 1);
  }
};

}  // namespace tegl::detail
