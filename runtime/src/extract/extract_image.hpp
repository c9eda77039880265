// SPDX-License-Identifier: BSD-3-Clause
//
// The public functions `extract_with_stats` and `extract_several`: checks its arguments and calls the kernel, which is
// independent of the value type. Each source that includes this file instantiates a few value types, so that they
// compile in parallel.
#pragma once

#include "base/progress.hpp"
#include "extract/uncertainty.hpp"
#include "image/transposed_layers.hpp"
#include "kernel/extract_in_memory.hpp"
#include "kernel/stream.hpp"

namespace tegl {

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 5> Extraction<N, Real> extract_with_stats(const Image<T, N>& image, double isovalue,
                                                                          const ExtractOptions& options) {
  detail::check_arguments(isovalue, options);
  if constexpr (N <= 4)
    if (detail::is_better_turned(image)) {
      detail::TurnedLayers<T, N> layers(image, options.work.threads);
      detail::LayerRing<T, N> ring(layers);
      detail::LayerSource<T, N> source(ring, isovalue, options.epsilon);
      return detail::extract_with_uncertainty<N, Real>(source, image.grid(), image, options);
    }
  detail::ImageSource<T, N> source(image, isovalue, options.epsilon);
  return detail::extract_with_uncertainty<N, Real>(source, image.grid(), image, options);
}

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 5> std::vector<Contour<N, Real>> extract_several(const Image<T, N>& image,
                                                                                 std::span<const double> isovalues,
                                                                                 const ExtractOptions& options) {
  for (const double isovalue : isovalues) detail::check_arguments(isovalue, options);
  std::vector<Contour<N, Real>> contours;
  contours.reserve(isovalues.size());
  const auto share = [&](std::size_t i) { return static_cast<double>(i) / static_cast<double>(isovalues.size()); };
  ExtractOptions one = options;
  for (std::size_t i = 0; i < isovalues.size(); ++i) {
    one.work.progress = detail::part_of(options.work.progress, share(i), share(i + 1));
    contours.push_back(extract<Real>(image, isovalues[i], one));
  }
  return contours;
}

}  // namespace tegl

#define TEGL_INSTANTIATE_ONE(T, N, Real)                                                              \
  template tegl::Extraction<N, Real> tegl::extract_with_stats<Real, T, N>(const Image<T, N>&, double, \
                                                                          const ExtractOptions&);     \
  template std::vector<tegl::Contour<N, Real>> tegl::extract_several<Real, T, N>(                     \
      const Image<T, N>&, std::span<const double>, const ExtractOptions&);
#define TEGL_INSTANTIATE_EXTRACT(T)  \
  TEGL_INSTANTIATE_ONE(T, 2, float)  \
  TEGL_INSTANTIATE_ONE(T, 2, double) \
  TEGL_INSTANTIATE_ONE(T, 3, float)  \
  TEGL_INSTANTIATE_ONE(T, 3, double) \
  TEGL_INSTANTIATE_ONE(T, 4, float)  \
  TEGL_INSTANTIATE_ONE(T, 4, double) \
  TEGL_INSTANTIATE_ONE(T, 5, float)  \
  TEGL_INSTANTIATE_ONE(T, 5, double)
