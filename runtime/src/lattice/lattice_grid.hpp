// SPDX-License-Identifier: BSD-3-Clause
//
// Grids of samples on staggered lattices: checks, and places of samples.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

#include "complex/image_points.hpp"
#include "periodic/periods.hpp"
#include "tegl/error.hpp"
#include "tegl/lattice.hpp"

namespace tegl::detail {

/// The axis of the layers, of which the odd ones are shifted.
[[nodiscard]] inline int layer_axis(Lattice lattice) noexcept {
  return dimension(lattice) - (lattice == Lattice::fcc_in_time ? 2 : 1);
}

/// Throws InvalidArgument for a lattice of other dimensions.
inline void check_dimension(Lattice lattice, int dim) {
  if (dimension(lattice) != dim)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("lattice {} of a {}D image; expected {} dimensions{}", name_of(lattice), dim, dimension(lattice),
                    lattice == Lattice::fcc && dim == 4 ? ", or the lattice fcc_in_time for fcc over time" : ""));
}

/// Throws unless the axes before `layers` have equal steps, so that half a step is defined, and there are samples
/// enough for cells that have facets in common: in a row of one sample, tetrahedra of bcc would have edges in common
/// only.
template <int N>
void check_grid(const Grid<N>& grid, Lattice lattice, int layers) {
  for (int a = 0; a < layers; ++a) {
    const Axis& axis = grid.axes[a];
    const double step = axis.step();
    for (std::size_t i = 1; i < axis.size(); ++i)
      if (std::abs(axis[i] - axis[i - 1] - step) > 1e-6 * std::abs(step))
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("lattice {}: {} has a step of {}; expected {}, that of all others", name_of(lattice),
                                label_of_axis(axis, a), axis[i] - axis[i - 1], step));
    if (lattice == Lattice::bcc && axis.size() < 2)
      throw Error(ErrorCode::InvalidArgument, fmt::format("lattice bcc: {} has {} sample; expected at least 2",
                                                          label_of_axis(axis, a), axis.size()));
  }
  const std::size_t count = grid.axes[layers].size();
  if (count < least_layers(lattice))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("lattice {}: {} layer{}; expected at least {}", name_of(lattice), count,
                            count == 1 ? "" : "s", least_layers(lattice)));
}

/// The place of a sample in the world; the odd layers of axis `layers` are shifted along the axes before it.
template <int N>
std::array<double, N> lattice_place(const Grid<N>& grid, const std::array<std::size_t, N>& index, int layers) {
  std::array<double, N> x;
  for (int a = 0; a < N; ++a) x[a] = grid.axes[a][index[a]];
  const bool is_odd = index[static_cast<std::size_t>(layers)] % 2 == 1;
  for (int a = 0; a < N; ++a)
    if (is_odd && a < layers) x[a] += 0.5 * grid.axes[a].step();
  return place_in_world<N>(grid, x);
}

/// The places of all samples.
template <int N>
std::vector<std::array<double, N>> points_of(const Grid<N>& grid, int layers) {
  std::vector<std::array<double, N>> points;
  points.reserve(count_samples(grid, "a lattice"));
  for_each_sample<N>(grid.sizes(), [&](const auto& index) { points.push_back(lattice_place<N>(grid, index, layers)); });
  return points;
}

template <int N>
std::array<std::size_t, 4> four_sizes(const Grid<N>& grid) {
  std::array<std::size_t, 4> sizes{1, 1, 1, 1};
  for (int a = 0; a < N; ++a) sizes[a] = grid.axes[a].size();
  return sizes;
}

}  // namespace tegl::detail
