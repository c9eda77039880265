// SPDX-License-Identifier: BSD-3-Clause
//
// Squares and pairs of diagonal edges of the cube, for the test whether regions are joined inside it. The generator
// finds the pairs that may join (tables::CubeJoin), and the runtime decides them from the values.
#pragma once

#include <array>
#include <cstdint>

namespace tegl::detail {

/// Corners of square 2 a + side.
inline constexpr std::array<std::array<std::uint8_t, 4>, 6> kSquareCorners = {
    {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}}};

/// A pair of diagonal edges along an axis: the lower corners of A and C, and of the other two, B and D.
struct DiagonalEdges {
  std::uint8_t a, c, b, d, step;
};

/// Two pairs for each axis.
inline constexpr std::array<DiagonalEdges, 6> kDiagonalEdges = {
    {{0, 6, 2, 4, 1}, {2, 4, 0, 6, 1}, {0, 5, 1, 4, 2}, {1, 4, 0, 5, 2}, {0, 3, 1, 2, 4}, {1, 2, 0, 3, 4}}};

}  // namespace tegl::detail
