// SPDX-License-Identifier: BSD-3-Clause
//
// The public function `extract_placed_with_stats`.
#include "extract/uncertainty.hpp"
#include "image/row_source.hpp"
#include "position/place.hpp"

namespace tegl {

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 5> Extraction<N, Real> extract_placed_with_stats(const Image<T, N>& image,
                                                                                 double isovalue,
                                                                                 const PositionOptions& positions,
                                                                                 const ExtractOptions& options) {
  detail::check_arguments(isovalue, options);
  std::size_t samples = 1;
  for (int a = 0; a < N; ++a) samples *= image.size(a);
  detail::check_positions(positions, samples, N);
  if (positions.rule == Positions::linear) return extract_with_stats<Real>(image, isovalue, options);
  detail::ImageSource<T, N> source(image, isovalue, options.epsilon);
  const auto threshold = detail::make_threshold<T>(isovalue);
  const auto starts_high = [&](std::size_t k, const detail::EdgesInRows& edges) {
    const T* const layer = image.data() + static_cast<std::ptrdiff_t>(k) * image.strides()[N - 1];
    detail::Word bits = 0;
    for (std::size_t i = 0; i < edges.count; ++i)
      bits |= detail::Word{layer[edges.rows[i] + edges.at[i] * image.strides()[0]] >= threshold.value} << i;
    return threshold.never ? detail::Word{0} : bits;
  };
  return detail::add_uncertainty<N, Real>(image, options, {}, [&](const detail::ExtractPlan& plan) {
    return detail::extract_placed_from<N, Real>(source, starts_high, image.grid(), positions, options, plan);
  });
}

#define TEGL_INSTANTIATE_DIMENSIONS(T, N)                                                                              \
  template Extraction<N, float> extract_placed_with_stats<float, T, N>(const Image<T, N>&, double,                     \
                                                                       const PositionOptions&, const ExtractOptions&); \
  template Extraction<N, double> extract_placed_with_stats<double, T, N>(                                              \
      const Image<T, N>&, double, const PositionOptions&, const ExtractOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
