// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of the bilinear interpolant in a square and of the trilinear one in a cube, up to its topology: what the
// estimator `saddle` asks of the values at the corners. Every answer is exact: it is the sign of a polynomial in the
// values and the isovalue, in real numbers, however near to zero it is. So all tiles around a square agree about it,
// and ties (a saddle exactly at the isovalue, corners exactly at it, constant faces) are decided the same way
// everywhere.
//
// High is closed: a point is high if the interpolant is at least the isovalue there, as in the whole library. So a
// saddle exactly at the isovalue joins what is high.
//
// Based on: G. M. Nielson and B. Hamann, The asymptotic decider, 1991 (squares); E. V. Chernyaev, Marching Cubes 33,
// 1995, and L. Custodio, T. Etiene, S. Pesco and C. Silva, Practical considerations on Marching Cubes 33 topological
// correctness, 2013 (which cases there are). How the cube is decided, by planes across it, is our own: see saddle.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "tegl/facets/facets.hpp"
#include "tegl/image.hpp"

namespace tegl {

/// The contour of the trilinear interpolant in a cube.
struct CubeDecision {
  /// Bit 2 a + side: the square at x_a = side is ambiguous and its high corners are joined in it. 0 for squares that
  /// are not ambiguous.
  std::uint8_t high_squares = 0;
  /// Inside the cube: `separate` if every loop of the contour on the cube's faces bounds a disc of its own. `high` if
  /// the interpolant joins two parts of the high corners that the faces leave apart; the contour then is a tunnel
  /// around what joins them (an annulus between two loops) and discs in the other loops, if there are any: a copy of
  /// the low part of the cube's surface. `low` is the same for low ones. There is nothing else: at most two loops are
  /// joined.
  facets::Choice centre = facets::Choice::separate;

  bool operator==(const CubeDecision&) const = default;  ///< member by member
};

namespace detail {
/// The public functions, with the values as doubles, which hold all of theirs exactly.
bool square_is_high(const std::array<double, 4>& values, double isovalue) noexcept;
/// `signature`: bit v is set if corner v is high.
CubeDecision decide_cube(const std::array<double, 8>& values, double isovalue, unsigned signature) noexcept;
/// What decides whether regions of a cube are joined inside of it, by entry of tables::kTile3Resolved, which is the
/// signature with its squares decided: a pair of diagonal edges, if there is one, and sometimes one of either sign.
struct CubeJoin {
  std::uint8_t pairs = 0;                 ///< how many; with none, the centre is `separate`
  bool high = false;                      ///< of one: whether it joins high corners
  std::array<std::uint8_t, 8> corners{};  ///< of one: the lower and upper end of each of its edges A, C, B, D
};
const std::array<CubeJoin, 656>& cube_joins() noexcept;
/// The centre of a cube with this entry.
facets::Choice decide_centre(const std::array<double, 8>& values, double isovalue, unsigned entry) noexcept;
/// The same without the filter, for tests: all signs by exact arithmetic.
bool square_is_high_exactly(const std::array<double, 4>& values, double isovalue) noexcept;
CubeDecision decide_cube_exactly(const std::array<double, 8>& values, double isovalue) noexcept;

inline unsigned signature_of(const std::array<double, 8>& values, double isovalue) noexcept {
  unsigned signature = 0;
  for (unsigned v = 0; v < 8; ++v) signature |= static_cast<unsigned>(values[v] >= isovalue) << v;
  return signature;
}

template <Value T, std::size_t kCorners>
std::array<double, kCorners> as_doubles(std::span<const T, kCorners> values) noexcept {
  std::array<double, kCorners> result;
  std::transform(values.begin(), values.end(), result.begin(), [](T value) { return static_cast<double>(value); });
  return result;
}
}  // namespace detail

/// Whether the bilinear interpolant joins the high corners of an ambiguous square: whether its value at the saddle is
/// at least the isovalue. Corner v has coordinates v & 1 and v >> 1; mirrored or turned corners have the same answer.
/// Of a square that is not ambiguous the answer means nothing. Infinite values count as +-2^1024; a NaN as -2^1024. No
/// errors, no memory, thread safe. O(1): 3 ns; where rounding could decide 20 ns for whole numbers of few bits, at most
/// about a microsecond for others.
template <Value T>
bool square_is_high(std::span<const T, 4> values, double isovalue) noexcept {
  return detail::square_is_high(detail::as_doubles(values), isovalue);
}

/// How the trilinear interpolant decides the ambiguous squares and the inside of a cube. Corner v has coordinate
/// v >> a & 1 on axis a. Squares are decided as by square_is_high. A cube that the contour does not pass, or passes in
/// one piece, is `separate`. Infinite values, NaN, errors and cost: as square_is_high; 20 ns, 80 ns and some
/// microseconds.
template <Value T>
CubeDecision decide_cube(std::span<const T, 8> values, double isovalue) noexcept {
  const std::array<double, 8> doubles = detail::as_doubles(values);
  return detail::decide_cube(doubles, isovalue, detail::signature_of(doubles, isovalue));
}

/// The same, only the inside: the cube's own choice.
template <Value T>
facets::Choice cube_choice(std::span<const T, 8> values, double isovalue) noexcept {
  return decide_cube<T>(values, isovalue).centre;
}

}  // namespace tegl
