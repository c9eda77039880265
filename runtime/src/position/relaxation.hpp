// SPDX-License-Identifier: BSD-3-Clause
//
// Positions of the points of a contour on their edges that depend only on which samples are high: smooth, without the
// steps of binary images.
#pragma once

#include "position/contour_net.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

struct RelaxationOptions {
  double margin = 0.01;           ///< minimum distance of points from samples, as a share of the edge
  double last_axis_weight = 1.0;  ///< weight of the curves in planes along the last axis
  int rounds = 3;                 ///< of smoothing
  WorkOptions work = {};
};

/// Interpolation parameters of all points of the net. The result does not depend on the number of threads.
template <int N>
Buffer<float> relaxed_positions(const ContourNet<N>& net, const RelaxationOptions& options);

}  // namespace tegl::detail
