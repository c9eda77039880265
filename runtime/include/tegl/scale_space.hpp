// SPDX-License-Identifier: BSD-3-Clause
//
// Scale space: an image smoothed more and more is an image of one dimension more, whose last axis is the scale. Its
// layers are computed when they are read.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "tegl/filter.hpp"
#include "tegl/image.hpp"
#include "tegl/layers.hpp"

namespace tegl {

/// The quantity in a scale space. values: the smoothed samples; laplacian: minus the sum over the axes of sigma^2 times
/// the second difference (sigma in samples), which is greatest in the middle of bright blobs and at their scale: for a
/// ball of radius r in n dimensions, sigma^2 = r^2 / n.
enum class ScaleQuantity : std::uint8_t { values, laplacian };

/// Options of ScaleSpaceLayers.
struct ScaleSpaceOptions {
  ScaleQuantity quantity = ScaleQuantity::values;  ///< what the samples of a layer are
  /// By axis: sigma along it as a multiple of the scale; 0 for an axis that is not smoothed, such as the time. Empty: 1
  /// for all.
  std::vector<double> factors = {};
  bool in_samples = false;    ///< whether sigmas count samples, not units of the axes
  FilterOptions filter = {};  ///< borders, missing samples, threads; progress is called for each layer
};

/// `count` sigmas from `first` to `last` with a constant quotient. Errors: InvalidArgument unless both are positive,
/// finite and different, and `count` is at least 2.
[[nodiscard]] std::vector<double> scale_sigmas(double first, double last, std::size_t count);
/// The axis of a scale space: named log2_sigma, with the base-2 logarithms of the sigmas as coordinates: one unit is
/// one octave. Uniform if the sigmas have a constant quotient up to rounding. Errors: InvalidArgument unless the sigmas
/// are positive, finite and ascending.
[[nodiscard]] Axis scale_axis(std::span<const double> sigmas);

namespace detail {
/// Sigmas in samples along each axis for one scale. Errors: InvalidArgument.
[[nodiscard]] std::vector<double> scaled_sigmas(double sigma, std::span<const double> in_samples);
template <class Real>
void scale_space_layer(const FilterSamples& samples, std::span<const double> sigmas, ScaleQuantity quantity,
                       const FilterOptions& options, Real* out);
void require_factors(std::span<const double> factors, std::size_t axes);
/// Throws InvalidArgument if an axis whose factor is not 0 has uneven steps.
void require_even_steps(std::span<const Axis> axes, std::span<const double> factors);
}  // namespace detail

/// The scale space of an image as layers along a last axis, the scale_axis: layer k is the image smoothed by the
/// discrete Gaussian (discrete_gaussian_weights) of sigmas[k], in the units of the axes. Each layer is computed from
/// the image when it is read, so layers may be read in any order, and have the same bits. `extract_streamed` reads them
/// for a contour in 3D or 4D; `all` gives an image in memory for 5D.
///
/// N = 2, 3, 4. The image must outlive this object. Memory: that of filter_image for one layer. Errors: InvalidArgument
/// (sigmas, factors, and those of filter_image and sigmas_in_samples).
template <Value T, int N>
requires DimensionBetween<N, 2, 4>
class ScaleSpaceLayers final : public LayerReader<FilteredValue<T>, N + 1> {
 public:
  using Real = FilteredValue<T>;  ///< the type of a sample

  /// Layers of `image` at these scales, ascending.
  ScaleSpaceLayers(const Image<T, N>& image, std::vector<double> sigmas, ScaleSpaceOptions options = {})
      : samples_(detail::samples_of(image)), sigmas_(std::move(sigmas)), options_(std::move(options)) {
    if (options_.factors.empty()) options_.factors.assign(N, 1.0);
    detail::require_factors(options_.factors, N);
    for (int a = 0; a < N; ++a) grid_.axes[a] = image.grid().axes[a];
    grid_.axes[N] = scale_axis(sigmas_);
    for (int row = 0; row < N; ++row) {
      for (int column = 0; column < N; ++column) grid_.linear[row][column] = image.grid().linear[row][column];
      grid_.offset[row] = image.grid().offset[row];
    }
    std::array<double, N> unit{};
    for (int a = 0; a < N; ++a) unit[a] = options_.factors[a];
    if (!options_.in_samples) {
      detail::require_even_steps(image.grid().axes, options_.factors);
      unit = sigmas_in_samples<N>(image.grid(), unit);
    }
    in_samples_.assign(unit.begin(), unit.end());
  }

  /// Grid of the scale space.
  [[nodiscard]] const Grid<N + 1>& grid() const noexcept override { return grid_; }
  /// The scales.
  [[nodiscard]] const std::vector<double>& sigmas() const noexcept { return sigmas_; }
  /// Computes layer k: axis 0 fastest, the product of the image's sizes in values.
  void read(std::size_t k, Real* to) override {
    detail::scale_space_layer(samples_, detail::scaled_sigmas(sigmas_.at(k), in_samples_), options_.quantity,
                              options_.filter, to);
  }
  /// All layers in memory.
  [[nodiscard]] OwnedImage<Real, N + 1> all() {
    std::size_t size = 1;
    for (const std::size_t along : samples_.sizes) size *= along;
    detail::ValueVector<Real> values;
    values.resize(size * sigmas_.size());
    for (std::size_t k = 0; k < sigmas_.size(); ++k) read(k, values.data() + k * size);
    return {grid_, std::move(values)};
  }

 private:
  detail::FilterSamples samples_;
  std::vector<double> sigmas_;
  ScaleSpaceOptions options_;
  Grid<N + 1> grid_ = {};
  std::vector<double> in_samples_;
};

/// Where a quantity changes least with the logarithm of sigma.
struct StableScale {
  std::size_t layer = 0;  ///< number of the scale
  double sigma = 0;       ///< its sigma
  double change = 0;      ///< d ln(measure) / d ln(sigma) there
};

/// The most stable scale: the inner one of at least three at which |d ln(measure) / d ln(sigma)| is least, by the
/// difference of the neighbouring scales; the first of several. `measures`: such as the area of the contour at each
/// scale. Scales with a neighbour of measure 0 do not count; without any other, layer is 0 and sigma 0. Errors:
/// InvalidArgument if the lists differ in length or a sigma is not positive.
[[nodiscard]] StableScale most_stable_scale(std::span<const double> sigmas, std::span<const double> measures);

}  // namespace tegl
