// SPDX-License-Identifier: BSD-3-Clause
//
// Where a polynomial, the multilinear interpolant on a ray from the centre of a cell, changes its sign.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tegl::detail {

/// Least distance of a vertex on a ray from both ends, as a share of the ray.
inline constexpr double kLeastRayLevel = 1.0 / 32;

/// The polynomial with these coefficients, the constant one first. Unrolled: it is computed for each copied vertex.
template <std::size_t Count, std::size_t K = 0>
[[gnu::always_inline]] inline double polynomial_value(const std::array<double, Count>& coefficients,
                                                      double x) noexcept {
  if constexpr (K + 1 == Count)
    return coefficients[K];
  else
    return coefficients[K] + x * polynomial_value<Count, K + 1>(coefficients, x);
}
template <std::size_t Count, std::size_t K = 1>
[[gnu::always_inline]] inline double polynomial_slope(const std::array<double, Count>& coefficients,
                                                      double x) noexcept {
  const double term = static_cast<double>(K) * coefficients[K];
  if constexpr (K + 1 == Count)
    return term;
  else
    return term + x * polynomial_slope<Count, K + 1>(coefficients, x);
}

/// Whether the sum of a cell's heights is finite, and so are its values on rays.
inline bool is_finite_enough(double sum) noexcept { return std::abs(sum) <= std::numeric_limits<double>::max() / 64; }

/// Newton's method ends with a step below this.
template <std::size_t Count>
inline constexpr double kEnoughOfRay = Count <= 4 ? 1e-5 : 1e-2;

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
  // Newton's method from the chord's root, or bisection where it leaves the interval
  double x = below + (above - below) * (at_below / (at_below - at_above));
  for (int step = 0; step < 8; ++step) {
    const double at = polynomial_value(coefficients, x);
    ((at >= 0.0) == is_high ? above : below) = x;
    double next = x - at / polynomial_slope(coefficients, x);
    if (!(next >= below && next <= above)) next = 0.5 * (below + above);
    const double moved = std::abs(next - x);
    x = next;
    if (moved < kEnoughOfRay<Count>) break;
  }
  return x;
}

/// Adding and subtracting it rounds to a multiple of 2^-32.
inline constexpr double kRayLevelStep = 1048576.0;

/// A level inside the ray, at least kLeastRayLevel and `epsilon` from its ends. A multiple of 2^-32, so that positions
/// on rays to corners, middles of edges and middles of squares are computed exactly.
inline double level_inside(double level, double epsilon) noexcept {
  const double least = std::max(kLeastRayLevel, epsilon);
  return (std::clamp(level, least, 1.0 - least) + kRayLevelStep) - kRayLevelStep;
}

}  // namespace tegl::detail
