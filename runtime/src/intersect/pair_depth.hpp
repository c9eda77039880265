// SPDX-License-Identifier: BSD-3-Clause
//
// How deep two simplices that intersect are in each other.
#pragma once

#include "intersect/simplex_planes.hpp"

namespace tegl::detail {

/// The smallest distance by which one of two simplices has to be moved, in any direction, so that a hyperplane has the
/// simplices on different sides or in it. 0 if there is such a hyperplane already: they touch, or lie in one
/// hyperplane. Up to rounding: 0 also if the distance is within the rounding errors. Coordinates may have any
/// exponents; the result is at most the largest finite number.
template <int N>
double depth_of(const CornersN<N>& a, const CornersN<N>& b) noexcept;

}  // namespace tegl::detail
