// SPDX-License-Identifier: BSD-3-Clause
//
// Checks filters and their options, reads samples of any type, and runs filters over images in memory and by layers.
#include "tegl/filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/progress.hpp"
#include "filter/layer_filter.hpp"

namespace tegl {

std::size_t step_count(const CurvatureFlow& flow) {
  const auto refuse = [](const std::string& message) { throw Error(ErrorCode::InvalidArgument, message); };
  double sum = 0;
  for (const double h : flow.spacing) {
    if (!(h >= 0) || std::isinf(h))
      refuse(fmt::format("a step of the grid for the flow has the length {}; expected 0 or more", h));
    if (h > 0) sum += 1 / (h * h);
  }
  if (sum == 0) refuse("a flow without an axis that takes part; expected a length above 0");
  if (!(flow.time >= 0) || std::isinf(flow.time))
    refuse(fmt::format("the time of the flow is {}; expected 0 or more", flow.time));
  constexpr double kStable = 0.4, kMostSteps = 100000;
  const double steps = std::ceil(flow.time * sum / kStable);
  if (steps > kMostSteps) refuse(fmt::format("the flow takes {} steps; expected at most {}", steps, kMostSteps));
  return static_cast<std::size_t>(steps);
}

}  // namespace tegl

namespace tegl::detail {

namespace {

constexpr std::size_t kMostBox = std::size_t{1} << 20;

[[noreturn]] void fail_filter(const std::string& message) { throw Error(ErrorCode::InvalidArgument, message); }

void require_per_axis(const char* what, std::size_t count, const FilterShape& shape) {
  if (count != shape.axes())
    fail_filter(fmt::format("{} {}; expected one for each of {} axes", count, what, shape.axes()));
}

void require_finite(std::span<const double> weights) {
  for (const double weight : weights)
    if (!std::isfinite(weight))
      fail_filter(fmt::format("a weight of the kernel is {}; expected finite numbers", weight));
}

std::size_t radius_of(std::size_t size, std::size_t axis) {
  if (size % 2 == 0)
    fail_filter(fmt::format(
        "the kernel has {} weights along axis {}; expected an odd number, with the centre in the middle", size, axis));
  return size / 2;
}

void set_radii(FilterShape& shape, const SeparableConvolution& filter) {
  require_per_axis("lists of weights", filter.weights.size(), shape);
  for (std::size_t a = 0; a < shape.axes(); ++a) {
    require_finite(filter.weights[a]);
    shape.radii.push_back(filter.weights[a].empty() ? 0 : radius_of(filter.weights[a].size(), a));
  }
}

void set_radii(FilterShape& shape, const Convolution& filter) {
  require_per_axis("sizes of the kernel", filter.sizes.size(), shape);
  std::size_t count = 1;
  for (std::size_t a = 0; a < shape.axes(); ++a) {
    shape.radii.push_back(radius_of(filter.sizes[a], a));
    count *= std::min(filter.sizes[a], kMostBox + 1);
    if (count > kMostBox) return;  // refused with the other boxes
  }
  if (filter.weights.size() != count)
    fail_filter(
        fmt::format("the kernel has {} weights; expected {}, the product of its sizes", filter.weights.size(), count));
  require_finite(filter.weights);
}

void set_radii(FilterShape& shape, const MedianFilter& filter) {
  require_per_axis("radii of the median", filter.radii.size(), shape);
  shape.radii = filter.radii;
}

void set_radii(FilterShape& shape, const BilateralFilter& filter) {
  require_per_axis("sigmas of the bilateral filter", filter.sigmas.size(), shape);
  if (!(filter.value_sigma > 0) || !std::isfinite(filter.value_sigma))
    fail_filter(fmt::format("the sigma of the values is {}; expected a positive number", filter.value_sigma));
  for (const double sigma : filter.sigmas) {
    if (!(sigma >= 0) || sigma > static_cast<double>(kMostBox))
      fail_filter(fmt::format("sigma is {} samples; expected 0 or more", sigma));
    shape.radii.push_back(static_cast<std::size_t>(std::floor(2.5 * sigma)));
  }
}

void set_radii(FilterShape& shape, const ContextualLowPass& filter) {
  if (!std::isfinite(filter.isovalue))
    throw Error(ErrorCode::InvalidIsovalue,
                fmt::format("the isovalue is {}; expected a finite number", filter.isovalue));
  constexpr std::size_t kContextRadius = 2;
  shape.radii.assign(shape.axes(), kContextRadius);
}

void set_radii(FilterShape& shape, const CurvatureFlow& filter) {
  require_per_axis("lengths of steps for the flow", filter.spacing.size(), shape);
  (void)step_count(filter);
  for (const double h : filter.spacing) shape.radii.push_back(h > 0 ? 1 : 0);
}

/// The filters that are applied one after the other.
std::vector<Filter> steps_of(const Filter& filter) {
  const auto* const flow = std::get_if<CurvatureFlow>(&filter);
  if (flow == nullptr) return {filter};
  const std::size_t count = std::max<std::size_t>(1, step_count(*flow));
  return std::vector<Filter>(count, CurvatureFlow{flow->spacing, flow->time / static_cast<double>(count)});
}

FilterShape checked_shape(const std::vector<std::size_t>& sizes, const Filter& filter, const FilterOptions& options) {
  FilterShape shape{sizes, options.borders, {}, options.fill_missing, options.work.threads};
  if (shape.borders.size() == 1) shape.borders.resize(shape.axes(), shape.borders[0]);
  require_per_axis("borders", shape.borders.size(), shape);
  std::visit([&](const auto& one) { set_radii(shape, one); }, filter);
  if (std::holds_alternative<SeparableConvolution>(filter)) return shape;
  std::size_t box = 1;
  for (const std::size_t radius : shape.radii) {
    box *= 2 * std::min(radius, kMostBox) + 1;
    if (box > kMostBox)
      fail_filter(fmt::format("the filter spans more than {} samples; expected at most these", kMostBox));
  }
  return shape;
}

/// Calls visit with a pointer to a sample, of its type.
template <class Visit>
void visit_type(ValueType type, const void* data, const Visit& visit) {
  switch (type) {
    case ValueType::uint8:
      return visit(static_cast<const std::uint8_t*>(data));
    case ValueType::int8:
      return visit(static_cast<const std::int8_t*>(data));
    case ValueType::uint16:
      return visit(static_cast<const std::uint16_t*>(data));
    case ValueType::int16:
      return visit(static_cast<const std::int16_t*>(data));
    case ValueType::int32:
      return visit(static_cast<const std::int32_t*>(data));
    case ValueType::float32:
      return visit(static_cast<const float*>(data));
    default:
      return visit(static_cast<const double*>(data));
  }
}

/// Converts one layer of samples.
template <class Real>
void load_layer(const FilterSamples& samples, std::size_t layer, Real* to) {
  visit_type(samples.type, samples.data, [&]<class T>(const T* data) {
    const std::size_t axes = samples.sizes.size();
    const std::size_t width = axes > 1 ? samples.sizes[0] : 1;
    const std::ptrdiff_t step = samples.strides[0];
    std::size_t rows = 1;
    for (std::size_t a = 1; a + 1 < axes; ++a) rows *= samples.sizes[a];
    const T* const start = data + static_cast<std::ptrdiff_t>(layer) * samples.strides[axes - 1];
    for (std::size_t r = 0; r < rows; ++r, to += width) {
      const T* row = start;
      for (std::size_t a = 1, rest = r; a + 1 < axes; rest /= samples.sizes[a], ++a)
        row += static_cast<std::ptrdiff_t>(rest % samples.sizes[a]) * samples.strides[a];
      if (step == 1)
        for (std::size_t i = 0; i < width; ++i) to[i] = static_cast<Real>(row[i]);
      else
        for (std::size_t i = 0; i < width; ++i) to[i] = static_cast<Real>(row[static_cast<std::ptrdiff_t>(i) * step]);
    }
  });
}

}  // namespace

template <class Real>
std::unique_ptr<LayerFilter<Real>> make_layer_filter(const std::vector<std::size_t>& sizes, const Filter& filter,
                                                     const FilterOptions& options) {
  FilterShape shape = checked_shape(sizes, filter, options);
  if (const auto* separable = std::get_if<SeparableConvolution>(&filter))
    return make_separable_filter<Real>(std::move(shape), *separable);
  return make_window_filter<Real>(std::move(shape), filter);
}

/// Filters all layers.
template <class Real>
void filter_all(LayerFilter<Real>& layers, typename LayerFilter<Real>::Load load, const Progress& progress, Real* out) {
  const std::size_t count = layers.shape().layers();
  for (std::size_t first = 0; first < count;) {
    tell(progress, static_cast<double>(first) / static_cast<double>(count));
    const std::size_t now = std::min(layers.batch(), count - first);
    layers.compute(first, now, load, true, out + first * layers.shape().layer_size());
    first += now;
  }
  tell(progress, 1.0);
}

template <class Real>
void filter_samples(const FilterSamples& samples, const Filter& filter, const FilterOptions& options, Real* out) {
  const std::vector<Filter> steps = steps_of(filter);
  std::vector<Real> before;  // the result of the step before
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const auto layers = make_layer_filter<Real>(samples.sizes, steps[i], options);
    const std::size_t size = layers->shape().layer_size();
    if (i > 0) before.assign(out, out + size * layers->shape().layers());
    const auto load = [&](std::size_t layer, Real* to) {
      if (i == 0) return load_layer(samples, layer, to);
      std::copy_n(before.data() + layer * size, size, to);
    };
    const auto all = static_cast<double>(steps.size());
    filter_all<Real>(*layers, load,
                     part_of(options.work.progress, static_cast<double>(i) / all, static_cast<double>(i + 1) / all),
                     out);
  }
}

