// SPDX-License-Identifier: BSD-3-Clause
//
// Finds out for many tesseracts at once whether the contour in the boundary is connected, or connected except for
// spheres around single corners: whether the high corners are connected in the boundary, and the low ones. The boundary
// is a 3-sphere, so a surface in it has one component less than it separates regions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "image/bitplanes.hpp"

namespace tegl::detail {

/// Corners of one sign of tesseracts, and the faces whose centre has that sign. An unambiguous face connects its
/// corners of either sign, whatever its centre.
struct BoundarySides {
  static constexpr std::size_t kMost = 2 * kWordBits;

  std::size_t count = 0;
  /// `find_connected` writes zeros to the entries from `count` up to the next whole register.
  alignas(64) std::array<std::uint16_t, kMost> corners;
  alignas(64) std::array<std::uint16_t, kMost> squares, more_squares;  ///< bits 0 to 15 and 16 to 23
  alignas(64) std::array<std::uint16_t, kMost> cubes;
  /// The corners that are connected with no other, if the others are connected with each other; otherwise kScattered.
  /// If there are no others, the lowest one is left out. So 0: all corners are connected.
  alignas(64) std::array<std::uint16_t, kMost> apart;
  static constexpr std::uint16_t kScattered = 0xffff;

  void add(std::uint32_t of_corners, std::uint32_t of_squares, std::uint32_t of_cubes) noexcept {
    corners[count] = static_cast<std::uint16_t>(of_corners);
    squares[count] = static_cast<std::uint16_t>(of_squares);
    more_squares[count] = static_cast<std::uint16_t>(of_squares >> 16);
    cubes[count++] = static_cast<std::uint16_t>(of_cubes);
  }
};
void find_connected(BoundarySides& sides) noexcept;

}  // namespace tegl::detail
