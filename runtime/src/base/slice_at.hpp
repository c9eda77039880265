// SPDX-License-Identifier: BSD-3-Clause
//
// Axis and coordinate of a slice, used by all slicing methods.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tegl/error.hpp"

namespace tegl::detail {

/// Throws InvalidArgument unless space of N dimensions has this axis.
template <int N>
void require_cut_axis(int axis) {
  if (axis < 0 || axis >= N)
    throw Error(ErrorCode::InvalidArgument, fmt::format("slice across axis {}; expected 0 to {}", axis, N - 1));
}

/// Rounds the hyperplane's coordinate to the precision of the vertices, so that it equals the coordinate of a vertex
/// computed for the same number. Rounding is monotone, so no coordinate changes from one side of `at` to the other.
template <class Real>
Real rounded_at(double at) {
  if (!std::isfinite(at))
    throw Error(ErrorCode::InvalidArgument, fmt::format("slice at {}; expected a finite coordinate", at));
  constexpr double kMost = std::numeric_limits<Real>::max();
  return static_cast<Real>(std::clamp(at, -kMost, kMost));
}

}  // namespace tegl::detail
