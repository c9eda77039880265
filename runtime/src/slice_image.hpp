// SPDX-License-Identifier: BSD-3-Clause
//
// The cut straight from an image: which layers to read, and why they suffice. Included by the sources that instantiate
// it.
//
// Every simplex of a contour lies between two neighbouring layers, and what `slice` does with a vertex or simplex
// depends on those alone that touch the hyperplane, through groups of vertices in it. So the slabs that the hyperplane
// touches give the same cut as the whole contour. Caps across the last axis are left out: at the slabs' own ends they
// would be wrong, and at the image's ends, where they lie in the hyperplane or beside it, they are never cut.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "extract_kernel.hpp"
#include "slice_at.hpp"
#include "tegl/slice.hpp"

namespace tegl::detail {

/// Throws InvalidArgument unless the last world coordinate depends on the last axis alone, and it alone on that axis.
template <int N>
void check_last_axis_is_apart(const Grid<N>& grid) {
  constexpr int kLast = N - 1;
  bool apart = grid.linear(kLast, kLast) != 0.0;
  for (int a = 0; a < kLast; ++a) apart = apart && grid.linear(kLast, a) == 0.0 && grid.linear(a, kLast) == 0.0;
  if (!apart)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("direct cut of a grid whose world map mixes axis {} with others; expected a last row and "
                            "column that are zero but for their diagonal element",
                            kLast));
}

/// World coordinate of sample i along the last axis, as the extraction computes it.
template <int N, class Real>
Real last_coordinate(const Grid<N>& grid, std::size_t i) {
  const double x = grid.axes[N - 1][i];
  return static_cast<Real>(grid.has_world_map() ? grid.linear(N - 1, N - 1) * x + grid.offset(N - 1) : x);
}

/// The layers {first, count} of the slabs that meet `at`; of an axis of one sample, that.
template <int N, class Real>
std::pair<std::size_t, std::size_t> layers_around(const Grid<N>& grid, double at) {
  check_last_axis_is_apart(grid);
  const Real rounded = rounded_at<Real>(at);
  const std::size_t size = grid.axes[N - 1].size();
  std::size_t first = size;
  std::size_t last = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const Real here = last_coordinate<N, Real>(grid, i);
    const Real next = last_coordinate<N, Real>(grid, std::min(i + 1, size - 1));
    if (rounded < std::min(here, next) || rounded > std::max(here, next)) continue;
    first = std::min(first, i);
    last = std::min(i + 1, size - 1);
  }
  if (first == size) {
    const auto& axis = grid.axes[N - 1];
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("cut at {}; expected a coordinate between {} and {}, the ends of axis {}{}", at,
                            last_coordinate<N, Real>(grid, 0), last_coordinate<N, Real>(grid, size - 1), N - 1,
                            axis.name.empty() ? "" : " (" + axis.name + ")"));
  }
  return {first, last - first + 1};
}

}  // namespace tegl::detail

namespace tegl {

template <class Real, Value T, int N>
Contour<N - 1, Real> slice_image(const Image<T, N>& image, double isovalue, double at, const ExtractOptions& options,
                                 ExtractStats* stats) {
  detail::check_arguments(isovalue, options);
  const auto [first, count] = detail::layers_around<N, Real>(image.grid(), at);
  const Image<T, N> slab = image.part(N - 1, first, count);
  detail::ImageSource<T, N> source(image, isovalue, options.epsilon, first);
  constexpr unsigned kAcrossOthers = (1u << (N - 1)) - 1;
  const Contour<N, Real> contour = detail::extract_source<N, Real>(
      source, slab.grid(), detail::generated_tables<N>(options), options, stats, {.closed_axes = kAcrossOthers});
  return slice(contour, at);
}

}  // namespace tegl

#define TEGL_INSTANTIATE_ONE(T, N, Real)                                                                \
  template tegl::Contour<N - 1, Real> tegl::slice_image<Real, T, N>(const Image<T, N>&, double, double, \
                                                                    const ExtractOptions&, ExtractStats*);
#define TEGL_INSTANTIATE_SLICE_IMAGE(T) \
  TEGL_INSTANTIATE_ONE(T, 3, float)     \
  TEGL_INSTANTIATE_ONE(T, 3, double)    \
  TEGL_INSTANTIATE_ONE(T, 4, float)     \
  TEGL_INSTANTIATE_ONE(T, 4, double)
