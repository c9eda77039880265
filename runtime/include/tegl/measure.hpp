// SPDX-License-Identifier: BSD-3-Clause
//
// Size and enclosed content of a contour: of the whole, and of its cuts along the last axis.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/incidence.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Measures of a whole contour.
template <int N>
requires DimensionBetween<N, 2, 5>
struct Measures {
  /// Euclidean length (N = 2), area (3), 3-volume (4) or 4-volume (5); meaningful if all axes have one unit.
  double size = 0.0;
  /// The enclosed area (N = 2), volume (3) or N-volume, in the product of the axes' units; none if the contour is open.
  /// Positive if high samples are inside. A wrapped contour encloses it if no component winds round a period, so that
  /// all are closed when unrolled; or, if components wind, if it does not separate the two ends of an axis that is not
  /// periodic. Otherwise there is none.
  std::optional<double> content = {};
  std::array<double, N> centroid{};      ///< of the contour's points; 0 for an empty contour
  std::array<double, N> lowest{};        ///< minimum corner of the bounding box
  std::array<double, N> highest{};       ///< maximum corner of the bounding box
  std::uint64_t boundary_simplices = 0;  ///< (N-2)-faces in exactly one simplex
  /// (N-2)-faces at which the orientations of the simplices do not cancel. If there are none, the divergence theorem
  /// holds and `content` is set. Equals boundary_simplices for contours that `extract` made.
  std::uint64_t open_simplices = 0;
};

/// Measures a contour in N = 2 to 5 dimensions. The content is 1/N of the flux of the position vector, by the
/// divergence theorem. Sums are compensated, in an order that does not depend on the number of threads. For a smooth
/// surface {f = 0} the errors of size and content decrease with the square of the grid step (docs/measures.md). Open
/// faces are found with fixed random numbers: each is overlooked with a probability below 1e-16 (docs/measures.md).
/// Errors: InvalidArgument (a vertex number out of range, a coordinate that is not finite); Cancelled. O(#S + b log b)
/// time for b faces between vertices of open faces; memory of 8 N - 11 bytes per vertex, 8 more per vertex and thread
/// (of at most 8), and the b faces. If most vertices are on open faces: O(#S log s) for s simplices around a vertex,
/// and 4 N + 4 bytes per simplex. Thread-safe.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Measures<N> measure(const Contour<N, Real>& contour, const WorkOptions& work = {});
/// The same with the contour's incidence, without random numbers. Errors: also InvalidArgument if it is another
/// contour's.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Measures<N> measure(const Contour<N, Real>& contour, const Incidence<N>& incidence,
                                  const WorkOptions& work = {});

/// Measures of one cut "last coordinate = at".
struct CutMeasures {
  double at = 0.0;    ///< the value of the last coordinate
  double size = 0.0;  ///< length (N = 3), area (4) or 3-volume (5) of the cut, in the units of the other axes
  /// The enclosed area (N = 3), volume (4) or 4-volume (5); none if the cut is open.
  std::optional<double> content = {};
};

/// Measures cuts of a contour in N = 3, 4 or 5 dimensions without making them, at any values of the last coordinate in
/// any order: for a 4D contour, area and enclosed volume at times t. Values are rounded to Real first, as in `slice`;
/// CutMeasures::at is the requested value.
///
/// Exact up to rounding. The size of a simplex's cut is a B-spline in t of degree N - 2 with the simplex's vertices as
/// knots (H. B. Curry and I. J. Schoenberg, On Pólya frequency functions IV, 1966), times the spatial part of the
/// simplex's normal vector. The content follows from it and the distance of the cut's plane from the origin, which is
/// linear in t. If the curve jumps because parts are flat at one time, the result is the limit from below; at the
/// contour's first time, the limit from above. This is the cut that `slice` makes, except if missing values leave no
/// contour before that time: `slice` then takes the limit from above. Values beyond the contour give 0. The cuts of a
/// wrapped contour are made as by `slice` and measured, one by each thread at a time; a content is as in Measures. If
/// they cross a period, every value has a cut, and those of values that differ by multiples of `CutPeriod::length` are
/// measured once: they are equal, or moved.
///
/// Errors: InvalidArgument (a value or a coordinate that is not finite, a vertex number out of range, a wrapped contour
/// unless `cuts_wrapped`, and as `slice`); Cancelled. O(#S + h) time, and that of `measure` for open faces, for h
/// pairs of a simplex and its cut; memory as `measure`, plus up to 32 MiB, or 32 bytes for each value. Of a wrapped
/// contour: O(#S + #V + h log h) time, and O(#S + #V) more for each 256 values; across a period O(c log c) more, and
/// about 100 bytes for each of the c simplices that values touch within one period. Thread-safe.
template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5>
[[nodiscard]] std::vector<CutMeasures> measure_cuts(const Contour<N, Real>& contour, std::span<const double> at,
                                                    const WorkOptions& work = {});
/// The same for a list: `measure_cuts(contour, {1.0, 2.0})`.
template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5>
[[nodiscard]] std::vector<CutMeasures> measure_cuts(const Contour<N, Real>& contour, std::initializer_list<double> at,
                                                    const WorkOptions& work = {}) {
  return measure_cuts(contour, std::span<const double>(at.begin(), at.size()), work);
}

}  // namespace tegl
