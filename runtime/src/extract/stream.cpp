// SPDX-License-Identifier: BSD-3-Clause
//
// Streamed extraction: the contour is passed to a sink in parts; see kernel/stream.hpp.
#include "extract/streamed_image.hpp"

namespace tegl {

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> ExtractedSize extract_streamed(LayerReader<T, N>& layers, double isovalue,
                                                                  ContourSink<N, Real>& sink,
                                                                  const ExtractOptions& options,
                                                                  const AxisPeriods<N>& periods) {
  detail::check_arguments(isovalue, options);
  detail::StreamedLayers<T, N, Real> image(layers, periods, options);
  const auto samples = image.samples(isovalue);
  const auto output = image.output(sink);
  const ExtractStats stats = detail::extract_to<N, Real>(*samples, image.grid(), detail::generated_tables<N>(options),
                                                         options, image.plan(), *output);
  return {output->size(), stats};
}

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                                               \
  template ExtractedSize extract_streamed<Real, T, N>(LayerReader<T, N>&, double, ContourSink<N, Real>&, \
                                                      const ExtractOptions&, const AxisPeriods<N>&);
#include "base/instantiate.hpp"

}  // namespace tegl
