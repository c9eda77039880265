// SPDX-License-Identifier: BSD-3-Clause
//
// Arithmetic modulo the periods of a wrapped contour. Two points that are neighbours differ by less than half a period.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <type_traits>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/periodic.hpp"

namespace tegl::detail {

/// A point whose dimension is not deduced: that of an array has another type.
template <int N, class Real = double>
using PlainPoint = std::type_identity_t<std::array<Real, static_cast<std::size_t>(N)>>;

/// Adds a multiple of the period's vector.
template <int N>
void add_times(const Period<N>& period, double times, PlainPoint<N>& x) noexcept {
  if (times == 0.0) return;
  for (int a = 0; a < N; ++a) x[a] += times * period.vector[a];
}

/// Moves `x` by periods to the place nearest to `to`.
template <int N>
void move_near(std::span<const Period<N>> periods, const PlainPoint<N>& to, PlainPoint<N>& x) noexcept {
  for (const Period<N>& period : periods) add_times(period, std::round(share_of(period, to) - share_of(period, x)), x);
}

/// Moves `x` by periods so that its shares are in [0, 1). A share that is 1 up to the rounding of `Real` becomes 0.
template <int N, class Real>
void move_inside(std::span<const Period<N>> periods, PlainPoint<N>& x) noexcept {
  constexpr double kRounding = 4 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  for (const Period<N>& period : periods)
    add_times(period, -std::floor(share_of(period, x) - period.start + kRounding), x);
}

template <int N, class Real>
std::array<double, N> widened_point(const std::array<Real, N>& x) noexcept {
  std::array<double, N> result;
  for (int a = 0; a < N; ++a) result[a] = static_cast<double>(x[a]);
  return result;
}

/// The point at `share` of the way from v to w, inside the periods.
template <int N, class Real>
std::array<Real, N> between_modulo(const std::array<Real, N>& v, const std::array<Real, N>& w, double share,
                                   std::span<const Period<N>> periods) noexcept {
  std::array<double, N> from = widened_point<N>(v);
  std::array<double, N> to = widened_point<N>(w);
  move_near(periods, from, to);
  for (int a = 0; a < N; ++a) from[a] += share * (to[a] - from[a]);
  move_inside<N, Real>(periods, from);
  std::array<Real, N> result;
  for (int a = 0; a < N; ++a) result[a] = static_cast<Real>(from[a]);
  return result;
}

/// Throws UnsupportedData for a wrapped contour. `what`: the function.
template <int N, class Real>
void require_unwrapped(const Contour<N, Real>& contour, const char* what) {
  if (!contour.periods.empty())
    throw Error(ErrorCode::UnsupportedData, std::string(what) + ": a wrapped contour, with " +
                                                std::to_string(contour.periods.size()) +
                                                " periods; expected an unrolled one, as `unroll` makes it");
}

}  // namespace tegl::detail