template <class Real>
void convert_samples(ValueType type, const void* from, std::size_t count, Real* to) {
  visit_type(type, from, [&](const auto* values) {
    for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<Real>(values[i]);
  });
}

template <class Real>
FilterOfLayers<Real>::FilterOfLayers(std::vector<std::size_t> sizes, const Filter& filter, const FilterOptions& options,
                                     Load load)
    : load_(std::move(load)) {
  for (const Filter& step : steps_of(filter)) steps_.push_back(make_layer_filter<Real>(sizes, step, options));
  // Each step would read its first layers after its last ones, and compute most layers many times.
  const FilterShape& shape = steps_.front()->shape();
  if (steps_.size() > 1 && shape.borders.back() == FilterBorder::cyclic && shape.radii.back() > 0)
    throw Error(ErrorCode::UnsupportedData,
                "a flow by layers with a cyclic border along the last axis; expected another border there, or an image "
                "in memory");
}

template <class Real>
FilterOfLayers<Real>::~FilterOfLayers() = default;

template <class Real>
void FilterOfLayers<Real>::read(std::size_t layer, Real* to) {
  read(steps_.size() - 1, layer, to);
}

template <class Real>
void FilterOfLayers<Real>::read(std::size_t step, std::size_t layer, Real* to) {
  const auto load = [&](std::size_t from, Real* into) {
    if (step == 0) return load_(from, into);
    read(step - 1, from, into);
  };
  steps_[step]->compute(layer, 1, load, false, to);
}

template void filter_samples<float>(const FilterSamples&, const Filter&, const FilterOptions&, float*);
template void filter_samples<double>(const FilterSamples&, const Filter&, const FilterOptions&, double*);
template void convert_samples<float>(ValueType, const void*, std::size_t, float*);
template void convert_samples<double>(ValueType, const void*, std::size_t, double*);
template class FilterOfLayers<float>;
template class FilterOfLayers<double>;

}  // namespace tegl::detail
