// SPDX-License-Identifier: BSD-3-Clause
//
// Direct cut of an image without the whole contour: selects the layers to read. Included by the sources that
// instantiate it.
//
// Why these layers suffice: every simplex of a contour lies between two neighbouring layers, and the result of `slice`
// at a vertex or simplex depends only on the simplices that touch the hyperplane, through groups of vertices in it. So
// the slabs that the hyperplane touches give the same cut as the whole contour. Caps across the last axis are omitted:
// at the ends of the slabs they would be wrong, and at the ends of the image they lie in the hyperplane or beside it
// and are never cut.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "ambiguity/moved_estimator.hpp"
#include "base/slice_at.hpp"
#include "image/row_source.hpp"
#include "kernel/tableless.hpp"
#include "tegl/slice.hpp"

namespace tegl::detail {

/// Throws InvalidArgument unless the world map keeps the axis separate: its row and column are zero except for the
/// diagonal element.
template <int N>
void check_axis_is_apart(const Grid<N>& grid, int axis) {
  bool apart = grid.linear[axis][axis] != 0.0;
  for (int a = 0; a < N; ++a)
    apart = apart && (a == axis || (grid.linear[axis][a] == 0.0 && grid.linear[a][axis] == 0.0));
  if (!apart)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("direct cut of a grid whose world map mixes axis {} with others; expected a row {} and a "
                            "column {} that are zero but for their diagonal element",
                            axis, axis, axis));
}

/// World coordinate of sample i along a separate axis, computed as in the extraction.
template <int N, class Real>
Real world_coordinate(const Grid<N>& grid, int axis, std::size_t i) {
  const double x = grid.axes[axis][i];
  return static_cast<Real>(grid.has_world_map() ? grid.linear[axis][axis] * x + grid.offset[axis] : x);
}

/// The axis that the hyperplane is perpendicular to; -1 if it is oblique. The normal must be finite and not 0.
template <int N>
int axis_of_normal(const Hyperplane<N>& hyperplane) {
  int axis = -1;
  for (int a = 0; a < N; ++a) {
    if (hyperplane.normal[a] == 0.0) continue;
    if (axis >= 0) return -1;
    axis = a;
  }
  return axis;
}

/// The layers {first, count} of the slabs that meet `at`; for an axis with one sample, that layer.
template <int N, class Real>
std::pair<std::size_t, std::size_t> layers_around(const Grid<N>& grid, int axis, double at) {
  check_axis_is_apart(grid, axis);
  const Real rounded = rounded_at<Real>(at);
  const std::size_t size = grid.axes[axis].size();
  std::size_t first = size;
  std::size_t last = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const Real here = world_coordinate<N, Real>(grid, axis, i);
    const Real next = world_coordinate<N, Real>(grid, axis, std::min(i + 1, size - 1));
    if (rounded < std::min(here, next) || rounded > std::max(here, next)) continue;
    first = std::min(first, i);
    last = std::min(i + 1, size - 1);
  }
  if (first == size) {
    const auto& cut = grid.axes[axis];
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("cut at {}; expected a coordinate between {} and {}, the ends of axis {}{}", at,
                            world_coordinate<N, Real>(grid, axis, 0), world_coordinate<N, Real>(grid, axis, size - 1),
                            axis, cut.name.empty() ? "" : " (" + cut.name + ")"));
  }
  return {first, last - first + 1};
}

/// Adds the layers beside the slab, which gradients and custom estimators need if the cut is not across the last axis.
/// These layers are contoured too.
inline std::pair<std::size_t, std::size_t> with_neighbours(std::pair<std::size_t, std::size_t> layers, std::size_t size,
                                                           const ExtractOptions& options) {
  std::size_t beside = options.normals != Normals::none ? 1 : 0;
  if (options.ambiguity == Ambiguity::custom) beside = std::max(beside, std::min(options.estimator.reach, size));
  const std::size_t first = layers.first - std::min(layers.first, beside);
  return {first, std::min(size, layers.first + layers.second + beside) - first};
}

