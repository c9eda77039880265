// SPDX-License-Identifier: BSD-3-Clause
//
// Triangles by the library meshoptimizer, where the build has it.
#pragma once

#include <span>
#include <vector>

#include "mesh/simplex_shapes.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Fewer triangles between the same points (which are to be scaled already). `max_error` is what meshoptimizer makes of
/// it, an estimate. Errors: InvalidArgument if the build has no meshoptimizer.
std::vector<std::array<Index, 3>> simplify_fast(std::span<const std::array<Index, 3>> triangles,
                                                std::span<const PointN<3>> points, std::size_t count, double max_error,
                                                bool border_fixed);

}  // namespace tegl::detail
