// SPDX-License-Identifier: BSD-3-Clause
//
// Images whose cells are divided into simplices: contours without ambiguous cells, with more simplices.
//
// Based on: M. Liversage, thesis, 1994, section 9.3: asymmetric and symmetric divisions in any dimension, and the
// hybrid of 9.3.12.
#pragma once

#include <cstdint>
#include <string_view>

#include "tegl/complex.hpp"
#include "tegl/image.hpp"
#include "tegl/periodic.hpp"

namespace tegl {

/// How the cells of a grid are divided.
enum class Division : std::uint8_t {
  /// Kuhn's: N! simplices (2, 6, 24, 120), each along a path from the lowest to the highest corner. The same in all
  /// cells, so contours prefer one diagonal.
  kuhn,
  /// 2 triangles or 5 tetrahedra. Neighbouring cells are mirror images of each other. Only in 2D and 3D.
  alternating,
  /// 2^(N-1) N! simplices (4, 24, 192, 1 920): cones over the faces from their centres. The value of a centre is the
  /// mean of the face's corners. All symmetries of the cell.
  symmetric,
  /// As `symmetric`, but only in cells that are ambiguous at the isovalue, and there only their ambiguous faces have
  /// centres: other faces are squares, as in the neighbours, so there are no cracks. Most cells are not divided. Only
  /// in 2D and 3D.
  hybrid,
};

/// The name of a division, such as "kuhn".
[[nodiscard]] std::string_view name_of(Division division) noexcept;

/// The cells of an image's grid, divided, with the values of the samples. `extract` of it is the contour. Points are
/// numbered as samples, axis 0 fastest; centres follow. `isovalue`: for `hybrid`, the isovalue of the contour; ignored
/// otherwise. Simplices (and cells that are not divided) with a missing corner have no contour. Errors: InvalidArgument
/// (a division that the dimension does not have), TooLarge (2^32 points or cells or more). O(P) time; per sample about
/// 130 bytes in 3D (kuhn), 660 (symmetric); in 4D 600 and 5 000.
template <Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Complex<N> divided_complex(const Image<T, N>& image, Division division, double isovalue = 0.0);

/// As `extract_divided`, with counts and times. `tiles` are simplices, or cells that are not divided.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Extraction<N, Real> extract_divided_with_stats(const Image<T, N>& image, Division division,
                                                             double isovalue, const ExtractOptions& options = {},
                                                             const AxisPeriods<N>& periods = {});

/// Extracts the contour of an image whose cells are divided. In 2D to 4D, without periodic axes, it has the vertices
/// and simplices of the contour of `divided_complex`; its normals are others. In 5D the simplices are not stored; the
/// contour is an oriented manifold with a boundary at the image border and at missing values only. Its vertices lie on
/// the edges of the division, in the order of the cells, and if samples equal the isovalue, they are kept off the
/// layers of the last two axes as by `extract`. Between two simplices of high and of low points, a simplex has the
/// monotone paths through the product of the two, with points in the order of their coordinates, the last axis first.
/// So contours do not intersect themselves, and their cut at a layer is, up to diagonals, the divided contour of the
/// layer.
///
/// Simplices with a missing corner are left out. The centre of a face with a missing corner is missing, too, so
/// `symmetric` and `hybrid` leave out whole cells, and so is the mean of infinite samples of both signs. Beside them
/// the contour is made a manifold as by `extract`.
///
/// `periods`: of periodic axes (tegl/periodic.hpp; 0: not periodic). Cells across the seam connect the last samples to
/// the first ones, and the contour is wrapped (Contour::periods). `alternating` needs an even number of samples along
/// them. In 5D, steps of half a period or more are allowed; `unroll`, sizes and cuts then go the other way round.
///
/// Normals are the image's gradients, of all kinds except `context`: linear along the edges of the division, with the
/// mean of the corners' gradients at centres. So missing values do not count. They use the neighbours across the seam;
/// the samples of an image with periodic axes are copied for them.
///
/// In 5D nothing is ambiguous, and `ambiguity` has no effect. Errors: those of `divided_complex`, of `extract` of
/// complexes and of `extract_periodic`; InvalidArgument for normals by context, for an odd number of samples along a
/// periodic axis with `alternating`, and in 5D for other triangulations than compact. Time in 5D: a pass over the
/// samples for missing values, one over the cells, which reads each row of samples up to 16 times, and some
/// microseconds (kuhn) or tens of microseconds (symmetric) per active cell. Memory beside the contour: 80 bytes (kuhn)
/// or 280 (symmetric) per active cell, for a moment one byte per sample, and with missing values five bytes per sample.
/// The result does not depend on the number of threads.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Contour<N, Real> extract_divided(const Image<T, N>& image, Division division, double isovalue,
                                               const ExtractOptions& options = {}, const AxisPeriods<N>& periods = {}) {
  return extract_divided_with_stats<Real>(image, division, isovalue, options, periods).contour;
}

/// Counts the vertices and simplices that `extract_divided` would make, exactly; with periods in 2D to 4D and with
/// missing values by making them. Errors: as `extract_divided`; in 5D TooLarge only with missing values.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] ContourSize count_divided(const Image<T, N>& image, Division division, double isovalue,
                                        const ExtractOptions& options = {}, const AxisPeriods<N>& periods = {});

}  // namespace tegl
