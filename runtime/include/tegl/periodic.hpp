// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images with periodic axes: longitudes, unit cells of crystals, simulations with periodic boundaries.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"

namespace tegl {

/// The period of each axis in its own unit; 0: the axis is not periodic.
template <int N>
using AxisPeriods = std::type_identity_t<Vector<N>>;

/// The periods of `axes`: the number of samples x the step, so that the first sample follows the last one after one
/// step; along an uneven axis, the length plus the mean step. Errors: InvalidArgument for an axis that the grid does
/// not have.
template <int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] AxisPeriods<N> sample_periods(const Grid<N>& grid, std::span<const int> axes);

/// Whether a unit is one of longitudes: degrees_east, degree_east, degree_E, degrees_E, degreeE or degreesE.
[[nodiscard]] bool is_longitude_unit(std::string_view unit) noexcept;

/// The periods of longitudes: 360 for each even axis with a unit of longitudes (`is_longitude_unit`) whose samples span
/// 360 degrees without repeating the first one, to less than half a step; 0 for the others, and for axes that the world
/// map mixes with others. If the world map scales the axis, longitudes are the world's, and the period is 360 there.
template <int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] AxisPeriods<N> longitude_periods(const Grid<N>& grid);

/// How many periods x is from the origin, along the period's vector: in a wrapped contour, from Period::start on.
template <int N>
[[nodiscard]] double share_of(const Period<N>& period,
                              const std::type_identity_t<std::array<double, static_cast<std::size_t>(N)>>& x) noexcept {
  double share = 0.0;
  for (int a = 0; a < N; ++a) share += period.dual[a] * x[a];
  return share;
}

/// A periodic axis with its first sample repeated at the end, one period further, in the direction of the axis.
/// Uniform if the axis is and its step leads there.
[[nodiscard]] Axis longer_axis(const Axis& axis, double period);

/// Periods as numbers, as files store them: for each `vector`, `dual` and `start`.
template <int N>
[[nodiscard]] std::vector<double> period_numbers(const std::vector<Period<N>>& periods) {
  std::vector<double> numbers;
  for (const Period<N>& period : periods) {
    numbers.insert(numbers.end(), period.vector.begin(), period.vector.end());
    numbers.insert(numbers.end(), period.dual.begin(), period.dual.end());
    numbers.push_back(period.start);
  }
  return numbers;
}

/// The periods with these numbers, 2 N + 1 for each; what remains is ignored.
template <int N>
[[nodiscard]] std::vector<Period<N>> periods_of_numbers(std::span<const double> numbers) {
  std::vector<Period<N>> periods(numbers.size() / (2 * N + 1));
  auto at = numbers.begin();
  for (Period<N>& period : periods) {
    for (double& x : period.vector) x = *at++;
    for (double& x : period.dual) x = *at++;
    period.start = *at++;
  }
  return periods;
}

/// As `extract_periodic`, with counts and times.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Extraction<N, Real> extract_periodic_with_stats(const Image<T, N>& image, const AxisPeriods<N>& periods,
                                                              double isovalue, const ExtractOptions& options = {});

/// Extracts the contour of an image with periodic axes: there is one more layer of tiles, between the last and the
/// first sample. The result is *wrapped*: vertices on the seam are there once, all vertices are inside the periods,
/// and simplices across the seam connect vertices at both ends (Contour::periods). So check, components,
/// track, measure, cuts along the seam and elements have the contour's true topology and geometry. `unroll` makes a
/// contour for pictures and for all other functions.
///
/// At missing values the contour is made a manifold across the seam, too. Normals use the neighbours across the seam.
/// ExtractOptions::close closes the contour at the borders of the other axes. The result does not depend on the number
/// of threads. Errors: as `extract`; InvalidArgument for a period that is not positive and finite, or not more than the
/// span of its axis, for fewer than three samples, for a step of half a period or more (as the one across the seam with
/// a period in another unit), and for Ambiguity::custom. Time: as `extract`, and O(V / 64) and that of the vertices on
/// the seam for merging. If only the last axis is periodic, samples are not copied; otherwise a few layers at a time.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Contour<N, Real> extract_periodic(const Image<T, N>& image, const AxisPeriods<N>& periods,
                                                double isovalue, const ExtractOptions& options = {}) {
  return extract_periodic_with_stats<Real>(image, periods, isovalue, options).contour;
}

/// Counts the vertices and simplices that `extract_periodic` would make, exactly; see `count`. Errors: those of
/// `extract_periodic`. Images with missing values are contoured in memory.
template <Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] ContourSize count_periodic(const Image<T, N>& image, const AxisPeriods<N>& periods, double isovalue,
                                         const ExtractOptions& options = {});

/// A contour whose vertices on the seam are doubled.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
struct Unrolled {
  Contour<N, Real> contour = {};  ///< without periods
  Buffer<Index> originals = {};   ///< by vertex: its number in the wrapped contour; equal ones are one point
};

/// Unrolls a wrapped contour: each simplex across the seam is moved to the end of the period, with copies of its
/// vertices at the start. Vertices keep their numbers, copies follow; a vertex of moved simplices only is moved itself.
/// Simplices keep their numbers. Normals and attributes are copied. A manifold stays one: on lattices and beside
/// missing values, where simplices that stay may only touch each other, these get copies of their common vertices, too.
/// A contour without periods is returned unchanged. Errors: InvalidArgument for a contour that is not sound; TooLarge.
/// O(V + S) time, for each round of copies.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Unrolled<N, Real> unroll(const Contour<N, Real>& contour);

}  // namespace tegl
