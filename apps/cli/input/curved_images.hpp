// SPDX-License-Identifier: BSD-3-Clause
//
// Images on curved grids with their indices as coordinates: contours are made there, and moved to space afterwards.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "tegl/curved.hpp"
#include "tegl/image.hpp"

namespace tegl::cli {

/// A view of an image with indices in place of the coordinates along curved axes (index_grid).
template <Value T, int N>
Image<T, N> on_indices(const OwnedImage<T, N>& owned, std::span<const CurvedAxis> curved) {
  const Image<T, N> view = owned.view();
  return {view.data(), index_grid<N>(owned.grid, curved), view.strides()};
}

/// The place on index_grid of the sample nearest to a point in space. Distances along the axes are in parts of the
/// range of the coordinate. Samples with unknown coordinates do not count. O(samples) time.
template <int N>
std::array<double, N> nearest_sample(const Grid<N>& grid, std::span<const CurvedAxis> curved,
                                     const std::array<double, N>& point) {
  std::array<const CurvedAxis*, N> curved_at{};
  for (const CurvedAxis& one : curved) curved_at[static_cast<std::size_t>(one.axis)] = &one;
  std::array<std::size_t, N> index{}, nearest{};
  const auto coordinate = [&](std::size_t axis) {
    const CurvedAxis* const one = curved_at[axis];
    if (one == nullptr) return grid.axes[axis][index[axis]];
    std::size_t at = 0;
    for (std::size_t a = N; a-- > 0;)
      if ((one->along >> a & 1u) != 0) at = at * grid.axes[a].size() + index[a];
    return (*one)[at];
  };
  std::array<double, N> scale;
  for (std::size_t a = 0; a < N; ++a) {
    const Axis& axis = grid.axes[a];
    double low = axis[0], high = axis[axis.size() - 1];
    if (curved_at[a] != nullptr) low = high = std::numeric_limits<double>::quiet_NaN();
    if (curved_at[a] != nullptr)
      for (std::size_t i = 0; i < curved_at[a]->size(); ++i)
        if (const double x = (*curved_at[a])[i]; std::isfinite(x)) low = std::fmin(low, x), high = std::fmax(high, x);
    scale[a] = high != low ? 1.0 / (high - low) : 1.0;
  }
  double least = std::numeric_limits<double>::infinity();
  for (bool more = true; more;) {
    double distance = 0;
    for (std::size_t a = 0; a < N; ++a) distance += std::pow(scale[a] * (coordinate(a) - point[a]), 2);
    if (distance < least) least = distance, nearest = index;  // false for NaN
    more = false;
    for (std::size_t a = 0; a < N && !more; ++a) {
      more = ++index[a] < grid.axes[a].size();
      if (!more) index[a] = 0;
    }
  }
  const Grid<N> indices = index_grid<N>(grid, curved);
  std::array<double, N> place;
  for (std::size_t a = 0; a < N; ++a) place[a] = indices.axes[a][nearest[a]];
  return place;
}

}  // namespace tegl::cli
