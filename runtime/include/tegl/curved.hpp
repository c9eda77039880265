// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images on curved grids: samples with coordinates of their own, such as ocean models with longitude and
// latitude in arrays of two dimensions.
//
// The contour is made on the grid of the indices, and each vertex then gets a place between the samples' coordinates.
// So the topology is the same as on straight axes, with what is proved about it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"
#include "tegl/periodic.hpp"

namespace tegl {

/// Stores coordinates sample by sample (CurvedPoints): those that differ along the same axes together. Contours on the
/// grid are the same, and take less time: with three coordinates in 3D arrays, up to 1.3 times the time of the plain
/// contour in place of 1.7 times (docs/cost.md). One contour gains less time than this takes, so it is for several
/// contours on a grid, or to save memory: 16 bytes per sample for three coordinates that float represents. Coordinates
/// that are side by side already need no copy: CurvedPoints::in_place. The `values` of the results are empty; until
/// this returns, the coordinates are twice in memory. `threads`: 0 for all of the machine. O(coordinates) time.
[[nodiscard]] std::vector<CurvedAxis> by_points(std::vector<CurvedAxis> curved, unsigned threads = 0);
/// As above, for coordinates in memory of the caller: arrays[k] has those of curved[k], sizes[k] many. The `values` of
/// `curved` are not used. Errors: InvalidArgument for other numbers of arrays or sizes.
[[nodiscard]] std::vector<CurvedAxis> by_points(std::vector<CurvedAxis> curved, std::span<const CoordinateArray> arrays,
                                                std::span<const std::size_t> sizes, unsigned threads = 0);

/// Continues longitudes in degrees across 180, in place: each differs from a known neighbour by 180 at most, by
/// multiples of 360. `sizes`: of the grid, fastest axis first. NaN and numbers beyond -720 to 720 are unknown, and
/// remain. The first known one remains, too. The longitude of a row's sample follows that of its predecessor; the first
/// sample of a row, or the first behind unknown ones, follows its neighbour in another row. Parts of the grid without
/// neighbours in common follow the nearest sample of another part, by steps on the grid. For CurvedAxis::values, as
/// files are read. Errors: InvalidArgument for another number of longitudes than the sizes'. O(longitudes) time; if
/// there are such parts, more time and 30 bytes per longitude.
void continue_longitudes(std::span<double> longitudes, std::span<const std::size_t> sizes);

/// A periodic axis of a curved grid: cells across the seam connect the last samples along it to the first ones.
template <int N>
struct CurvedSeam {
  int axis = 0;           ///< of the image
  Vector<N> vector = {};  ///< from the places of the first samples to where they follow the last ones; 0: the same
                          ///< places, as in O-grids around a body. Along an axis that is not curved: its period.
};
/// Seams of a curved grid, which are not deduced.
template <int N>
using CurvedSeams = std::type_identity_t<std::span<const CurvedSeam<N>>>;

/// The periods of `axes` that are given without a number: 360 for those with a unit of longitudes, whether even or not,
/// and those of `sample_periods` for others. Errors: as `sample_periods`; InvalidArgument for longitudes that span 360
/// degrees or more, as if the first sample is repeated at the end (`without_repeated`), for longitudes with a gap of
/// 180 degrees or more, also between the last sample and the first one, and for longitudes that the world map mixes
/// with other axes. A world map that scales them is taken into account: the period is then 360 in the world.
template <int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] AxisPeriods<N> default_periods(const Grid<N>& grid, std::span<const int> axes);

/// The seams of these axes. Vectors are 360 for coordinates with a unit of degrees_east (or another as in
/// `longitude_periods`) that grow by 180 degrees or more along the axis, in the mean of all rows, and the periods of
/// `default_periods` for axes that are not curved; otherwise 0. `periods`, if any, has a number for each of the axes:
/// the length of the seam along the axis's own coordinate, or along longitudes whose name stands for the axis
/// (`axis_of_longitudes`), in the direction in which that grows, or NaN for the vector above. Errors: InvalidGrid (as
/// `extract_curved`, and an axis that the grid does not have); InvalidArgument (as `default_periods`; another number of
/// periods; one not positive and finite, or not more than twice the mean step across the seam, as in another unit;
/// coordinates that grow by the period or more, in the mean of all rows or in most of them; without a given period,
/// longitudes of a region: the way back to the places of the first samples is more than twice as long as the longest
/// step along the axis, in the mean of all rows, and longitudes do not run around the globe along another axis: in half
/// of the rows, their ends are at most 1.5 of the longest steps apart).
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] std::vector<CurvedSeam<N>> find_seams(const Grid<N>& grid, std::span<const CurvedAxis> curved,
                                                    std::span<const int> axes, std::span<const double> periods = {});

