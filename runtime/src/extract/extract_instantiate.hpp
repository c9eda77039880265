// SPDX-License-Identifier: BSD-3-Clause
//
// The public function `extract`: checks its arguments and calls the kernel, which is independent of the value type.
// Each source that includes this file instantiates a few value types, so that they compile in parallel.
#pragma once

#include "image/transposed_layers.hpp"
#include "kernel/stream.hpp"
#include "kernel/tableless.hpp"

namespace tegl {

template <class Real, Value T, int N>
Contour<N, Real> extract(const Image<T, N>& image, double isovalue, const ExtractOptions& options,
                         ExtractStats* stats) {
  detail::check_arguments(isovalue, options);
  if constexpr (N <= 4)
    if (detail::is_better_turned(image)) {
      detail::TurnedLayers<T, N> layers(image, options.threads);
      detail::LayerRing<T, N> ring(layers);
      detail::LayerSource<T, N> source(ring, isovalue, options.epsilon);
      return detail::extract_any<N, Real>(source, image.grid(), options, stats);
    }
  detail::ImageSource<T, N> source(image, isovalue, options.epsilon);
  return detail::extract_any<N, Real>(source, image.grid(), options, stats);
}

}  // namespace tegl

#define TEGL_INSTANTIATE_ONE(T, N, Real)                                                                       \
  template tegl::Contour<N, Real> tegl::extract<Real, T, N>(const Image<T, N>&, double, const ExtractOptions&, \
                                                            ExtractStats*);
#define TEGL_INSTANTIATE_EXTRACT(T)  \
  TEGL_INSTANTIATE_ONE(T, 2, float)  \
  TEGL_INSTANTIATE_ONE(T, 2, double) \
  TEGL_INSTANTIATE_ONE(T, 3, float)  \
  TEGL_INSTANTIATE_ONE(T, 3, double) \
  TEGL_INSTANTIATE_ONE(T, 4, float)  \
  TEGL_INSTANTIATE_ONE(T, 4, double) \
  TEGL_INSTANTIATE_ONE(T, 5, float)  \
  TEGL_INSTANTIATE_ONE(T, 5, double)
