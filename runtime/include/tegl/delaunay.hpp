// SPDX-License-Identifier: BSD-3-Clause
//
// Complexes of scattered points: Delaunay triangulations in 2D to 4D.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tegl/complex.hpp"

namespace tegl {

/// Whether the library was built with Qhull, which `delaunay` needs.
[[nodiscard]] bool has_delaunay() noexcept;

/// The Delaunay triangulation of points in N = 2, 3 or 4 dimensions, as a complex with the point numbers of
/// `points`; set its values to contour them. What lies outside of the convex hull is outside of the complex. Points on
/// a common sphere, as in grids, are triangulated in one of the possible ways, chosen by the points' numbers. (Their
/// heights on the paraboloid are raised by up to 1e-9 of the squared size of the points' box.) Contours are closed
/// oriented manifolds away from the hull.
///
/// Errors: InvalidArgument (fewer than N + 1 points, a coordinate that is not finite, two equal points, all points in a
/// hyperplane; points so close to others that rounding hides them, which are named); TooLarge (2^31 points or more);
/// UnsupportedData (a build without Qhull). Time and memory: as Qhull, about O(P log P) in 2D and 3D; one thread.
///
/// Based on: C. B. Barber, D. P. Dobkin and H. Huhdanpaa, The Quickhull algorithm for convex hulls, 1996 (the library
/// Qhull; the points are not joggled).
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Complex<N> delaunay(std::span<const std::array<double, N>> points);

/// The cells of this triangulation: N + 1 numbers of points for each, consistently oriented. Errors: as
/// `delaunay`.
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] std::vector<Index> delaunay_corners(std::span<const std::array<double, N>> points);
/// The same for a vector.
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] std::vector<Index> delaunay_corners(const std::vector<std::array<double, N>>& points) {
  return delaunay_corners<N>(std::span<const std::array<double, N>>(points));
}

}  // namespace tegl
