// SPDX-License-Identifier: BSD-3-Clause
//
// Layers of a scale space, and the scale at which a measure changes least.
//
// Based on: T. Lindeberg, Scale-space for discrete signals, IEEE PAMI 12, 1990, and Feature detection with automatic
// scale selection, IJCV 30, 1998 (the scale-normalised Laplacian).
#include "tegl/scale_space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/progress.hpp"

namespace tegl {

namespace {

void require_scale(double sigma) {
  if (!(sigma > 0) || !std::isfinite(sigma))
    throw Error(ErrorCode::InvalidArgument, fmt::format("a scale has sigma {}; expected a positive number", sigma));
}

}  // namespace

std::vector<double> scale_sigmas(double first, double last, std::size_t count) {
  require_scale(first);
  require_scale(last);
  if (count < 2 || first >= last)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} scales from {} to {}; expected at least 2, ascending", count, first, last));
  std::vector<double> sigmas;
  for (std::size_t k = 0; k < count; ++k)
    sigmas.push_back(first * std::pow(last / first, static_cast<double>(k) / static_cast<double>(count - 1)));
  sigmas.back() = last;
  return sigmas;
}

Axis scale_axis(std::span<const double> sigmas) {
  if (sigmas.empty()) throw Error(ErrorCode::InvalidArgument, "no scales; expected at least one");
  std::vector<double> logarithms;
  for (const double sigma : sigmas) {
    require_scale(sigma);
    if (!logarithms.empty() && std::log2(sigma) <= logarithms.back())
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("sigma {} after a scale that is not less; expected ascending scales", sigma));
    logarithms.push_back(std::log2(sigma));
  }
  const double step =
      sigmas.size() < 2 ? 1.0 : (logarithms.back() - logarithms.front()) / static_cast<double>(sigmas.size() - 1);
  constexpr double kRounding = 1e-12;
  bool uniform = true;
  for (std::size_t k = 0; k < sigmas.size(); ++k)
    uniform = uniform && std::abs(logarithms[k] - logarithms[0] - static_cast<double>(k) * step) < kRounding;
  Axis axis = uniform ? Axis::uniform(sigmas.size(), logarithms[0], step) : Axis::rectilinear(logarithms);
  axis.name = "log2_sigma";
  return axis;
}

StableScale most_stable_scale(std::span<const double> sigmas, std::span<const double> measures) {
  if (sigmas.size() != measures.size())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} measures of {} scales; expected one for each", measures.size(), sigmas.size()));
  StableScale best;
  for (std::size_t k = 1; k + 1 < sigmas.size(); ++k) {
    require_scale(sigmas[k - 1]);
    require_scale(sigmas[k + 1]);
    if (!(measures[k - 1] > 0 && measures[k] > 0 && measures[k + 1] > 0)) continue;
    const double change = std::log(measures[k + 1] / measures[k - 1]) / std::log(sigmas[k + 1] / sigmas[k - 1]);
    if (best.sigma == 0 || std::abs(change) < std::abs(best.change)) best = {k, sigmas[k], change};
  }
  return best;
}

namespace detail {

void require_factors(std::span<const double> factors, std::size_t axes) {
  if (factors.size() != axes)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} factors of the scale; expected one for each of {} axes", factors.size(), axes));
  for (const double factor : factors)
    if (!(factor >= 0) || !std::isfinite(factor))
      throw Error(ErrorCode::InvalidArgument, fmt::format("a factor of the scale is {}; expected 0 or more", factor));
}

void require_even_steps(std::span<const Axis> axes, std::span<const double> factors) {
  for (std::size_t a = 0; a < axes.size(); ++a)
    if (factors[a] != 0 && !axes[a].is_uniform())
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("the scale is in units of the axes, but the steps of axis {} '{}' differ; expected scales "
                      "in samples, or the factor 0 for it",
                      a, axes[a].name));
}

std::vector<double> scaled_sigmas(double sigma, std::span<const double> in_samples) {
  std::vector<double> result;
  for (const double one : in_samples) result.push_back(sigma * one);
  return result;
}

template <class Real>
void scale_space_layer(const FilterSamples& samples, std::span<const double> sigmas, ScaleQuantity quantity,
                       const FilterOptions& options, Real* out) {
  SeparableConvolution smooth;
  for (const double sigma : sigmas)
    smooth.weights.push_back(sigma == 0 ? AxisWeights() : discrete_gaussian_weights(sigma));
  if (quantity == ScaleQuantity::values) return filter_samples(samples, smooth, options, out);
  // smooth
  FilterOptions first = options;
  first.work.progress = part_of(options.work.progress, 0.0, 0.8);
  std::size_t count = 1;
  for (const std::size_t size : samples.sizes) count *= size;
  std::vector<Real> smoothed(count);
  filter_samples(samples, smooth, first, smoothed.data());
  // second differences
  Convolution differences;
  std::size_t box = 1;
  for (const double sigma : sigmas) {
    differences.sizes.push_back(sigma == 0 ? 1 : 3);
    box *= differences.sizes.back();
  }
  differences.weights.assign(box, 0.0);
  std::size_t stride = 1;
  for (std::size_t a = 0; a < sigmas.size(); stride *= differences.sizes[a], ++a) {
    if (sigmas[a] == 0) continue;
    const double variance = sigmas[a] * sigmas[a];
    differences.weights[box / 2] += 2 * variance;
    differences.weights[box / 2 - stride] -= variance;
    differences.weights[box / 2 + stride] -= variance;
  }
  FilterOptions second = options;
  second.work.progress = part_of(options.work.progress, 0.8, 1.0);
  FilterSamples dense{smoothed.data(), kValueType<Real>, samples.sizes, {}};
  std::ptrdiff_t step = 1;
  for (const std::size_t size : samples.sizes) {
    dense.strides.push_back(step);
    step *= static_cast<std::ptrdiff_t>(size);
  }
  filter_samples(dense, differences, second, out);
}

template void scale_space_layer<float>(const FilterSamples&, std::span<const double>, ScaleQuantity,
                                       const FilterOptions&, float*);
template void scale_space_layer<double>(const FilterSamples&, std::span<const double>, ScaleQuantity,
                                        const FilterOptions&, double*);

}  // namespace detail

}  // namespace tegl