/// The number of samples at the end of an axis that repeat the first ones a full turn further, as in global ocean
/// grids: longitudes (by the unit, of the axis or of curved coordinates) 360 degrees from those of the first samples,
/// to a thousandth of a step, and other curved coordinates equal to theirs, to 2^-22 of the largest; unknown where
/// theirs are. Rows of curved longitudes may also return to their first ones, as where a tripolar grid is folded,
/// except one at least. 0 if there are none, or fewer than three others. `period`: a given one, in the axis's unit; if
/// it is not 360 degrees in the world, to 1e-9 of it, also 0. Values are not compared. Errors: InvalidGrid (as
/// `extract_curved`; in 5D any curved axis; an axis that the grid does not have). O(coordinates) time.
template <int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::size_t repeated_longitudes(const Grid<N>& grid, std::span<const CurvedAxis> curved, int axis,
                                              double period = std::numeric_limits<double>::quiet_NaN());

/// An image, on a curved grid or not, of which samples at the ends of axes are left out.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
struct WithoutRepeated {
  Image<T, N> image;                         ///< a view of the other samples
  std::vector<CurvedAxis> curved = {};       ///< with the coordinates of these samples
  std::array<std::size_t, N> left_out = {};  ///< number of samples, by axis
};

/// Leaves out the samples that `repeated_longitudes` counts along these axes, so that the axes can be periodic.
/// `periods`, if any, has a number for each of the axes: a given period in the axis's unit, or NaN. Values are not
/// copied, coordinates are. Errors: as `repeated_longitudes`; InvalidArgument for samples with other values than those
/// that they repeat, of which it names the first in memory (missing equals missing; floating-point values may differ by
/// 1e-12 of the largest one among these samples, float by 1e-6, as values of a formula do). O(coordinates) time.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] WithoutRepeated<T, N> without_repeated(const Image<T, N>& image, std::span<const CurvedAxis> curved,
                                                     std::span<const int> axes, std::span<const double> periods = {});

/// The axes that run once around the globe: longitudes of `longitude_periods`, and axes along which curved longitudes
/// (the same units) grow by 360 degrees from the first sample to one step behind the last one, in each row to half a
/// step. `find_seams` makes their seams. Errors: InvalidGrid (as `extract_curved`; in 5D any curved axis). O(samples /
/// samples along the axis) time.
template <int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::vector<int> longitude_axes(const Grid<N>& grid, std::span<const CurvedAxis> curved = {});
/// As above, without the samples at the end that repeat the first ones, if their values are equal (`without_repeated`).
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::vector<int> longitude_axes(const Image<T, N>& image, std::span<const CurvedAxis> curved = {});

/// The axis that a name of curved longitudes stands for: the one along which they run around the globe (as above, also
/// with samples that repeat the first ones); else, for longitudes of a region, the one along which they grow most, if
/// by more than twice what they grow along their own; else their own. In files with another order of dimensions, that
/// is the axis of another coordinate. Of coordinates with another unit: their own. Errors: InvalidGrid (as
/// `extract_curved`). O(coordinates) time.
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] int axis_of_longitudes(const Grid<N>& grid, const CurvedAxis& longitudes);

/// The periods on index_grid(grid, curved) of the seams: for `extract_periodic` there. Errors: InvalidGrid (as
/// `extract_curved`).
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] AxisPeriods<N> index_periods(const Grid<N>& grid, std::span<const CurvedAxis> curved,
                                           const CurvedSeams<N>& seams);

/// Cells of a curved grid that are not mapped to space one to one: at a corner, the edges have another orientation than
/// in most cells, or none.
template <int N>
struct GridFolds {
  std::uint64_t cells = 0;                            ///< number of such cells
  std::array<std::size_t, N> first = {};              ///< index of the first one, if there is one
  bool operator==(const GridFolds&) const = default;  ///< equal if both are
};

