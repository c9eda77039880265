// SPDX-License-Identifier: BSD-3-Clause
//
// The arithmetic of bounds by the corners of a simplex, for all corners at a time: those of a tetrahedron in 4-space
// fill a register of AVX2. Other dimensions, and processors with smaller registers, take one corner after the other,
// with the same results, bit by bit.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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
template <int N>
LongestEdge<N> longest_edge_of(const CornerLanes<N>& corners) {
  return longest_edge_by_corners(corners);
}
template <>
LongestEdge<4> longest_edge_of(const CornerLanes<4>& corners);

/// As SimplexGradients::distance for all corners, from the simplex with this row and these corners. Returns false if
/// that needs another method. Precondition: finite coordinates.
bool distances_by_gradients(std::span<const float, 16> row, const CornersN<4>& simplex, const PointN<4>& origin,
                            const CornerLanes<4>& corners, std::array<double, 4>& distances);

}  // namespace tegl::detail
