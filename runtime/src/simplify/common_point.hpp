// SPDX-License-Identifier: BSD-3-Clause
//
// A bound of the distance of a simplex from a contour, by the distances of its corners.
//
// Principle. Let q be any point, and b the largest sum of a corner's distances from q and from the contour. Then every
// point x of the simplex is within b of the contour. Proof: around each corner, take the ball whose radius is b less
// the corner's distance from the contour. Each ball contains q, and no point of it is farther than b from the contour.
// At q, no square of the distance from a corner exceeds the square of its radius. The mean of these differences,
// weighted by the barycentric coordinates of x, is least at x. So it is at most 0 there, and x is in one of the balls.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/simplex_shapes.hpp"
#include "simplify/corner_lanes.hpp"

namespace tegl::detail {

/// The distances of the corners from q.
template <int N>
std::array<double, N> distances_from(const CornerLanes<N>& corners, const PointN<N>& q) {
  std::array<double, N> result{};
  for (int a = 0; a < N; ++a)
    for (int k = 0; k < N; ++k) {
      const double way = corners.axes[a][k] - q[a];
      result[k] += way * way;
    }
  for (double& square : result) square = std::sqrt(square);
  return result;
}

/// A bound of at most `limit`; infinity if a short search for q finds none. It begins on the longest edge, and goes
/// into the ball of the corner with the largest sum, step by step. `distances`: of the corners from the contour.
template <int N>
double bound_by_common_point(const CornerLanes<N>& corners, const std::array<double, N>& distances,
                             const LongestEdge<N>& edge, double limit) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  constexpr int kMostSteps = 4;
  constexpr double kStride = 1.1;  // relative to the way into the ball
  const double length = std::sqrt(edge.square);
  const double first = distances[edge.first], second = distances[edge.second];
  if (!(length + first + second <= 2.0 * limit)) return kNone;  // the balls of these corners do not meet
  const double share = length > 0.0 ? std::clamp(0.5 + 0.5 * (second - first) / length, 0.0, 1.0) : 0.5;
  PointN<N> q = between(corners[edge.first], corners[edge.second], share);
  for (int step = 0;; ++step) {
    const std::array<double, N> ways = distances_from<N>(corners, q);
    int farthest = 0;
    for (int i = 1; i < N; ++i)
      if (ways[i] + distances[i] > ways[farthest] + distances[farthest]) farthest = i;
    const double bound = ways[farthest] + distances[farthest];
    if (bound <= limit) return bound;
    if (step == kMostSteps) return kNone;
    const double stride = kStride * (bound - limit);
    if (!(stride < ways[farthest])) return kNone;
    q = between(q, corners[farthest], stride / ways[farthest]);
  }
}

}  // namespace tegl::detail
