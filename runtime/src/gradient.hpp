// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients of images at samples, and along edges between them: what the normals of contours are made of.
// Based on: M. Liversage, thesis, 1994, section 8.2: differences on non-regular axes (8.4), of which central
// differences on regular ones (8.3) are the special case; interpolation along the edge.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tegl/image.hpp"

namespace tegl::detail {

/// Gradients, whatever the type of the samples.
template <int N>
class GradientField {
 public:
  using Index = std::array<std::size_t, N>;
  using Vector = std::array<double, N>;
  GradientField() = default;
  GradientField(const GradientField&) = delete;
  GradientField& operator=(const GradientField&) = delete;
  virtual ~GradientField() = default;

  /// At one sample.
  [[nodiscard]] virtual Vector at(const Index& index) const noexcept = 0;

  /// On the edges along `axis` from the samples `from` of the row through `start` (start[0] = 0), `count` of them: the
  /// gradients at both ends, interpolated with `alphas`.
  virtual void on_edges(Index start, int axis, const std::uint32_t* from, std::size_t count, const double* alphas,
                        Vector* out) const noexcept = 0;
};

/// The gradient of an image by axis coordinates (before the map to the world): along each axis the mean of the forward
/// and the backward difference quotient. At the border, and where a sample is missing or a difference not finite, the
/// one that there is; 0 if there is none. The samples must outlive it.
template <Value T, int N>
class Gradient final : public GradientField<N> {
 public:
  using typename GradientField<N>::Index;
  using typename GradientField<N>::Vector;

  Gradient(const T* data, const typename Image<T, N>::Strides& strides, const Grid<N>& grid)
      : data_(data), strides_(strides) {
    for (int a = 0; a < N; ++a) {
      const Axis& axis = grid.axes[a];
      inverse_steps_[a].resize(axis.size() - 1);
      for (std::size_t i = 0; i + 1 < axis.size(); ++i) inverse_steps_[a][i] = 1.0 / (axis[i + 1] - axis[i]);
    }
  }

  [[nodiscard]] Vector at(const Index& index) const noexcept override {
    const T* const sample = place(index);
    Vector result;
    for (int a = 0; a < N; ++a) {
      const Axial axial = axial_at(a, index[a]);
      result[a] = difference(static_cast<double>(*sample), sample, axial);
    }
    return result;
  }

  void on_edges(Index start, int axis, const std::uint32_t* from, std::size_t count, const double* alphas,
                Vector* out) const noexcept override {
    const T* const row = place(start);
    // What differs along the row is found for each sample; what does not, once.
    std::array<Axial, N> first, second;
    for (int a = 1; a < N; ++a) {
      first[a] = axial_at(a, start[a]);
      second[a] = a == axis ? axial_at(a, start[a] + 1) : first[a];
    }
    for (std::size_t i = 0; i < count; ++i) {
      first[0] = axial_at(0, from[i]);
      second[0] = axis == 0 ? axial_at(0, from[i] + 1) : first[0];
      const T* const sample = row + static_cast<std::ptrdiff_t>(from[i]) * strides_[0];
      const T* const next = sample + strides_[axis];
      const auto value = static_cast<double>(*sample);
      const auto next_value = static_cast<double>(*next);
      for (int a = 0; a < N; ++a) {
        const double here = difference(value, sample, first[a]);
        const double there = difference(next_value, next, second[a]);
        out[i][a] = here + alphas[i] * (there - here);
      }
    }
  }

 private:
  /// Where a sample has its neighbours along an axis: the next or the sample itself; 1 / distance, with the weight of
  /// the difference in the mean.
  struct Axial {
    std::ptrdiff_t forward;
    std::ptrdiff_t backward;
    double forward_weight;
    double backward_weight;
  };

  [[nodiscard]] const T* place(const Index& index) const noexcept {
    std::ptrdiff_t at = 0;
    for (int a = 0; a < N; ++a) at += static_cast<std::ptrdiff_t>(index[a]) * strides_[a];
    return data_ + at;
  }

  [[nodiscard]] Axial axial_at(int axis, std::size_t i) const noexcept {
    const std::vector<double>& steps = inverse_steps_[axis];
    const bool ahead = i < steps.size();
    const bool behind = i > 0;
    const double weight = ahead && behind ? 0.5 : 1.0;
    return {ahead ? strides_[axis] : 0, behind ? -strides_[axis] : 0, ahead ? weight * steps[i] : 0.0,
            behind ? weight * steps[i - 1] : 0.0};
  }

  [[nodiscard]] static double difference(double value, const T* sample, const Axial& axial) noexcept {
    const double forward = (static_cast<double>(sample[axial.forward]) - value) * axial.forward_weight;
    const double backward = (value - static_cast<double>(sample[axial.backward])) * axial.backward_weight;
    const double sum = forward + backward;
    if constexpr (std::is_floating_point_v<T>)
      if (!std::isfinite(sum)) return one_sided(forward, backward);
    return sum;
  }

  /// Where both are finite but not their sum, the field is too steep to say more.
  static double one_sided(double forward, double backward) noexcept {
    if (std::isfinite(forward) && !std::isfinite(backward)) return 2.0 * forward;
    if (std::isfinite(backward) && !std::isfinite(forward)) return 2.0 * backward;
    return 0.0;
  }

  const T* data_;
  typename Image<T, N>::Strides strides_;
  std::array<std::vector<double>, N> inverse_steps_;
};

}  // namespace tegl::detail
