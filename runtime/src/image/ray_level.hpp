// SPDX-License-Identifier: BSD-3-Clause
//
// Where a polynomial, the multilinear interpolant on a ray from the centre of a cell, changes its sign.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace tegl::detail {

/// Least distance of a vertex on a ray from both ends, as a share of the ray.
inline constexpr double kLeastRayLevel = 1.0 / 32;

/// The polynomial with these coefficients, the constant one first.
template <std::size_t Count>
double polynomial_value(const std::array<double, Count>& coefficients, double x) noexcept {
  double value = coefficients[Count - 1];
  // unrolled: few steps, for each of the tile's vertices
  [&]<std::size_t... K>(std::index_sequence<K...>) { ((value = coefficients[Count - 2 - K] + x * value), ...); }
  (std::make_index_sequence<Count - 1>());
  return value;
}
template <std::size_t Count>
double polynomial_slope(const std::array<double, Count>& coefficients, double x) noexcept {
  double slope = static_cast<double>(Count - 1) * coefficients[Count - 1];
  [&]<std::size_t... K>(std::index_sequence<K...>) {
    ((slope = static_cast<double>(Count - 2 - K) * coefficients[Count - 2 - K] + x * slope), ...);
  }
  (std::make_index_sequence<Count - 2>());
  return slope;
}

/// The last root in (0, 1) of those that the signs at the fourths of the interval show; -1 if there is none. Newton's
/// method ends with a step below 1e-5 for cubic polynomials and 1e-2 for others: the next step would be below 1e-9 and,
/// mostly, 1e-4.
template <std::size_t Count>
double last_root(const std::array<double, Count>& coefficients) noexcept {
  double above = 1.0, at_above = polynomial_value(coefficients, above);
  const bool is_high = at_above >= 0.0;
  double below = 0.75, at_below = polynomial_value(coefficients, below);
  while ((at_below >= 0.0) == is_high) {
    if (below == 0.0) return -1.0;
    above = below, at_above = at_below;
    below -= 0.25, at_below = polynomial_value(coefficients, below);
  }
  constexpr double kEnough = Count <= 4 ? 1e-5 : 1e-2;
  // Newton's method from the chord's root, or bisection where it leaves the interval
  double x = below + (above - below) * (at_below / (at_below - at_above));
  for (int step = 0; step < 8; ++step) {
    const double at = polynomial_value(coefficients, x);
    ((at >= 0.0) == is_high ? above : below) = x;
    double next = x - at / polynomial_slope(coefficients, x);
    if (!(next >= below && next <= above)) next = 0.5 * (below + above);
    const double moved = std::abs(next - x);
    x = next;
    if (moved < kEnough) break;
  }
  return x;
}

/// A level inside the ray, at least kLeastRayLevel and `epsilon` from its ends. A multiple of 2^-32, so that positions
/// on rays to corners, middles of edges and middles of squares are computed exactly.
inline double level_inside(double level, double epsilon) noexcept {
  const double least = std::max(kLeastRayLevel, epsilon);
  constexpr double kStep = 1048576.0;
  return (std::clamp(level, least, 1.0 - least) + kStep) - kStep;
}

}  // namespace tegl::detail