/// The image with one axis moved to the end; the others keep their order.
template <Value T, int N>
Image<T, N> with_axis_last(const Image<T, N>& image, int axis) {
  const Grid<N>& from = image.grid();
  Grid<N> grid;
  typename Image<T, N>::Strides strides;
  const auto old = [&](int a) { return a == N - 1 ? axis : a + (a >= axis); };
  for (int a = 0; a < N; ++a) {
    grid.axes[a] = from.axes[old(a)];
    strides[a] = image.strides()[old(a)];
    grid.offset[a] = from.offset[old(a)];
    for (int b = 0; b < N; ++b) grid.linear[a][b] = from.linear[old(a)][old(b)];
  }
  return Image<T, N>(image.data(), std::move(grid), strides);
}

/// Whether one of the layers {first, count} along an axis lies at `at`.
template <int N, class Real>
bool is_at_layer(const Grid<N>& grid, int axis, double at, std::pair<std::size_t, std::size_t> layers) {
  for (std::size_t i = layers.first; i < layers.first + layers.second; ++i)
    if (world_coordinate<N, Real>(grid, axis, i) == rounded_at<Real>(at)) return true;
  return false;
}

/// The cut across an axis, from the layers that it needs.
template <class Real, Value T, int N>
Extraction<N - 1, Real> slice_layers(const Image<T, N>& image, double isovalue, const Hyperplane<N>& hyperplane,
                                     int axis, const ExtractOptions& options) {
  constexpr double kMost = std::numeric_limits<double>::max();
  const double at = std::clamp(hyperplane.offset / hyperplane.normal[axis], -kMost, kMost);
  auto layers = layers_around<N, Real>(image.grid(), axis, at);
  const bool is_last = axis == N - 1;
  // The extraction keeps points between layers off the layers along the last axis only.
  const bool at_layer = is_at_layer<N, Real>(image.grid(), axis, at, layers);
  if (!is_last && at_layer) {
    ExtractOptions moved = options;
    if (options.ambiguity == Ambiguity::custom) moved.estimator = moved_estimator<N>(options.estimator, axis);
    return slice_layers<Real>(with_axis_last(image, axis), isovalue, Hyperplane<N>::across(N - 1, at), N - 1, moved);
  }
  if (!is_last) layers = with_neighbours(layers, image.size(axis), options);
  const Image<T, N> slab = image.part(axis, layers.first, layers.second);
  // Along the last axis a source can begin inside the image and reads the layers before and behind.
  ImageSource<T, N> source(is_last ? image : slab, isovalue, options.epsilon, is_last ? layers.first : 0);
  ExtractPlan plan{.closed_axes = ((1u << N) - 1) & ~(1u << axis)};
  plan.keeps_off_layers = at_layer;
  if (!is_last) plan.part = {axis, layers.first};
  const auto extracted = extract_in_memory<N, Real>(source, slab.grid(), options, plan);
  // At a layer, the limit from below is the layer's contour, whichever way the normal points.
  return {slice(extracted.contour, at_layer ? Hyperplane<N>::across(axis, at) : hyperplane), extracted.stats};
}

}  // namespace tegl::detail

namespace tegl {

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 3, 4> Extraction<N - 1, Real> slice_image_with_stats(
    const Image<T, N>& image, double isovalue, const std::type_identity_t<Hyperplane<N>>& hyperplane,
    const ExtractOptions& options) {
  detail::check_arguments(isovalue, options);
  (void)frame_of(hyperplane);  // throws before the work if the hyperplane is none
  const int axis = detail::axis_of_normal(hyperplane);
  if (axis >= 0) return detail::slice_layers<Real>(image, isovalue, hyperplane, axis, options);
  auto whole = extract_with_stats<Real>(image, isovalue, options);
  return {slice(whole.contour, hyperplane), whole.stats};
}

}  // namespace tegl

#define TEGL_INSTANTIATE_SLICE(T, N, Real)                                         \
  template tegl::Extraction<N - 1, Real> tegl::slice_image_with_stats<Real, T, N>( \
      const Image<T, N>&, double, const Hyperplane<N>&, const ExtractOptions&);
#define TEGL_INSTANTIATE_SLICE_IMAGE(T) \
  TEGL_INSTANTIATE_SLICE(T, 3, float)   \
  TEGL_INSTANTIATE_SLICE(T, 3, double)  \
  TEGL_INSTANTIATE_SLICE(T, 4, float)   \
  TEGL_INSTANTIATE_SLICE(T, 4, double)
