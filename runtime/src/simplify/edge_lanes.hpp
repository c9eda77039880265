// SPDX-License-Identifier: BSD-3-Clause
//
// The arithmetic of edge collapse for several simplices or edges at a time: array entry k is for simplex or edge k.
// Results are the same, bit by bit, as those of the functions for one simplex or edge.
#pragma once

#include <array>
#include <cstddef>

#include "mesh/simplex_shapes.hpp"
#include "simplify/quadric.hpp"

namespace tegl::detail {

/// Maximum number of values of a register.
inline constexpr std::size_t kEdgeLanes = 8;
using EdgeLanes = std::array<double, kEdgeLanes>;

/// The shapes of some simplices.
template <int N>
struct alignas(64) ShapeLanes {
  std::array<EdgeLanes, N> normal;
  EdgeLanes length;  ///< of the normal
  EdgeLanes shape;
};

/// Some simplices, of which one corner moves.
template <int N>
struct alignas(64) SimplexLanes {
  std::array<std::array<EdgeLanes, N>, N> corners;  ///< by corner, then by axis
  EdgeLanes moving;                                 ///< number of the corner that moves
  ShapeLanes<N> before;                             ///< set by measure_lanes

  void set(std::size_t k, const CornersN<N>& at, int moving_corner) {
    for (int i = 0; i < N; ++i)
      for (int a = 0; a < N; ++a) corners[i][a][k] = at[i][a];
    moving[k] = moving_corner;
  }
};

/// Sets `before`.
template <int N>
void measure_lanes(SimplexLanes<N>& simplices);
/// The shapes after the corners have moved to `place`.
template <int N>
void move_lanes(const SimplexLanes<N>& simplices, const PointN<N>& place, ShapeLanes<N>& after);

/// Some edges with one end in common, and the cost of contracting each to the minimum of its quadric. The edges must
/// not be bound to hyperplanes.
template <int N>
struct alignas(64) TargetLanes {
  std::array<EdgeLanes, Quadric<N>::kValues> quadrics;  ///< of the other ends
  std::array<EdgeLanes, N> places;                      ///< of the other ends
  EdgeLanes is_first;                                   ///< 1 for other ends with a smaller number, else 0
  EdgeLanes cost;
  EdgeLanes square;  ///< of the length
  EdgeLanes is_far;  ///< 1 if the minimum is too far away, or the edge has no length; else 0

  void set(std::size_t k, const Quadric<N>& quadric, const PointN<N>& place, bool first) {
    const auto& values = quadric.values();
    for (std::size_t i = 0; i < values.size(); ++i) quadrics[i][k] = values[i];
    for (int a = 0; a < N; ++a) places[a][k] = place[a];
    is_first[k] = first ? 1.0 : 0.0;
  }
};

/// The common end of the edges, and how points are scaled.
template <int N>
struct TargetInput {
  const Quadric<N>& quadric;
  const PointN<N>& place;
  const PointN<N>& centre;
  const std::array<double, N>& scale;
  double most_square;  ///< largest square of the distance from the middle of an edge, in squares of its length
  bool single_precision;
};
/// Sets cost, square and is_far.
template <int N>
void find_target_lanes(const TargetInput<N>& input, TargetLanes<N>& edges);

}  // namespace tegl::detail
