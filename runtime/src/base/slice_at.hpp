// SPDX-License-Identifier: BSD-3-Clause
//
// Where to cut, as both ways of cutting understand it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "tegl/error.hpp"

namespace tegl::detail {

/// The hyperplane's coordinate in the precision of the vertices, so that it meets a vertex computed for the same
/// number. Rounding is monotone, so what lies on either side of `at` stays there or comes to lie on it.
template <class Real>
Real rounded_at(double at) {
  if (!std::isfinite(at))
    throw Error(ErrorCode::InvalidArgument, fmt::format("cut at {}; expected a finite coordinate", at));
  constexpr double kMost = std::numeric_limits<Real>::max();
  return static_cast<Real>(std::clamp(at, -kMost, kMost));
}

}  // namespace tegl::detail
