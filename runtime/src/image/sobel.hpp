// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at samples by the n-dimensional Sobel kernel: the derivative along an axis is the weighted mean of the
// derivatives on the sample's line and on all adjacent lines. This damps noise, and also details of the size of a
// sample.
//
// Based on: M. Liversage, thesis, 1994, sections 8.2.14 (3D: weights 2 3 2 / 3 6 3 / 2 3 2, divided by 52), 9.1.8 (2D:
// 1 2 1, divided by 8) and 8.2.15 (8.5: the kernel's forward and backward halves, each divided by its own distance).
// Both sets of weights are proportional to 1 / (1 + d), where d is the number of other axes in which a line is
// displaced: the inverse square of the distance, in steps, between the sample and the kernel's other samples. This rule
// gives 12 6 4 3 in 4D, divided by 240.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "image/gradient.hpp"

namespace tegl::detail {

/// 3^k.
constexpr std::size_t power_of_3(int k) noexcept { return k == 0 ? 1 : 3 * power_of_3(k - 1); }

/// Values of a sample and its neighbours: 3^N, index sum_a (1 + offset_a) 3^a. NaN outside the image.
template <int N>
using Neighbourhood = std::array<double, power_of_3(N)>;

/// Weights of the lines along an axis, by line number; their sum is 1.
template <int N>
inline constexpr std::array<double, power_of_3(N - 1)> kLineWeights = [] {
  std::array<double, power_of_3(N - 1)> weights{};
  double sum = 0.0;
  for (std::size_t line = 0; line < weights.size(); ++line) {
    int away = 0;
    for (std::size_t rest = line, a = 0; a + 1 < N; ++a, rest /= 3) away += rest % 3 == 1 ? 0 : 1;
    weights[line] = 1.0 / (1 + away);
    sum += weights[line];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}();

/// The Sobel gradient in axis coordinates. Each line has its own difference quotients (`derivative`). Lines outside the
/// image or without finite differences are omitted, and the remaining weights are normalised: a linear field has its
/// exact slope everywhere.
template <int N>
std::array<double, N> sobel_gradient(const Neighbourhood<N>& values, const std::array<StepWeights, N>& steps) noexcept {
  std::array<double, N> gradient{};
  std::size_t stride = 1;
  for (int a = 0; a < N; ++a, stride *= 3) {
    double sum = 0.0;
    double present = 0.0;
    for (std::size_t line = 0; line < kLineWeights<N>.size(); ++line) {
      // The middle of the line: insert the digit 1 at position a.
      const std::size_t middle = line % stride + stride + line / stride * (3 * stride);
      const double here = values[middle];
      // A weight of 0 means that there is no neighbour.
      const double behind = steps[a].backward == 0.0 ? here : values[middle - stride];
      const double ahead = steps[a].forward == 0.0 ? here : values[middle + stride];
      const bool knows = (steps[a].backward != 0.0 && std::isfinite(here - behind)) ||
                         (steps[a].forward != 0.0 && std::isfinite(ahead - here));
      if (!knows) continue;
      sum += kLineWeights<N>[line] * derivative(behind, here, ahead, steps[a]);
      present += kLineWeights<N>[line];
    }
    gradient[a] = present > 0.0 ? sum / present : 0.0;
  }
  return gradient;
}

}  // namespace tegl::detail
