// SPDX-License-Identifier: BSD-3-Clause
//
// Validation of the options of a simplification.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "tegl/error.hpp"
#include "tegl/simplify.hpp"

namespace tegl::detail {

inline constexpr std::size_t kMostPlanes = 20;

/// Throws InvalidArgument with the value and the expected one.
template <int N>
void require_options(const SimplifyOptions<N>& options) {
  const auto fail = [](const std::string& message) { throw Error(ErrorCode::InvalidArgument, message); };
  const bool curvature = options.method == SimplifyMethod::facets && std::isfinite(options.max_curvature);
  if (!options.count && !options.ratio && !options.max_error && !curvature)
    fail("no goal; expected a count of simplices, a ratio, a largest error or, for facets, a largest curvature");
  if (options.ratio && !(*options.ratio >= 0.0 && *options.ratio <= 1.0))
    fail(fmt::format("the ratio is {}; expected 0 <= ratio <= 1", *options.ratio));
  if (options.max_error && !(*options.max_error >= 0.0))
    fail(fmt::format("the largest error is {}; expected 0 or more", *options.max_error));
  if (!(options.max_curvature >= 0.0))
    fail(fmt::format("the largest curvature is {}; expected 0 or more", options.max_curvature));
  if (options.method != SimplifyMethod::facets && options.max_curvature != std::numeric_limits<double>::infinity())
    fail(fmt::format("max_curvature is {} for another method than facets; expected no limit", options.max_curvature));
  if (options.method != SimplifyMethod::fast && options.allow_nonmanifold)
    fail("allow_nonmanifold for another method than fast; expected false");
  if (options.method == SimplifyMethod::fast && options.keep_embedded)
    fail("keep_embedded for the method fast; expected another method, or false");
  if (options.planes.size() > kMostPlanes)
    fail(fmt::format("{} hyperplanes; expected at most {}", options.planes.size(), kMostPlanes));
  for (const double scale : options.scale)
    if (!(scale > 0.0 && std::isfinite(scale))) fail(fmt::format("a scale is {}; expected a positive number", scale));
  if (options.method == SimplifyMethod::fast && N != 3)
    fail(fmt::format("the fast method is for triangles; expected another one for simplices in {} dimensions", N));
}

}  // namespace tegl::detail