/// Finds the cells in which the grid is folded. The grid's own coordinates along curved axes are not used. Cells with
/// unknown coordinates do not count. Cells across seams have the index of the last sample. Errors: InvalidGrid (as
/// `extract_curved`). O(cells) time.
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] GridFolds<N> find_folds(const Grid<N>& grid, std::span<const CurvedAxis> curved,
                                      const WorkOptions& work = {}, const CurvedSeams<N>& seams = {});

/// The grid on which `on_curved_grid` expects a contour: along curved axes, indices (negative ones along one axis, if
/// the curved grid has the other orientation); along others, the grid's own coordinates. Errors: InvalidGrid (as
/// `extract_curved`).
template <int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Grid<N> index_grid(const Grid<N>& grid, std::span<const CurvedAxis> curved);

/// Moves a contour from index_grid(grid, curved) to the curved grid: vertices by multilinear interpolation of the
/// samples' coordinates, normals by the Jacobian (central differences, interpolated). Attributes remain,
/// and moved contours are not copied. With seams, the contour must be the one of `extract_periodic` on `index_grid`
/// with `index_periods`. Errors: InvalidGrid (as `extract_curved`); UnsupportedData for a vertex between samples of
/// unknown coordinates, and for a contour with periods and no seams; InvalidArgument for one with seams and other
/// periods. O(V) time.
template <Coordinate Real, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Contour<N, Real> on_curved_grid(Contour<N, Real> contour, const Grid<N>& grid,
                                              std::span<const CurvedAxis> curved, const WorkOptions& work = {},
                                              const CurvedSeams<N>& seams = {});

/// As `extract_curved`, with counts and times; these do not include the time to move the vertices.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Extraction<N, Real> extract_curved_with_stats(const Image<T, N>& image,
                                                            std::span<const CurvedAxis> curved, double isovalue,
                                                            const ExtractOptions& options = {},
                                                            const CurvedSeams<N>& seams = {}) {
  ExtractOptions of_indices = options;
  if (options.work.progress) of_indices.work.progress = [&](double done) { return options.work.progress(0.9 * done); };
  WorkOptions moving = options.work;
  if (options.work.progress) moving.progress = [&](double done) { return options.work.progress(0.9 + 0.1 * done); };
  const Image<T, N> indexed(image.data(), index_grid<N>(image.grid(), curved), image.strides());
  Extraction<N, Real> made = seams.empty()
                                 ? extract_with_stats<Real>(indexed, isovalue, of_indices)
                                 : extract_periodic_with_stats<Real>(
                                       indexed, index_periods<N>(image.grid(), curved, seams), isovalue, of_indices);
  return {on_curved_grid<Real>(std::move(made.contour), image.grid(), curved, moving, seams), made.stats};
}

/// Extracts the contour of an image whose samples have coordinates of their own. Simplices, with their vertex numbers,
/// equal the ones of `extract` on the indices, reversed if the grid has the other orientation; so the contour faces the
/// side of ExtractOptions::direction in space. The image's grid gives the sizes, the coordinates of axes that are not
/// curved, and names and units.
///
/// `seams`: periodic axes. The contour continues across them, as by `extract_periodic` on the indices. If the places of
/// a seam's first samples are the same behind its last ones, the contour is closed there in space; otherwise it is
/// wrapped (Contour::periods), so that `unroll` makes it one for pictures. Cells must be shorter than half a period.
///
/// A contour on a grid without folds (`find_folds`) is embedded if the cells of the grid are; with folds, parts
/// overlap.
///
/// Errors: as `extract`; InvalidGrid for a curved axis that the image does not have or has twice, an `along` without it
/// or with an axis that the image does not have, another number of values, and a grid with a world
/// map; UnsupportedData where the contour needs an unknown coordinate: make the image's values there NaN. Time: as
/// `extract`, and O(V). Precision: places between samples are rounded to Real as indices.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Contour<N, Real> extract_curved(const Image<T, N>& image, std::span<const CurvedAxis> curved,
                                              double isovalue, const ExtractOptions& options = {},
                                              const CurvedSeams<N>& seams = {}) {
  return extract_curved_with_stats<Real>(image, curved, isovalue, options, seams).contour;
}

}  // namespace tegl
