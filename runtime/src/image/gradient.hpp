// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients of images at samples: weights of the differences between neighbours, and the values from which the
// gradients along an edge are computed.
// Based on: M. Liversage, thesis, 1994, section 8.2: differences on non-regular axes (8.4), of which central
// differences on regular ones (8.3) are the special case; interpolation along the edge. Unlike there (5.4.2),
// differences are one-sided at the border.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "tegl/grid.hpp"

namespace tegl::detail {

/// Weights of the differences to both neighbours of a sample: 1 / distance, times the weight of the quotient in their
/// mean. 0 if there is no neighbour.
struct StepWeights {
  double backward = 0.0;
  double forward = 0.0;
};

/// The weights along one axis.
class AxisSteps {
 public:
  /// For the samples from `first` on, which are a part of the axis.
  explicit AxisSteps(const Axis& axis, std::size_t first = 0)
      : first_(first), size_(axis.size()), is_uniform_(axis.is_uniform()) {
    if (is_uniform_) {
      inverse_ = 1.0 / axis.step();
      return;
    }
    for (std::size_t i = 0; i + 1 < size_; ++i) inverses_.push_back(1.0 / (axis[i + 1] - axis[i]));
  }

  [[nodiscard]] bool is_uniform() const noexcept { return is_uniform_; }
  [[nodiscard]] bool has_backward(std::size_t i) const noexcept { return first_ + i > 0; }
  [[nodiscard]] bool has_forward(std::size_t i) const noexcept { return first_ + i + 1 < size_; }
  [[nodiscard]] StepWeights at(std::size_t i) const noexcept {
    const bool back = has_backward(i);
    const bool ahead = has_forward(i);
    const double share = back && ahead ? 0.5 : 1.0;
    return {back ? share * inverse(first_ + i - 1) : 0.0, ahead ? share * inverse(first_ + i) : 0.0};
  }
  /// Weights of a sample with two neighbours on a uniform axis.
  [[nodiscard]] StepWeights inside() const noexcept { return {0.5 * inverse_, 0.5 * inverse_}; }

 private:
  [[nodiscard]] double inverse(std::size_t i) const noexcept { return is_uniform_ ? inverse_ : inverses_[i]; }

  std::size_t first_;
  std::size_t size_;
  bool is_uniform_;
  double inverse_ = 0.0;
  std::vector<double> inverses_;  ///< 1 / distance between i and i + 1; empty if uniform
};

/// The derivative along an axis in axis coordinates (before the map to the world): the mean of the difference quotients
/// to both sides. If one of them is not finite (a missing or infinite sample), the other one; 0 if neither is finite.
/// The result is always finite and bounded, so that sums of derivatives are not NaN.
inline double derivative(double backward, double value, double forward, const StepWeights& weights) noexcept {
  const double ahead = (forward - value) * weights.forward;
  const double back = (value - backward) * weights.backward;
  if (std::isfinite(ahead + back)) return ahead + back;
  constexpr double kHalf = std::numeric_limits<double>::max() / 2;
  if (std::isfinite(ahead) && !std::isfinite(back)) return 2.0 * std::clamp(ahead, -kHalf, kHalf);
  if (std::isfinite(back) && !std::isfinite(ahead)) return 2.0 * std::clamp(back, -kHalf, kHalf);
  return 0.0;  // both finite, their sum is not: too steep for a derivative
}

/// 3^k.
constexpr std::size_t power_of_3(int k) noexcept { return k == 0 ? 1 : 3 * power_of_3(k - 1); }

/// Values of a sample and its neighbours: 3^N, index sum_a (1 + offset_a) 3^a. NaN outside the image.
template <int N>
using ValuesAround = std::array<double, power_of_3(N)>;

/// Number of values from which the gradients at both ends of an edge are computed. Place 4 a + (0 ... 3): backward and
/// forward neighbour of the first end along axis a, then of the second end; an end without a neighbour is used itself.
/// Along the edge's own axis, the forward neighbour of the first end is the second end, and vice versa.
template <int N>
inline constexpr unsigned kEdgeValues = 4 * N;

/// Common properties of edges along `axis` that start in rows of one layer: which neighbours of their ends exist.
/// (Along the row this differs between samples.)
template <int N>
struct EdgeSurroundings {
  std::size_t layer;
  int axis;
  std::array<std::array<bool, 4>, N> exists;  ///< by axis from 1 on: neighbours 0 ... 3
};

/// Number of edges processed at a time.
inline constexpr std::size_t kEdgesAtOnce = 64;

}  // namespace tegl::detail
