// SPDX-License-Identifier: BSD-3-Clause
//
// Exact decision whether two simplices meet outside of their common face, and whether points lie in a plane.
#pragma once

#include <span>

namespace tegl::detail {

/// Coordinates of a vertex: `dimension` numbers.
using PointRef = const double*;

/// Whether the simplices conv(common, first) and conv(common, second) have a common point outside of conv(common),
/// exactly; then `place` is one, rounded. Each of the two must be affinely independent, `first` and `second` not empty;
/// `dimension` is 2, 3 or 4, and each simplex has at most that many vertices. Coordinates must be finite. Thread-safe.
[[nodiscard]] bool meet_exactly(int dimension, std::span<const PointRef> common, std::span<const PointRef> first,
                                std::span<const PointRef> second, double* place);

/// Whether the points are affinely dependent, exactly: for `dimension` points, whether the simplex has measure zero.
[[nodiscard]] bool are_dependent(int dimension, std::span<const PointRef> points);

}  // namespace tegl::detail
