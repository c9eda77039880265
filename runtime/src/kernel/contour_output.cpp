// SPDX-License-Identifier: BSD-3-Clause
//
// Checks of an extraction's arguments and of its number of vertices.
#include "kernel/contour_output.hpp"

#include <cmath>

#include <fmt/format.h>

#include "tegl/error.hpp"

namespace tegl::detail {

void check_vertex_count(std::uint64_t count, std::uint64_t limit) {
  if (count > limit)
    throw Error(ErrorCode::TooLarge,
                fmt::format("the contour has more than {} vertices; contour parts of the image instead", limit));
}

void check_arguments(double isovalue, const ExtractOptions& options) {
  if (!std::isfinite(isovalue))
    throw Error(ErrorCode::InvalidIsovalue, fmt::format("isovalue {}; expected a finite number", isovalue));
  if (!(options.epsilon >= 0.0 && options.epsilon < 0.5))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("epsilon {}; expected at least 0 and below 0.5", options.epsilon));
  if (options.ambiguity == Ambiguity::custom && !options.estimator.choose)
    throw Error(ErrorCode::InvalidArgument,
                "ambiguity custom without an estimator; expected one in "
                "ExtractOptions::estimator");
}

}  // namespace tegl::detail
