// SPDX-License-Identifier: BSD-3-Clause
//
// Filters of images: convolution, Gaussian and binomial smoothing, median, bilateral filter, and a low-pass filter that
// leaves details of a contour unchanged. The result is an image on the same grid.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "tegl/image.hpp"
#include "tegl/layers.hpp"
#include "tegl/value_type.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// The samples outside of an image along an axis. extended: equal to the nearest sample of the image; cyclic: the image
/// is repeated; missing: as missing samples inside the image.
enum class FilterBorder : std::uint8_t { extended, cyclic, missing };

/// Weights a_l of a convolution along one axis: an odd number, the middle one is a_0. The result is sum_l a_l V(x + l).
using AxisWeights = std::vector<double>;

/// Weights of a Gaussian sampled at the integers, up to `truncate` sigma from the centre; their sum is 1. `sigma` in
/// samples, 0 or more; 0 gives a single 1. Errors: InvalidArgument.
[[nodiscard]] AxisWeights gaussian_weights(double sigma, double truncate = 4.0);
/// Weights e^(-t) I_k(t) of the discrete Gaussian of variance t = sigma^2 (T. Lindeberg, Scale-space for discrete
/// signals, 1990), up to a remainder of 1e-7; their sum is 1. Two such kernels in turn equal one whose variance is the
/// sum of their variances. `sigma` in samples, 0 or more. Errors: InvalidArgument.
[[nodiscard]] AxisWeights discrete_gaussian_weights(double sigma);
/// Binomial coefficients with an even order divided by their sum, as 1/4, 1/2, 1/4: the order is the even number
/// closest to 4 sigma^2, so the standard deviation is sqrt(order) / 2. `sigma` in samples, 0 to 100. Errors:
/// InvalidArgument.
[[nodiscard]] AxisWeights binomial_weights(double sigma);

/// One convolution along each axis in turn. No weights for an axis: it is not filtered.
struct SeparableConvolution {
  std::vector<AxisWeights> weights = {};  ///< one entry per axis
};
/// A convolution with any kernel: sum over l of a_l V(x + l).
struct Convolution {
  std::vector<std::size_t> sizes = {};  ///< odd, one per axis; the centre is in the middle
  std::vector<double> weights = {};     ///< the product of the sizes, axis 0 fastest
};
/// The median of the samples in a box around each sample; of an even number of valid samples, the mean of the two in
/// the middle.
struct MedianFilter {
  std::vector<std::size_t> radii = {};  ///< one per axis; the box has 2 radius + 1 samples along it
};
/// The mean of the samples V around each sample V0, weighted by a Gaussian of the distance and by a Gaussian of V - V0
/// (C. Tomasi and R. Manduchi, Bilateral filtering for gray and color images, 1998). Smooths, but not across large
/// differences. Samples farther than 2.5 sigma, or differing by more than 4 `value_sigma`, have no weight.
struct BilateralFilter {
  std::vector<double> sigmas = {};  ///< in samples, one per axis; 0: no neighbours along it
  double value_sigma = 0;           ///< of the values; positive
};
/// Smooths the steps of a contour, but leaves its details unchanged. A sample is replaced by the binomial mean (weights
/// 1/4, 1/2, 1/4 along each axis) of its 3^N neighbours if the contour passes between some of these, and if it does not
/// cross a line twice that is parallel to an axis, has two samples on both sides, and passes through one of them. Each
/// sample stays on its side of the isovalue, so the contour keeps its topology. Near missing samples nothing changes.
/// After the idea of section 9.1.6 of the thesis that docs/theory.md cites; the rule is ours.
struct ContextualLowPass {
  double isovalue = 0;  ///< finite
};
/// Curvature flow: dV/dt = |grad V| div(grad V / |grad V|). Each contour {V = isovalue} moves towards its centre of
/// curvature, with the sum of its n - 1 curvatures as its speed, so details and noise vanish first: a ball of radius r
/// has the radius sqrt(r^2 - 2 (n - 1) t) at the time t. Samples next to missing ones use their own value in place of
/// these; missing samples stay missing.
///
/// Explicit steps with central differences over the 3^N neighbours, all of the same duration, at most 0.4 / sum(1 /
/// h_a^2) for the steps h_a of the grid; no step leaves the range of the neighbours' values. Where the gradient is 0,
/// the flow is (n - 1) / n of the Laplacian. Time: O(samples x steps); the number of steps is proportional to `time`.
/// Source: L. Alvarez, P.-L. Lions and J.-M. Morel, Image selective smoothing and edge detection by nonlinear diffusion
/// II, 1992; the scheme follows S. Osher and J. A. Sethian, 1988.
struct CurvatureFlow {
  std::vector<double> spacing = {};  ///< one per axis: length of a step of the grid; 0: the axis does not take part
  double time = 0;                   ///< duration of the flow, in the square of the unit of `spacing`; 0 or more
};
/// Number of steps of a flow. Errors: InvalidArgument (lengths or a time below 0 or not finite, no axis that takes
/// part, more than 100 000 steps).
[[nodiscard]] std::size_t step_count(const CurvatureFlow& flow);

/// A filter of `filter_image` and `filter_layers`.
using Filter =
    std::variant<SeparableConvolution, Convolution, MedianFilter, BilateralFilter, ContextualLowPass, CurvatureFlow>;

/// Options of filters.
struct FilterOptions {
  /// One for each axis, or one for all axes.
  std::vector<FilterBorder> borders = {FilterBorder::extended};
  /// Whether missing samples get values, if they have neighbours with values. By default they stay missing.
  /// Not for ContextualLowPass and CurvatureFlow.
  bool fill_missing = false;
  WorkOptions work = {};  ///< threads and progress
};

