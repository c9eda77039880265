// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images of cells: makes the image of sides and chooses how its contour is made.
#include "tegl/cells.hpp"

#include <array>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "base/progress.hpp"
#include "cells/cubic_contour.hpp"
#include "cells/doubled_cells.hpp"
#include "tegl/error.hpp"
#include "tegl/facet_hierarchy.hpp"

namespace tegl {

std::vector<double> cell_faces(const Axis& axis) {
  const std::size_t n = axis.size();
  std::vector<double> faces(n + 1);
  if (axis.is_uniform() || n == 1) {
    const double step = axis.is_uniform() ? axis.step() : 1.0;
    for (std::size_t i = 0; i <= n; ++i) faces[i] = axis.origin() + (static_cast<double>(i) - 0.5) * step;
    return faces;
  }
  for (std::size_t i = 1; i < n; ++i) faces[i] = 0.5 * (axis[i - 1] + axis[i]);
  faces[0] = axis[0] - (faces[1] - axis[0]);
  faces[n] = axis[n - 1] + (axis[n - 1] - faces[n - 1]);
  return faces;
}

namespace {

void require_cell_options(double isovalue, const PositionOptions& positions, const ExtractOptions& options) {
  if (!std::isfinite(isovalue)) throw Error(ErrorCode::InvalidIsovalue, "the isovalue is not finite");
  if (positions.rule == Positions::filtered || positions.rule == Positions::custom)
    throw Error(ErrorCode::UnsupportedData,
                "positions by a second image or a function for an image of cells; expected linear, relaxed or "
                "gravitation");
  if (options.ambiguity != Ambiguity::low && options.ambiguity != Ambiguity::high)
    throw Error(ErrorCode::UnsupportedData, "ambiguities of cells resolved from the data; expected low or high");
  if (options.normals != Normals::none)
    throw Error(
        ErrorCode::UnsupportedData,
        "normals from the image for an image of cells; expected normals of the contour's shape, geometric or flat");
}

/// The faces of each axis. Throws unless those that are given enclose the samples.
template <int N>
std::array<std::vector<double>, N> faces_of(const Grid<N>& grid, const CellFaces& given) {
  std::array<std::vector<double>, N> faces;
  for (std::size_t a = 0; a < N; ++a) {
    const Axis& axis = grid.axes[a];
    if (a >= given.size() || given[a].empty()) {
      faces[a] = cell_faces(axis);
      continue;
    }
    faces[a] = given[a];
    if (faces[a].size() != axis.size() + 1)
      throw Error(ErrorCode::InvalidArgument, fmt::format("{} faces of {} cells along axis {}; expected {}",
                                                          faces[a].size(), axis.size(), a, axis.size() + 1));
    const bool ascends = faces[a].back() > faces[a].front();
    for (std::size_t i = 0; i < axis.size(); ++i) {
      const double low = faces[a][ascends ? i : i + 1], high = faces[a][ascends ? i + 1 : i];
      if (!(low < axis[i] && axis[i] < high))
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("the cell {} along axis {} has its centre at {} and its faces at {} and {}; expected "
                                "the centre between the faces",
                                i, a, axis[i], faces[a][i], faces[a][i + 1]));
    }
  }
  return faces;
}

/// 1 for high samples, 0 for low ones, and a layer of 0 around the image.
template <Value T, int N>
Values<std::uint8_t> padded_sides(const Image<T, N>& image, double isovalue, const Progress& progress) {
  std::size_t rows = 1, count = 1;
  for (int a = 0; a < N; ++a) {
    count *= image.size(a) + 2;
    if (a > 0) rows *= image.size(a);
  }
  Values<std::uint8_t> sides(count, std::uint8_t{0});
  std::array<std::size_t, N> index{};
  detail::in_parts(rows, progress, [&](std::size_t from, std::size_t to) {
    for (std::size_t row = from; row < to; ++row) {
      std::size_t at = 0, factor = 1;
      for (int a = 0; a < N; ++a) {
        at += (index[a] + 1) * factor;
        factor *= image.size(a) + 2;
      }
      for (index[0] = 0; index[0] < image.size(0); ++index[0])
        sides[at + index[0]] = static_cast<double>(image(index)) >= isovalue ? 1 : 0;  // NaN is low
      index[0] = 0;
      for (int a = 1; a < N && ++index[a] == image.size(a); ++a) index[a] = 0;
    }
  });
  return sides;
}

/// The axis with one more sample at each end, which mirrors the end in the outer face.
Axis padded_axis(const Axis& axis, const std::vector<double>& faces) {
  Axis result;
  const std::size_t n = axis.size();
  if (axis.is_uniform()) {
    result = Axis::uniform(n + 2, axis.origin() - axis.step(), axis.step());
  } else {
    std::vector<double> all = {2.0 * faces.front() - axis[0]};
    for (std::size_t i = 0; i < n; ++i) all.push_back(axis[i]);
    all.push_back(2.0 * faces.back() - axis[n - 1]);
    result = Axis::rectilinear(std::move(all));
  }
  result.name = axis.name;
  result.unit = axis.unit;
  return result;
}

/// Makes the contour from the sides.
template <class Real, int N>
Extraction<N, Real> contour_of_sides(const Grid<N>& grid, Values<std::uint8_t>&& values,
                                     const PositionOptions& positions, ExtractOptions options, const CellFaces& faces) {
  const Progress progress = options.work.progress;
  options.work.progress = detail::part_of(progress, 0.1, 0.7);
  detail::CellPlaces<N> places{{}, faces_of(grid, faces), grid.linear, grid.offset};
  OwnedImage<std::uint8_t, N> sides;
  sides.values = std::move(values);
  sides.grid.linear = grid.linear;
  sides.grid.offset = grid.offset;
  for (int a = 0; a < N; ++a) {
    for (std::size_t i = 0; i < grid.axes[a].size(); ++i) places.centres[a].push_back(grid.axes[a][i]);
    sides.grid.axes[a] = padded_axis(grid.axes[a], places.faces[a]);
  }
  if (positions.rule != Positions::linear)
    return extract_placed_with_stats<Real>(sides.view(), 0.5, positions, options);
  Extraction<N, Real> result;
  const auto facets = extract_facets<Real>(sides.view(), 0.5, options);
  if (detail::are_balls(facets)) {
    result.contour = detail::cubic_contour(facets, places, detail::part_of(progress, 0.7, 1.0));
  } else {
    options.work.progress = detail::part_of(progress, 0.7, 1.0);
    result.contour = detail::contour_of_doubled_cells<Real>(sides, places, options);
  }
  for (int a = 0; a < N; ++a) {
    result.contour.axis_names[a] = grid.axes[a].name;
    result.contour.axis_units[a] = grid.axes[a].unit;
  }
  result.contour.direction = options.direction;
  result.stats.tiles = 1;
  for (const std::size_t size : sides.grid.sizes()) result.stats.tiles *= size - 1;
  const auto& tops = facets.levels[N - 1].places;  // those of a tile follow each other
  for (std::size_t f = 0; f < tops.size(); ++f)
    if (f == 0 || tops[f].base != tops[f - 1].base) ++result.stats.active_tiles;
  return result;
}

}  // namespace

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> Extraction<N, Real> extract_cells_with_stats(const Image<T, N>& image,
                                                                                double isovalue,
                                                                                const PositionOptions& positions,
                                                                                const ExtractOptions& given,
                                                                                const CellFaces& faces) {
  require_cell_options(isovalue, positions, given);
  ExtractOptions options = given;
  options.close = false;
  const auto start = std::chrono::steady_clock::now();
  Values<std::uint8_t> sides = padded_sides(image, isovalue, detail::part_of(given.work.progress, 0.0, 0.1));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  Extraction<N, Real> result = contour_of_sides<Real, N>(image.grid(), std::move(sides), positions, options, faces);
  result.stats.classify_seconds += seconds.count();
  return result;
}

#define TEGL_INSTANTIATE_REALS(T, N, Real)                           \
  template Extraction<N, Real> extract_cells_with_stats<Real, T, N>( \
      const Image<T, N>&, double, const PositionOptions&, const ExtractOptions&, const CellFaces&);
#include "base/instantiate.hpp"

}  // namespace tegl
