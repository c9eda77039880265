// SPDX-License-Identifier: BSD-3-Clause
//
// The public functions `extract_periodic_with_stats` and `count_periodic`.
#include <limits>

#include "kernel/extract_kernel.hpp"
#include "periodic/periodic_layers.hpp"
#include "periodic/periods.hpp"
#include "periodic/wrapped_output.hpp"
#include "tegl/periodic.hpp"

namespace tegl {
namespace detail {
namespace {

/// The extraction of an image that is longer along its periodic axes.
template <Value T, int N>
class PeriodicExtraction {
 public:
  PeriodicExtraction(const Image<T, N>& image, const AxisPeriods<N>& periods, double isovalue,
                     const ExtractOptions& options)
      : image_(image),
        periods_(periods),
        isovalue_(isovalue),
        options_(options),
        longer_((check_arguments(isovalue, options), check_periods(image.grid(), periods, options),
                 longer_grid(image.grid(), periods))),
        shape_(longer_.sizes()),
        tables_(generated_tables<N>(options)) {
    for (int a = 0; a < N; ++a) plan_.seam_axes |= periods[a] != 0.0 ? 1u << a : 0u;
    plan_.closed_axes = ~plan_.seam_axes;
  }

  [[nodiscard]] const RowShape<N>& shape() const noexcept { return shape_; }
  [[nodiscard]] unsigned axes() const noexcept { return plan_.seam_axes; }

  template <class Real>
  Extraction<N, Real> contour() const {
    Extraction<N, Real> result;
    describe(longer_, options_, result.contour);
    result.contour.periods = world_periods(image_.grid(), periods_);
    const std::uint64_t most =
        is_estimated(options_.ambiguity) ? std::numeric_limits<std::uint64_t>::max() : tables_.max_simplices;
    WrappedOutput<N, Real> output(result.contour, shape_, axes(), most, options_.normals != Normals::none,
                                  plan_.max_vertices);
    result.stats = extract(output);
    return result;
  }

  template <class Real>
  ExtractStats extract(ContourOutput<N, Real>& output) const {
    if (axes() >> (N - 1) << (N - 1) != axes()) {
      CopiedSource<T, N> source(image_, periods_, longer_, options_, isovalue_);
      return extract_to(source, longer_, tables_, options_, plan_, output);
    }
    RepeatedSource<T, N> source(image_, periods_, longer_, options_, isovalue_);
    return extract_to(source, longer_, tables_, options_, plan_, output);
  }

 private:
  const Image<T, N>& image_;
  const AxisPeriods<N>& periods_;
  double isovalue_;
  const ExtractOptions& options_;
  Grid<N> longer_;
  RowShape<N> shape_;
  TableSet<N> tables_;
  ExtractPlan plan_;
};

}  // namespace
}  // namespace detail

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> Extraction<N, Real> extract_periodic_with_stats(const Image<T, N>& image,
                                                                                   const AxisPeriods<N>& periods,
                                                                                   double isovalue,
                                                                                   const ExtractOptions& options) {
  return detail::PeriodicExtraction<T, N>(image, periods, isovalue, options).template contour<Real>();
}

template <Value T, int N>
requires DimensionBetween<N, 2, 4> ContourSize count_periodic(const Image<T, N>& image, const AxisPeriods<N>& periods,
                                                              double isovalue, const ExtractOptions& asked) {
  ExtractOptions options = asked;
  options.normals = Normals::none;  // not counted: one per vertex
  const detail::PeriodicExtraction<T, N> extraction(image, periods, isovalue, options);
  detail::WrappedCount<N, float> output(extraction.shape(), extraction.axes());
  (void)extraction.extract(output);
  if (!output.any_missing) return output.size;
  const Contour<N, float> contour = extraction.template contour<float>().contour;
  return {contour.vertices.size(), contour.simplices.size()};
}

#define TEGL_INSTANTIATE_DIM(T, N)                                                                                     \
  template ContourSize count_periodic<T, N>(const Image<T, N>&, const AxisPeriods<N>&, double, const ExtractOptions&); \
  template Extraction<N, float> extract_periodic_with_stats<float, T, N>(const Image<T, N>&, const AxisPeriods<N>&,    \
                                                                         double, const ExtractOptions&);               \
  template Extraction<N, double> extract_periodic_with_stats<double, T, N>(const Image<T, N>&, const AxisPeriods<N>&,  \
                                                                           double, const ExtractOptions&);
#define TEGL_INSTANTIATE(T)  \
  TEGL_INSTANTIATE_DIM(T, 2) \
  TEGL_INSTANTIATE_DIM(T, 3) \
  TEGL_INSTANTIATE_DIM(T, 4)
#include "base/instantiate.hpp"
#undef TEGL_INSTANTIATE_DIM

}  // namespace tegl
