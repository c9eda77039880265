// SPDX-License-Identifier: BSD-3-Clause
//
// The public function `extract_periodic_with_stats`.
#include "kernel/extract_kernel.hpp"
#include "kernel/stream.hpp"
#include "periodic/periodic_layers.hpp"
#include "periodic/periods.hpp"
#include "periodic/wrapped_output.hpp"
#include "tegl/periodic.hpp"

namespace tegl {

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> Extraction<N, Real> extract_periodic_with_stats(const Image<T, N>& image,
                                                                                   const AxisPeriods<N>& periods,
                                                                                   double isovalue,
                                                                                   const ExtractOptions& options) {
  detail::check_arguments(isovalue, options);
  detail::check_periods(image.grid(), periods, options);
  const Grid<N> longer = detail::longer_grid(image.grid(), periods);
  Extraction<N, Real> result;
  detail::describe(longer, options, result.contour);
  result.contour.periods = detail::world_periods(image.grid(), periods);
  unsigned axes = 0;
  for (int a = 0; a < N; ++a) axes |= periods[a] != 0.0 ? 1u << a : 0u;
  const detail::ExtractPlan plan;
  detail::WrappedOutput<N, Real> output(result.contour, axes, options.work.threads, plan.max_vertices);
  const auto extract_from = [&](detail::SampleSource<N>& source) {
    result.stats = detail::extract_to(source, longer, detail::generated_tables<N>(options), options, plan, output);
  };
  if (axes >> (N - 1) << (N - 1) == axes) {
    detail::RepeatedSource<T, N> source(image, longer, isovalue, options.epsilon);
    extract_from(source);
  } else {
    detail::PeriodicLayers<T, N> layers(image, longer);
    detail::LayerRing<T, N> ring(layers);
    detail::LayerSource<T, N> source(ring, isovalue, options.epsilon);
    extract_from(source);
  }
  return result;
}

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                                                        \
  template Extraction<N, Real> extract_periodic_with_stats<Real, T, N>(const Image<T, N>&, const AxisPeriods<N>&, \
                                                                       double, const ExtractOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
