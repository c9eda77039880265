// SPDX-License-Identifier: BSD-3-Clause
//
// Points of a contour on edges between points of a complex.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace tegl::detail {

/// alpha_of if an end or the difference is infinite.
inline double alpha_at_infinity(double from, double to, double isovalue) noexcept {
  if (std::isinf(from) || std::isinf(to)) return !std::isinf(from) ? 0.0 : !std::isinf(to) ? 1.0 : 0.5;
  return (isovalue / 2 - from / 2) / (to / 2 - from / 2);
}

/// Where the isovalue is on an edge: 0 at the first end, 1 at the second. Infinite values are treated as limits: the
/// vertex is at the finite end, or at the middle between two infinities.
inline double alpha_of(double from, double to, double isovalue, double epsilon) noexcept {
  const double difference = to - from;
  const double alpha =
      std::isfinite(difference) ? (isovalue - from) / difference : alpha_at_infinity(from, to, isovalue);
  return std::clamp(alpha, epsilon, 1.0 - epsilon);
}

/// The point at `alpha` of an edge, within the bounds of its ends.
template <class Real, std::size_t N>
std::array<Real, N> point_on_edge(const std::array<double, N>& from, const std::array<double, N>& to,
                                  double alpha) noexcept {
  std::array<Real, N> point;
  for (std::size_t i = 0; i < N; ++i) {
    const double x = from[i] + alpha * (to[i] - from[i]);
    point[i] =
        static_cast<Real>(alpha >= 1.0 ? to[i] : std::clamp(x, std::min(from[i], to[i]), std::max(from[i], to[i])));
  }
  return point;
}

}  // namespace tegl::detail
