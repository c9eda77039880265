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
#include <limits>
#include <utility>

#include "ambiguity/moved_estimator.hpp"
#include "extract/layers_of_cut.hpp"
#include "extract/uncertainty.hpp"
#include "image/row_source.hpp"
#include "kernel/extract_in_memory.hpp"
#include "tegl/slice.hpp"

namespace tegl::detail {

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

/// Layer k across an axis, as an image of the other axes in their order. The world map must not mix it with them.
template <Value T, int N>
Image<T, N - 1> layer_across(const Image<T, N>& image, int axis, std::size_t k) {
  const Grid<N>& from = image.grid();
  Grid<N - 1> grid;
  typename Image<T, N - 1>::Strides strides;
  const auto old = [&](int a) { return a + (a >= axis); };
  for (int a = 0; a < N - 1; ++a) {
    grid.axes[a] = from.axes[old(a)];
    strides[a] = image.strides()[old(a)];
    grid.offset[a] = from.offset[old(a)];
    for (int b = 0; b < N - 1; ++b) grid.linear[a][b] = from.linear[old(a)][old(b)];
  }
  return Image<T, N - 1>(image.data() + static_cast<std::ptrdiff_t>(k) * image.strides()[axis], std::move(grid),
                         strides);
}

/// The options for an image whose axis `axis` has been moved to the end.
template <int N>
ExtractOptions with_axis_last(const ExtractOptions& options, int axis) {
  ExtractOptions moved = options;
  if (options.ambiguity == Ambiguity::custom) moved.estimator = moved_estimator<N>(options.estimator, axis);
  return moved;
}

/// The cut across an axis, from the layers that it needs.
template <class Real, Value T, int N>
Extraction<N - 1, Real> slice_layers(const Image<T, N>& image, double isovalue, const Hyperplane<N>& hyperplane,
                                     int axis, const ExtractOptions& options) {
  constexpr double kMost = std::numeric_limits<double>::max();
  const double at = std::clamp(hyperplane.offset / hyperplane.normal[axis], -kMost, kMost);
  LayerRange layers = layers_around<N, Real>(image.grid(), axis, at);
  const bool is_last = axis == N - 1;
  // The extraction keeps points between layers off the layers along the last axis only.
  const bool at_layer = is_at_layer<N, Real>(image.grid(), axis, at, layers);
  if (!is_last && at_layer)
    return slice_layers<Real>(with_axis_last(image, axis), isovalue, Hyperplane<N>::across(N - 1, at), N - 1,
                              with_axis_last<N>(options, axis));
  if (!is_last) layers = with_neighbours(layers, image.size(axis), options);
  const Image<T, N> slab = image.part(axis, layers.first, layers.end - layers.first);
  // Along the last axis a source can begin inside the image and reads the layers before and behind.
  ImageSource<T, N> source(is_last ? image : slab, isovalue, options.epsilon, is_last ? layers.first : 0);
  ExtractPlan plan{.closed_axes = ((1u << N) - 1) & ~(1u << axis)};
  plan.keeps_off_layers = at_layer;
  if (!is_last) plan.part = {axis, layers.first};
  const auto extracted = extract_with_uncertainty<N, Real>(source, slab.grid(), image, options, plan);
  // At a layer, the limit from below is the layer's contour, whichever way the normal points.
  return {slice(extracted.contour, at_layer ? Hyperplane<N>::across(axis, at) : hyperplane), extracted.stats};
}

/// The cut of a 5D image across an axis. What is extracted in a slab is in the hyperplane, or beside it, what it is in
/// the whole contour, caps included. At a layer it is the layer's own contour, which 5D cells fill in another way. With
/// options that read 5D faces or neighbours across the layer, it is cut there, too, and across another axis than the
/// last the axes are exchanged: points between layers are kept off the layers along the last axis only.
template <class Real, Value T, int N>
Extraction<N - 1, Real> slice_slabs(const Image<T, N>& image, double isovalue, const Hyperplane<N>& hyperplane,
                                    int axis, const ExtractOptions& options) {
  constexpr double kMost = std::numeric_limits<double>::max();
  const double at = std::clamp(hyperplane.offset / hyperplane.normal[axis], -kMost, kMost);
  const LayerRange slabs = layers_around<N, Real>(image.grid(), axis, at);
  const std::size_t layer = layer_at<N, Real>(image.grid(), axis, at, slabs);
  const bool reads_across = options.ambiguity == Ambiguity::custom || options.normals == Normals::kernel ||
                            options.normals == Normals::context;
  if (layer != slabs.end && !reads_across && image.size(axis) > 1)
    return extract_with_stats<Real>(layer_across(image, axis, layer), isovalue, options);
  if (axis != N - 1 && layer != slabs.end)
    return slice_slabs<Real>(with_axis_last(image, axis), isovalue, Hyperplane<N>::across(N - 1, at), N - 1,
                             with_axis_last<N>(options, axis));
  const LayerRange layers = with_neighbours(slabs, image.size(axis), options);
  const auto part =
      extract_with_stats<Real>(image.part(axis, layers.first, layers.end - layers.first), isovalue, options);
  return {slice(part.contour, hyperplane), part.stats};
}

}  // namespace tegl::detail

namespace tegl {

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 3, 5> Extraction<N - 1, Real> slice_image_with_stats(
    const Image<T, N>& image, double isovalue, const std::type_identity_t<Hyperplane<N>>& hyperplane,
    const ExtractOptions& options) {
  detail::check_arguments(isovalue, options);
  (void)frame_of(hyperplane);  // throws before the work if the hyperplane is none
  const int axis = detail::axis_of_normal(hyperplane);
  if constexpr (N == 5)
    if (axis >= 0) return detail::slice_slabs<Real>(image, isovalue, hyperplane, axis, options);
  if constexpr (N < 5)
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
  TEGL_INSTANTIATE_SLICE(T, 4, double)  \
  TEGL_INSTANTIATE_SLICE(T, 5, float)   \
  TEGL_INSTANTIATE_SLICE(T, 5, double)
