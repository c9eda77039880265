// SPDX-License-Identifier: BSD-3-Clause
//
// How far apart are two contours? Bounds that hold, not samples.
#pragma once

#include <array>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"

namespace tegl {

/// How distances are measured.
template <int N>
requires DimensionBetween<N, 2, 4>
struct DeviationOptions {
  /// Distances are taken after coordinates were multiplied by these: what makes axes of different units comparable.
  std::array<double, N> scale = all_one();
  /// No bound of a simplex has to be less than that: where it is, closer ones cost time. They hold all the same.
  double enough = 0.0;
  unsigned threads = 0;    ///< 0: all that the machine has. The result is the same, byte by byte.
  Progress progress = {};  ///< see Progress

 private:
  static constexpr std::array<double, N> all_one() {
    std::array<double, N> result{};
    result.fill(1.0);
    return result;
  }
};

/// Bounds of the distance of every point of one contour from another.
struct Deviation {
  double bound = 0;  ///< no point of `from` is farther than this from `to` (infinite if only one of them is empty)
  double least = 0;  ///< and some point of it is as far as this: the truth lies in between
  std::vector<double> of_from = {};  ///< #S of `from`: the bound for each of its simplices
  std::vector<double> of_to = {};    ///< #S of `to`: the largest distance of what was matched with it; 0 if nothing was
};

/// One half of the Hausdorff distance; call it both ways for the whole. N = 2, 3, 4; Real: float or double.
///
/// Over each simplex of `from`, along its normal, the simplices of `to` are told apart into sheets by their heights. A
/// sheet that has no border there and passes over one point of the simplex passes over all of it (that is topology, not
/// a comparison of sizes), so no point is farther than the sheet is high. Where no sheet does (next to borders, say),
/// the distances of the corners from one simplex of `to` bound those of all points between, as that distance is convex.
/// A simplex for which that tells too little is halved, up to 24 times, and those with the largest bounds up to 400
/// times. So the bound holds up to the rounding of coordinates, whatever the gaps, folds or flat simplices; 1e-11 of an
/// edge is added where the rim of a simplex has to be left out. It is at most 1.25 times the distance of some point of
/// its simplex, or half of `least` (or `enough`), or a fiftieth of the longest edge, unless the parts did not suffice:
/// that is so in contours that are rough as finely as they are divided. Sheets are seen where orientations are
/// consistent; vertices at the same place count as one.
///
/// Errors: InvalidArgument (a scale that is not positive, a vertex number out of range, a coordinate that is not
/// finite), Cancelled. Time: about O(S log S) for contours that are close to each other. Memory: about 300 bytes for
/// each simplex of either.
template <int N, class Real>
requires DimensionBetween<N, 2, 4> Deviation deviation(const Contour<N, Real>& from, const Contour<N, Real>& to,
                                                       const DeviationOptions<N>& options = {});

}  // namespace tegl
