// SPDX-License-Identifier: BSD-3-Clause
//
// Streamed extraction: the contour is passed to a sink in parts; see kernel/stream.hpp.
#include "kernel/stream.hpp"

namespace tegl {

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> ExtractedSize extract_streamed(LayerReader<T, N>& layers, double isovalue,
                                                                  ContourSink<N, Real>& sink,
                                                                  const ExtractOptions& options) {
  detail::check_arguments(isovalue, options);
  detail::LayerRing<T, N> ring(layers);
  detail::LayerSource<T, N> source(ring, isovalue, options.epsilon);
  detail::StreamOutput<N, Real> output(sink, options.normals != Normals::none);
  const ExtractStats stats = detail::extract_to<N, Real>(source, layers.grid(), detail::generated_tables<N>(options),
                                                         options, detail::streaming_plan(layers.grid()), output);
  return {output.size(), stats};
}

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                                               \
  template ExtractedSize extract_streamed<Real, T, N>(LayerReader<T, N>&, double, ContourSink<N, Real>&, \
                                                      const ExtractOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
