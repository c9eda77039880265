// SPDX-License-Identifier: BSD-3-Clause
//
// How far apart are two contours? Bounds that hold, not samples.
#pragma once

#include <array>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"

namespace tegl {

template <int N>
struct DeviationOptions {
  /// Distances are taken after coordinates were multiplied by these: what makes axes of different units comparable.
  std::array<double, N> scale = all_one();
  unsigned threads = 0;  ///< 0: all that the machine has. The result is the same, byte by byte.
  Progress progress;

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
  double least = 0;  ///< and some point of it, a vertex, is as far as this: the truth lies in between
  std::vector<double> of_from;  ///< #S of `from`: the bound for each of its simplices
  std::vector<double> of_to;    ///< #S of `to`: the largest distance of what was matched with it; 0 if nothing was
};

/// One half of the Hausdorff distance; call it both ways for the whole. N = 2, 3, 4; Real: float or double.
///
/// Each simplex of `from` is cut, along its normal, into the parts that lie above or below simplices of `to` that face
/// the same way. Over such a part the distance along the normal is linear, so its corners tell the largest. What no
/// simplex of `to` covers (next to borders, say) is measured by the distances of its corners from one simplex, which
/// bound those of all points between, as that distance is convex. So the bound is one up to rounding (up to some 1e-4
/// of the longest edge of a tetrahedron, where it alone can tell a gap between those that cover it from none); it is
/// never less than the distance of a vertex. For contours that are close to each other it exceeds the distance by the
/// cosine between their normals, for others by more.
///
/// Errors: InvalidArgument (a scale that is not positive, a vertex number out of range), Cancelled. Time: about
/// O(S log S) for contours that are close to each other.
template <int N, class Real>
Deviation deviation(const Contour<N, Real>& from, const Contour<N, Real>& to, const DeviationOptions<N>& options = {});

}  // namespace tegl
