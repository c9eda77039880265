// SPDX-License-Identifier: BSD-3-Clause
//
// The arithmetic of bounds by the corners of a simplex, for all corners at a time: those of a tetrahedron in 4-space
// fill a register of AVX2. Other dimensions, and processors with smaller registers, take one corner after the other,
// with the same results, bit by bit.
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
#include <cstddef>
#include <limits>
#include <span>

#include "mesh/simplex_shapes.hpp"

namespace tegl::detail {

/// The corners of a simplex, axis by axis: entry k is for corner k.
template <int N>
struct alignas(N == 4 ? 32 : alignof(double)) CornerLanes {
  std::array<std::array<double, N>, N> axes;

  CornerLanes(const CornersN<N>& corners) {  // NOLINT(google-explicit-constructor)
    for (int k = 0; k < N; ++k) set(k, corners[k]);
  }
  void set(int k, const PointN<N>& p) {
    for (int a = 0; a < N; ++a) axes[a][k] = p[a];
  }
  [[nodiscard]] PointN<N> operator[](int k) const {
    PointN<N> p;
    for (int a = 0; a < N; ++a) p[a] = axes[a][k];
    return p;
  }
};

/// The longest edge of a simplex, as ends_of_longest_edge. Precondition: finite coordinates.
template <int N>
struct LongestEdge {
  int first, second;
  double square;                  ///< of its length
  PointN<N> middle;               ///< of its ends
  std::array<double, N> squares;  ///< of the distances of the corners from that
};

/// One corner after the other.
template <int N>
LongestEdge<N> longest_edge_by_corners(const CornerLanes<N>& corners) {
  LongestEdge<N> edge{0, 1, -1.0, {}, {}};
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < i; ++j) {
      const PointN<N> way = minus(corners[i], corners[j]);
      const double square = dot(way, way);
      if (square > edge.square) {
        edge.square = square;
        edge.first = j;
        edge.second = i;
      }
    }
  edge.middle = between(corners[edge.first], corners[edge.second], 0.5);
  for (int k = 0; k < N; ++k) {
    const PointN<N> way = minus(corners[k], edge.middle);
    edge.squares[k] = dot(way, way);
  }
  return edge;
}

/// The square of the length of that edge.
template <int N>
double square_of_longest_edge(const CornerLanes<N>& corners) {
  return longest_edge_by_corners(corners).square;
}
template <>
double square_of_longest_edge<4>(const CornerLanes<4>& corners);

/// Balls around the corners of a simplex.
template <int N>
struct CornerBalls {
  LongestEdge<N> edge;
  int nearest;              ///< the corner nearest to the middle of that
  double square_of_middle;  ///< of the radius of the ball around the middle
  double bound;             ///< of the distance of all points, at most `limit`; infinity if these balls give none
};

/// The search for a common point: its steps, and their length relative to the way into the ball.
inline constexpr int kMostStepsToCommonPoint = 4;
inline constexpr double kStrideToCommonPoint = 1.1;

/// A bound of at most `limit`; infinity if a short search for q finds none. It begins on the longest edge, and goes
/// into the ball of the corner with the largest sum, step by step. `distances`: of the corners from the contour.
template <int N>
double bound_by_common_point(const CornerLanes<N>& corners, const std::array<double, N>& distances,
                             const LongestEdge<N>& edge, double limit) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double length = std::sqrt(edge.square);
  const double first = distances[edge.first], second = distances[edge.second];
  if (!(length + first + second <= 2.0 * limit)) return kNone;  // the balls of these corners do not meet
  const double share = length > 0.0 ? std::clamp(0.5 + 0.5 * (second - first) / length, 0.0, 1.0) : 0.5;
  PointN<N> q = between(corners[edge.first], corners[edge.second], share);
  for (int step = 0;; ++step) {
    std::array<double, N> ways{};  // of the corners from q
    for (int a = 0; a < N; ++a)
      for (int k = 0; k < N; ++k) {
        const double way = corners.axes[a][k] - q[a];
        ways[k] += way * way;
      }
    for (double& square : ways) square = std::sqrt(square);
    int farthest = 0;
    for (int i = 1; i < N; ++i)
      if (ways[i] + distances[i] > ways[farthest] + distances[farthest]) farthest = i;
    const double bound = ways[farthest] + distances[farthest];
    if (bound <= limit) return bound;
    if (step == kMostStepsToCommonPoint) return kNone;
    const double stride = kStrideToCommonPoint * (bound - limit);
    if (!(stride < ways[farthest])) return kNone;
    q = between(q, corners[farthest], stride / ways[farthest]);
  }
}

/// As balls_around, one corner after the other. Every point of a simplex is within the radius of the smallest ball
/// around it from one of its corners, so at most that plus the largest distance of a corner away from the contour.
/// Jung's theorem bounds the radius by the longest edge.
template <int N>
CornerBalls<N> balls_by_corners(const CornerLanes<N>& corners, const std::array<double, N>& distances, double limit) {
  CornerBalls<N> balls;
  balls.edge = longest_edge_by_corners(corners);
  const auto [least, most] = std::minmax_element(balls.edge.squares.begin(), balls.edge.squares.end());
  balls.nearest = static_cast<int>(least - balls.edge.squares.begin());
  balls.square_of_middle = *most;
  const double square = std::min(*most, balls.edge.square * (N - 1) / (2 * N));
  const double farthest = *std::max_element(distances.begin(), distances.end()), room = limit - farthest;
  balls.bound = room >= 0.0 && square <= room * room ? std::min(limit, farthest + std::sqrt(square))
                                                     : bound_by_common_point<N>(corners, distances, balls.edge, limit);
  return balls;
}
/// A bound by a ball around the corners as a whole, or else by a common point of balls around each of them.
/// `distances`: of the corners from the contour.
template <int N>
CornerBalls<N> balls_around(const CornerLanes<N>& corners, const std::array<double, N>& distances, double limit) {
  return balls_by_corners<N>(corners, distances, limit);
}
template <>
CornerBalls<4> balls_around<4>(const CornerLanes<4>& corners, const std::array<double, 4>& distances, double limit);

/// As SimplexGradients::distance for all corners, from the simplex with this row and these corners. Returns false if
/// that needs another method. Precondition: finite coordinates.
bool distances_by_gradients(std::span<const float, 16> row, const CornersN<4>& simplex, const PointN<4>& origin,
                            const CornerLanes<4>& corners, std::array<double, 4>& distances);

}  // namespace tegl::detail
