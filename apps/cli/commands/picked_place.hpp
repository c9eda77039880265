// SPDX-License-Identifier: BSD-3-Clause
//
// The point of --pick, and the report on the component that was found there; on lattices, its choice.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "output/result.hpp"
#include "tegl/components.hpp"
#include "tegl/error.hpp"
#include "tegl/lattice.hpp"
#include "tegl/pick.hpp"

namespace tegl::cli {

/// The point in N dimensions. `text`: value of --pick, for errors.
template <int N>
[[nodiscard]] std::array<double, N> picked_place(const Picked& picked, const std::string& text) {
  if (picked.point.size() != N)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("--pick {} has {} numbers; expected {}, one for each axis", text, picked.point.size(), N));
  std::array<double, N> point;
  std::copy_n(picked.point.begin(), N, point.begin());
  return point;
}

template <int N>
void take_report(const PickReport<N>& report, Picked& picked) {
  picked.components = report.components;
  if (!report.found) return;  // an empty contour, or one of caps only
  picked.tile.assign(report.at.begin(), report.at.end());
  picked.distance = report.distance;
  picked.tiles = report.tiles;
}

/// Units of distances along the axes of a lattice: the step, along the layers' axis the step of the cubic grid that the
/// lattice with all its symmetries would have. 1 if the grid has a world map, as distances are then in the world.
template <int N>
[[nodiscard]] std::array<double, N> steps_on_lattice(const Grid<N>& grid, Lattice lattice) {
  std::array<double, N> steps;
  steps.fill(1.0);
  if (grid.has_world_map()) return steps;
  for (int a = 0; a < N; ++a) steps[a] = std::abs(grid.axes[a].step());
  steps[lattice == Lattice::fcc_in_time ? N - 2 : N - 1] /= layer_step(lattice);
  return steps;
}

/// Throws InvalidArgument unless a point is in the box of the image's samples, which has no ends along periods. On
/// lattices, odd layers reach half a step further along the axes before the layers'.
template <int N>
void require_in_box(const Grid<N>& grid, Lattice lattice, const std::vector<Period<N>>& periods,
                    const std::array<double, N>& point) {
  const int layers = lattice == Lattice::fcc_in_time ? N - 2 : N - 1;
  std::array<double, N> lowest, highest;
  lowest.fill(std::numeric_limits<double>::infinity());
  highest.fill(-std::numeric_limits<double>::infinity());
  for (unsigned corner = 0; corner < 1U << N; ++corner) {
    std::array<double, N> x = grid.offset;
    for (int a = 0; a < N; ++a) {
      const Axis& axis = grid.axes[a];
      const double beyond = a < layers ? 0.5 * axis.step() : 0.0;
      const double at = (corner >> a & 1U) == 0 ? axis[0] : axis[axis.size() - 1] + beyond;
      for (int row = 0; row < N; ++row) x[row] += grid.linear[row][a] * at;
    }
    for (int row = 0; row < N; ++row) {
      lowest[row] = std::min(lowest[row], x[row]);
      highest[row] = std::max(highest[row], x[row]);
    }
  }
  for (const Period<N>& period : periods)
    for (int a = 0; a < N; ++a)
      if (period.vector[a] != 0.0) {
        lowest[a] = -std::numeric_limits<double>::infinity();
        highest[a] = std::numeric_limits<double>::infinity();
      }
  for (int a = 0; a < N; ++a)
    if (point[a] < lowest[a] || point[a] > highest[a])
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("the point ({}) is not in the image; expected one from ({:.6g}) to ({:.6g})",
                              fmt::join(point, ", "), fmt::join(lowest, ", "), fmt::join(highest, ", ")));
}

/// The component of the contour of an image on a lattice that is nearest to the point of --pick, with the report on it.
/// Points are modulo the periods of a wrapped contour. Throws InvalidArgument for points outside of the image along
/// other axes.
template <int N, class Real>
[[nodiscard]] Contour<N, Real> pick_on_lattice(const Contour<N, Real>& contour, const Grid<N>& grid, Lattice lattice,
                                               const std::array<double, N>& point, Picked& picked, unsigned threads) {
  require_in_box<N>(grid, lattice, contour.periods, point);
  const ComponentLabels labels = label_components(contour, {threads});
  const NearestComponent nearest =
      nearest_component(contour, labels, point, steps_on_lattice<N>(grid, lattice), {threads});
  std::vector<bool> keep(labels.count);
  if (nearest.label != kNoComponent) keep[nearest.label] = true;
  picked.components = labels.count;
  picked.is_in_world = grid.has_world_map();
  if (nearest.label != kNoComponent) picked.distance = nearest.distance;
  return select_components(contour, labels, keep, {threads});
}

}  // namespace tegl::cli
