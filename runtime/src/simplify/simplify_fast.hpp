// SPDX-License-Identifier: BSD-3-Clause
//
// Simplification of triangles by the library meshoptimizer, if the build includes it.
#pragma once

#include <span>
#include <vector>

#include "mesh/simplex_shapes.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Reduces the triangles; the points stay (they must be scaled already). `max_error` is an error estimate of
/// meshoptimizer. Errors: InvalidArgument if the build has no meshoptimizer.
std::vector<std::array<Index, 3>> simplify_fast(std::span<const std::array<Index, 3>> triangles,
                                                std::span<const PointN<3>> points, std::size_t count, double max_error,
                                                bool border_fixed);

}  // namespace tegl::detail
