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
  std::array<std::array<const double*, kEdgeLanes>, N> places;  ///< by corner: until measure_lanes
  EdgeLanes moving;                                             ///< number of the corner that moves
  std::array<std::array<EdgeLanes, N>, N> corners;              ///< by corner, then by axis; set by measure_lanes
  ShapeLanes<N> before;                                         ///< set by measure_lanes

  void set_corner(std::size_t k, int corner, const PointN<N>& place) { places[corner][k] = place.data(); }
};

/// Sets `corners` and `before`.
template <int N>
void measure_lanes(SimplexLanes<N>& simplices);
/// The shapes after the corners have moved to `place`.
template <int N>
void move_lanes(const SimplexLanes<N>& simplices, const PointN<N>& place, ShapeLanes<N>& after);

/// Some edges with one end in common, and the cost of contracting each to the minimum of its quadric. The edges must
/// not be bound to hyperplanes.
template <int N>
struct alignas(64) TargetLanes {
  std::array<const double*, kEdgeLanes> quadrics;  ///< of the other ends
  std::array<const double*, kEdgeLanes> places;    ///< of the other ends
  EdgeLanes is_first;                              ///< 1 for other ends with a smaller number, else 0
  EdgeLanes cost;
  EdgeLanes square;  ///< of the length
  EdgeLanes is_far;  ///< 1 if the minimum is too far away, or the edge has no length; else 0

  /// The other end of edge k. Both must outlive find_target_lanes.
  void set(std::size_t k, const Quadric<N>& quadric, const PointN<N>& place, bool first) {
    quadrics[k] = quadric.values().data();
    places[k] = place.data();
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
