// SPDX-License-Identifier: BSD-3-Clause
//
// An image that is read layer by layer, with or without periodic axes, for one streamed extraction or several.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "kernel/stream.hpp"
#include "periodic/periodic_ring.hpp"
#include "periodic/periods.hpp"
#include "periodic/wrapped_stream.hpp"

namespace tegl::detail {

/// Creates the samples and the outputs of extractions of an image. Compiled once for all value types.
template <int N, class Real>
class StreamedImage {
 public:
  virtual ~StreamedImage() = default;
  StreamedImage(const StreamedImage&) = delete;
  StreamedImage& operator=(const StreamedImage&) = delete;

  /// The grid that is extracted: longer by a layer along periodic axes.
  [[nodiscard]] const Grid<N>& grid() const noexcept { return longer_; }
  [[nodiscard]] ExtractPlan plan() const {
    ExtractPlan plan = streaming_plan(longer_);
    plan.seam_axes = axes_;
    plan.closed_axes = ~axes_;
    return plan;
  }
  [[nodiscard]] virtual std::unique_ptr<SampleSource<N>> samples(double isovalue) = 0;
  [[nodiscard]] std::unique_ptr<StreamOutput<N, Real>> output(ContourSink<N, Real>& sink) const {
    if (axes_ == 0) return std::make_unique<StreamOutput<N, Real>>(sink, options_.normals);
    return std::make_unique<WrappedStream<N, Real>>(sink, *shape_, axes_, contour_periods_, options_);
  }

 protected:
  using OutputOptions = typename WrappedStream<N, Real>::Options;

  StreamedImage(const Grid<N>& grid, const AxisPeriods<N>& periods, const ExtractOptions& options,
                bool may_miss_samples)
      : periods_(periods), longer_(grid), options_{options.normals != Normals::none, options.close, may_miss_samples} {
    for (int a = 0; a < N; ++a) axes_ |= periods[a] != 0.0 ? 1u << a : 0u;
    if (axes_ == 0) return;
    check_periods(grid, periods, options);
    longer_ = longer_grid(grid, periods);
    shape_.emplace(longer_.sizes());
    contour_periods_ = world_periods(grid, periods);
  }
  [[nodiscard]] bool has_periods() const noexcept { return axes_ != 0; }
  [[nodiscard]] const AxisPeriods<N>& periods() const noexcept { return periods_; }

 private:
  AxisPeriods<N> periods_;
  Grid<N> longer_;
  OutputOptions options_;
  unsigned axes_ = 0;
  std::optional<RowShape<N>> shape_;
  std::vector<Period<N>> contour_periods_;
};

/// The image of a reader.
template <Value T, int N, class Real>
class StreamedLayers final : public StreamedImage<N, Real> {
 public:
  StreamedLayers(LayerReader<T, N>& layers, const AxisPeriods<N>& periods, const ExtractOptions& options)
      : StreamedImage<N, Real>(layers.grid(), periods, options, std::is_floating_point_v<T>),
        epsilon_(options.epsilon) {
    if (this->has_periods())
      periodic_.emplace(layers, periods, options.normals != Normals::none);
    else
      plain_.emplace(layers);
  }
  [[nodiscard]] std::unique_ptr<SampleSource<N>> samples(double isovalue) override {
    if (plain_) return std::make_unique<LayerSource<T, N>>(*plain_, isovalue, epsilon_);
    return std::make_unique<PeriodicLayerSource<T, N>>(*periodic_, this->periods(), this->grid(), isovalue, epsilon_);
  }

 private:
  double epsilon_;
  std::optional<LayerRing<T, N>> plain_;
  std::optional<PeriodicRing<T, N>> periodic_;
};

}  // namespace tegl::detail
