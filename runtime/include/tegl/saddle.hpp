// SPDX-License-Identifier: BSD-3-Clause
//
// The topology of the bilinear interpolant's contour in a square and of the trilinear one's in a cube, for
// Ambiguity::saddle. All results are exact: each is the sign of a polynomial in the values and the isovalue, in real
// numbers, however close to zero. So all tiles around a square agree, and ties (a saddle or corners exactly at the
// isovalue, constant faces) are resolved the same way everywhere.
//
// The high set is closed: a point is high if the interpolant is at least the isovalue there, as in the whole library.
// So a saddle exactly at the isovalue joins the high regions.
//
// Based on: G. M. Nielson and B. Hamann, The asymptotic decider, 1991 (squares); E. V. Chernyaev, Marching Cubes 33,
// 1995, and L. Custodio, T. Etiene, S. Pesco and C. Silva, Practical considerations on Marching Cubes 33 topological
// correctness, 2013 (the list of cases). The decision in the cube, by planes across it, is ours: see saddle.cpp.
#pragma once

#include <cstdint>
#include <span>

#include "tegl/image.hpp"
#include "tegl/tile/choices.hpp"

namespace tegl {

/// The topology of the trilinear interpolant's contour in a cube.
struct CubeDecision {
  /// Bit 2 a + side: the square at x_a = side is ambiguous and joins its high corners. 0 for unambiguous squares.
  std::uint8_t high_squares = 0;
  /// `separate` if every loop of the contour on the cube's faces bounds its own disc. `high` if the interpolant joins
  /// two high regions inside the cube that are separate on its faces: the contour has a tunnel around the connection
  /// (an annulus between two loops) and discs in the remaining loops, a copy of the low part of the cube's surface.
  /// `low`: the same with high and low exchanged. There are no other cases: at most two loops are joined.
  tile::Choice centre = tile::Choice::separate;

  bool operator==(const CubeDecision&) const = default;  ///< member by member
};

/// Whether the bilinear interpolant joins the high corners of an ambiguous square: whether its value at the saddle is
/// at least the isovalue. Corner v has coordinates v & 1 and v >> 1; mirrored or rotated squares give the same result.
/// The result is meaningless for unambiguous squares. Infinite values count as +-2^1024, NaN as -2^1024. No errors, no
/// allocation, thread-safe. O(1): 3 ns; if rounding could decide, 20 ns for integers of few bits and at most about a
/// microsecond otherwise.
template <Value T>
[[nodiscard]] bool square_is_high(std::span<const T, 4> values, double isovalue) noexcept;

/// How the trilinear interpolant resolves the ambiguous squares and the inside of a cube. Corner v has coordinate v >>
/// a & 1 on axis a. Squares are decided by square_is_high. A cube without contour, or with one connected piece of it,
/// is `separate`. Infinite values, NaN and errors: as square_is_high; cost: 20 ns, 80 ns and some microseconds in the
/// respective cases.
template <Value T>
[[nodiscard]] CubeDecision decide_cube(std::span<const T, 8> values, double isovalue) noexcept;

/// The choice for the inside of a cube only.
template <Value T>
[[nodiscard]] tile::Choice cube_choice(std::span<const T, 8> values, double isovalue) noexcept;

}  // namespace tegl
