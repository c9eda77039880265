// SPDX-License-Identifier: BSD-3-Clause
//
// How large a contour is, and what it encloses: the whole, and as it changes along the last axis.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/error.hpp"

namespace tegl {

/// Measures of a whole contour.
template <int N>
requires DimensionBetween<N, 2, 5>
struct Measures {
  /// Length (N = 2), area (3), 3-volume (4) or 4-volume (5), as Euclid has it: of use where all axes have one unit.
  double size = 0.0;
  /// The enclosed area (N = 2), volume (3) or N-volume, in the product of the axes' units; none where the contour is
  /// open. Positive where high samples are inside.
  std::optional<double> content = {};
  std::array<double, N> centroid{};      ///< of the contour's points; of an empty contour 0
  std::array<double, N> lowest{};        ///< bounding box
  std::array<double, N> highest{};       ///< the other corner
  std::uint64_t boundary_simplices = 0;  ///< (N-2)-faces in exactly one simplex
  /// (N-2)-faces whose simplices' orientations do not cancel. With none the divergence theorem holds, and there is a
  /// content. As many as boundary simplices for what `extract` gives.
  std::uint64_t open_simplices = 0;
};

/// Measures a contour in N = 2 to 5 dimensions. The content is 1/N of the flux of the position, by the divergence
/// theorem. Sums are compensated and in an order that does not depend on the threads. Of a smooth surface {f = 0} the
/// errors of size and content fall with the square of the step of the grid (docs/measures.md).
/// Errors: InvalidArgument (a vertex number out of range, a coordinate that is not finite); Cancelled. O(#S log s) time
/// for s simplices around a vertex, 4 N bytes per simplex and 8 per vertex of memory. Thread-safe.
template <int N, class Real>
Measures<N> measure(const Contour<N, Real>& contour, const WorkOptions& options = {});

/// Measures of one cut "last coordinate = at".
struct CutMeasures {
  double at = 0.0;    ///< the value of the last coordinate
  double size = 0.0;  ///< length (N = 3), area (4) or 3-volume (5) of the cut, in the units of the other axes
  /// The enclosed area (N = 3), volume (4) or 4-volume (5); none where the cut is open.
  std::optional<double> content = {};
};

/// Measures the cuts of a contour in N = 3, 4 or 5 dimensions at any values of the last coordinate, in any order,
/// without making them: of a 4D contour the area and the enclosed volume at times t. Like `slice` it rounds values to
/// Real first; CutMeasures::at is what was asked for.
///
/// Exact, up to rounding: the cut of a simplex has a size that is a B-spline in t with the simplex's vertices as its
/// knots (H. B. Curry and I. J. Schoenberg, On Pólya frequency functions IV, 1966), of degree N - 2, times the spatial
/// part of the simplex's normal vector; with the distance of the cut's plane from the origin, which is linear in t, it
/// gives the content. Where the curve jumps, as pieces lie flat at one time, it is the limit from below, at the
/// contour's first time the one from above. That is the cut that `slice` makes, but where missing values leave the time
/// before without a contour: `slice` then takes the limit from above. Beyond the contour all is 0. Errors:
/// InvalidArgument (a value or a coordinate that is not finite, a vertex number out of range); Cancelled. O(#S log s +
/// h) time for h pairs of a simplex and a cut of it; memory as `measure`, and up to 64 MiB, or 64 bytes for each value.
/// Thread-safe.
template <int N, class Real>
requires DimensionBetween<N, 3, 5> std::vector<CutMeasures> measure_cuts(const Contour<N, Real>& contour,
                                                                         std::span<const double> at,
                                                                         const WorkOptions& options = {});

}  // namespace tegl
