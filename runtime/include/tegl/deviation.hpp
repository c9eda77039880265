// SPDX-License-Identifier: BSD-3-Clause
//
// The distance of two contours: guaranteed bounds, not samples.
#pragma once

#include <array>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Options of `deviation`.
template <int N>
requires DimensionBetween<N, 2, 4>
struct DeviationOptions {
  /// Coordinates are multiplied by these factors before distances are measured, to make axes of different units
  /// comparable.
  std::array<double, N> scale = detail::all_one<N>();
  /// Bounds below this, or below half of the largest known distance, are not refined further, which saves time. If it
  /// is 0, bounds below the largest known distance are not refined. All bounds stay valid.
  double enough = 0.0;
  WorkOptions work = {};  ///< threads and progress
};

/// Bounds of the distance of the points of one contour from another contour.
struct Deviation {
  double bound = 0;  ///< upper bound of the maximum distance (infinite if exactly one contour is empty)
  double least = 0;  ///< lower bound of the maximum distance: some point of `from` is this far from `to`
  std::vector<double> of_from = {};  ///< #S of `from`: upper bound for each simplex
  std::vector<double> of_to = {};    ///< #S of `to`: upper bound for the points matched with it; 0 if none
};

/// The one-sided Hausdorff distance; call it in both directions for the symmetric one. N = 2, 3, 4; Real: float or
/// double.
///
/// Method. A simplex that is not much larger than the largest distance is bounded in up to 48 parts (4D: 128): each by
/// the distances of its corners from one simplex of `to`, because this distance is convex, by balls around its corners,
/// or by one around the middle of its longest edge. Above each other simplex of `from`, along its normal, the simplices
/// of `to` are grouped by height. A group without a border there that covers one point of the simplex covers all of it
/// (by topology, without comparing sizes), so the group's height bounds the distance. If there is no such group, for
/// instance next to borders, the distances of the corners bound the distances of all points between. A simplex with a
/// loose bound is halved, up to 24 times; those with the largest bounds up to 400 times. A flat simplex is at most its
/// thickness farther away than its neighbours across some facets. Simplices are measured in rounds of increasing size,
/// each with the largest distance of the earlier ones, below which bounds need no refinement.
///
/// So the bound holds up to the rounding of coordinates, with any gaps, folds or flat simplices; 1e-11 of an edge is
/// added to most. The bound of a simplex is at most 1.25 times the distance of one of its points, or `least` (with
/// `enough`: that or half of `least`), or a fiftieth of the longest edge, unless the limit of halvings was reached:
/// that happens for contours that are rough at the scale of their simplices. Groups are recognised if orientations are
/// consistent; coincident vertices count as one.
///
/// Errors: InvalidArgument (a scale that is not positive, a vertex number out of range, a coordinate that is not
/// finite), Cancelled. Time: about O(S log S) for contours that are close to each other. Memory: about 300 bytes for
/// each simplex of both.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Deviation deviation(const Contour<N, Real>& from, const Contour<N, Real>& to,
                                  const DeviationOptions<N>& options = {});

}  // namespace tegl