/// The type of filtered samples: double for double, else float.
template <Value T>
using FilteredValue = std::conditional_t<std::is_same_v<T, double>, double, float>;

/// Standard deviations in samples of those given in units of the axes: divided by the length of a step in the world.
/// Errors: InvalidArgument for a rectilinear axis with a sigma other than 0, which is no constant number of samples.
template <int N>
[[nodiscard]] std::array<double, N> sigmas_in_samples(const Grid<N>& grid, const std::array<double, N>& sigmas);

namespace detail {

/// The samples of an image of any type and dimension. Strides count elements.
struct FilterSamples {
  const void* data = nullptr;
  ValueType type = ValueType::float32;
  std::vector<std::size_t> sizes = {};
  std::vector<std::ptrdiff_t> strides = {};
};

template <class Real>
class LayerFilter;

/// Output layers computed one by one, in any order; fast in ascending order.
template <class Real>
class FilterOfLayers {
 public:
  /// Writes an input layer to its argument.
  using Load = std::function<void(std::size_t layer, Real* to)>;

  FilterOfLayers(std::vector<std::size_t> sizes, const Filter& filter, const FilterOptions& options, Load load);
  ~FilterOfLayers();
  FilterOfLayers(const FilterOfLayers&) = delete;
  FilterOfLayers& operator=(const FilterOfLayers&) = delete;
  void read(std::size_t layer, Real* to);

 private:
  void read(std::size_t step, std::size_t layer, Real* to);

  std::vector<std::unique_ptr<LayerFilter<Real>>> steps_;  ///< each filters the result of the one before it
  Load load_;
};

/// Writes the filtered samples to `out`, axis 0 fastest.
template <class Real>
void filter_samples(const FilterSamples& samples, const Filter& filter, const FilterOptions& options, Real* out);
/// Converts samples that are adjacent in memory.
template <class Real>
void convert_samples(ValueType type, const void* from, std::size_t count, Real* to);

template <Value T, int N>
FilterSamples samples_of(const Image<T, N>& image) {
  FilterSamples samples{image.data(), kValueType<T>, {}, {}};
  for (int a = 0; a < N; ++a) {
    samples.sizes.push_back(image.size(a));
    samples.strides.push_back(image.strides()[a]);
  }
  return samples;
}

template <Value T, int N>
class FilteredLayers final : public LayerReader<FilteredValue<T>, N> {
  using Real = FilteredValue<T>;

 public:
  FilteredLayers(LayerReader<T, N>& source, const Filter& filter, const FilterOptions& options)
      : grid_(source.grid()),
        layers_(as_vector(grid_.sizes()), filter, options, [this, &source](std::size_t k, Real* to) {
          if constexpr (std::is_same_v<T, Real>) return source.read(k, to);
          if (buffer_.empty()) {
            std::size_t count = 1;
            for (int a = 0; a + 1 < N; ++a) count *= grid_.axes[a].size();
            buffer_.resize(count);
          }
          source.read(k, buffer_.data());
          convert_samples(kValueType<T>, buffer_.data(), buffer_.size(), to);
        }) {}
  [[nodiscard]] const Grid<N>& grid() const noexcept override { return grid_; }
  void read(std::size_t k, Real* to) override { layers_.read(k, to); }

 private:
  static std::vector<std::size_t> as_vector(const std::array<std::size_t, N>& sizes) {
    return {sizes.begin(), sizes.end()};
  }
  Grid<N> grid_;
  std::vector<T> buffer_;
  FilterOfLayers<Real> layers_;
};

}  // namespace detail

/// The image after a filter, on the same grid; N = 2 to 5. Samples are float, or double for an image of double.
///
/// Missing samples (NaN) have no weight. Convolutions with weights of at least 0 are normalised there: the weighted
/// mean of the valid samples, times the sum of all weights. A convolution with a negative weight is missing if a sample
/// with a weight is missing. Where the image is missing the result is too, unless `fill_missing` is set.
///
/// The result does not depend on the number of threads. Sums are in the type of the result, from the first weight to
/// the last, so the last bits depend on the order of the axes. Time: separable O(samples x weights of all axes), other
/// filters O(samples x box); the bilateral filter takes its weights from tables with an error below 1e-6. Memory: the
/// result, and as many layers along the last axis as the filter spans there, and some more.
///
/// Errors: InvalidArgument (lists of another length than the number of axes, an even size, weights or sigmas that are
/// not finite, a box of more than 2^20 samples), Cancelled.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] OwnedImage<FilteredValue<T>, N> filter_image(const Image<T, N>& image, const Filter& filter,
                                                           const FilterOptions& options = {}) {
  OwnedImage<FilteredValue<T>, N> result{image.grid(), {}};
  std::size_t count = 1;
  for (int a = 0; a < N; ++a) count *= image.size(a);
  detail::ValueVector<FilteredValue<T>> values;
  values.resize(count);
  detail::filter_samples(detail::samples_of(image), filter, options, values.data());
  result.values = std::move(values);
  return result;
}

/// As filter_image, for an image that is read by layers: the same samples, computed when a layer is read. The source
/// must outlive the result. Each of its layers is read once, in ascending order, if the result's are; with a cyclic
/// border along the last axis, its last layers are read first, and some layers twice. Progress is not called. Memory:
/// the layers along the last axis that the filter spans; for CurvatureFlow some layers for each of its steps. Errors:
/// those of filter_image and of the source; UnsupportedData for CurvatureFlow of several steps with a cyclic border
/// along the last axis.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::unique_ptr<LayerReader<FilteredValue<T>, N>> filter_layers(LayerReader<T, N>& source,
                                                                              const Filter& filter,
                                                                              const FilterOptions& options = {}) {
  return std::make_unique<detail::FilteredLayers<T, N>>(source, filter, options);
}

}  // namespace tegl
