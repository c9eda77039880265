// SPDX-License-Identifier: BSD-3-Clause
//
// Selects the layers of an image that a cut across an axis needs.
#pragma once

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "base/slice_at.hpp"
#include "tegl/slice.hpp"

namespace tegl::detail {

/// World coordinate of sample i along a separate axis, computed as in the extraction.
template <int N, class Real>
Real world_coordinate(const Grid<N>& grid, int axis, std::size_t i) {
  const double x = grid.axes[axis][i];
  return static_cast<Real>(grid.has_world_map() ? grid.linear[axis][axis] * x + grid.offset[axis] : x);
}

/// The layers of the slabs that meet `at`; for an axis with one sample, that layer. Throws InvalidArgument if `at` is
/// outside of the image, or if the world map mixes the axis with others.
template <int N, class Real>
LayerRange layers_around(const Grid<N>& grid, int axis, double at) {
  if (!grid.is_separate(axis))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("direct slice of a grid whose world map mixes axis {} with others; expected a row {} and a "
                            "column {} of zeros, except on the diagonal",
                            axis, axis, axis));
  const Real rounded = rounded_at<Real>(at);
  const std::size_t size = grid.axes[axis].size();
  LayerRange layers{size, 0};
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t after = std::min(i + 1, size - 1);
    const Real here = world_coordinate<N, Real>(grid, axis, i);
    const Real next = world_coordinate<N, Real>(grid, axis, after);
    if (rounded < std::min(here, next) || rounded > std::max(here, next)) continue;
    layers = {std::min(layers.first, i), after + 1};
  }
  if (layers.first == size) {
    const auto& cut = grid.axes[axis];
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("slice at {}; expected a coordinate between {} and {}, the ends of axis {}{}", at,
                            world_coordinate<N, Real>(grid, axis, 0), world_coordinate<N, Real>(grid, axis, size - 1),
                            axis, cut.name.empty() ? "" : " (" + cut.name + ")"));
  }
  return layers;
}

/// Adds the layers beside the slabs that gradients and custom estimators need.
inline LayerRange with_neighbours(LayerRange layers, std::size_t size, const ExtractOptions& options) {
  std::size_t beside = options.normals != Normals::none ? 1 : 0;
  if (options.ambiguity == Ambiguity::custom) beside = std::max(beside, std::min(options.estimator.reach, size));
  return {layers.first - std::min(layers.first, beside), std::min(size, layers.end + beside)};
}

/// The layer along an axis that lies at `at`; layers.end if none does.
template <int N, class Real>
std::size_t layer_at(const Grid<N>& grid, int axis, double at, LayerRange layers) {
  std::size_t i = layers.first;
  while (i < layers.end && world_coordinate<N, Real>(grid, axis, i) != rounded_at<Real>(at)) ++i;
  return i;
}
template <int N, class Real>
bool is_at_layer(const Grid<N>& grid, int axis, double at, LayerRange layers) {
  return layer_at<N, Real>(grid, axis, at, layers) != layers.end;
}

}  // namespace tegl::detail
