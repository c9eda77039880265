// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at samples by kernels over all neighbours: the derivative along an axis is a weighted mean of difference
// quotients on the sample's line and on all adjacent lines. This damps noise, and also details of the size of a sample.
//
// Based on: M. Liversage, thesis, 1994, sections 8.2.14 (3D: weights 2 3 2 / 3 6 3 / 2 3 2, divided by 52), 9.1.8 (2D:
// 1 2 1, divided by 8) and 8.2.15 (8.5: the kernel's forward and backward halves, each divided by its own distance).
// Both sets of weights are proportional to 1 / (1 + d), where d is the number of other axes in which a line is
// displaced: the inverse square of the distance, in steps, between the sample and the kernel's other samples. This rule
// gives 12 6 4 3 in 4D, divided by 240.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

#include "image/gradient.hpp"
#include "tegl/error.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Weights of the difference quotients on the lines along each axis, by axis and line number.
template <int N>
struct LineKernel {
  static constexpr std::size_t kLines = power_of_3(N - 1);
  struct Weights {
    double backward = 0.0;
    double forward = 0.0;
  };
  std::array<std::array<Weights, kLines>, N> lines{};

  /// The index of the middle of a line along an axis with 3^axis = `stride`: insert the digit 1 at the axis.
  static constexpr std::size_t middle(std::size_t line, std::size_t stride) noexcept {
    return line % stride + stride + line / stride * (3 * stride);
  }
  /// Number of other axes in which a line is displaced.
  static constexpr int displacement(std::size_t line) noexcept {
    int away = 0;
    for (std::size_t rest = line, a = 0; a + 1 < N; ++a, rest /= 3) away += rest % 3 == 1 ? 0 : 1;
    return away;
  }
};

/// The kernel whose lines have the weight `weight_of(displacement)`, on both sides, divided by their sum.
template <int N, class WeightOf>
LineKernel<N> symmetric_kernel(const WeightOf& weight_of) {
  LineKernel<N> kernel;
  double sum = 0.0;
  for (std::size_t line = 0; line < LineKernel<N>::kLines; ++line) sum += weight_of(LineKernel<N>::displacement(line));
  for (auto& lines : kernel.lines)
    for (std::size_t line = 0; line < lines.size(); ++line) {
      const double weight = weight_of(LineKernel<N>::displacement(line)) / sum;
      lines[line] = {weight, weight};
    }
  return kernel;
}

/// The caller's kernel. Throws InvalidArgument, see GradientKernel.
template <int N>
LineKernel<N> line_kernel_of(const GradientKernel& given) {
  constexpr std::size_t kSize = power_of_3(N);
  const bool has_all = given.weights.size() == N * kSize;
  if (!has_all && given.weights.size() != kSize)
    throw Error(ErrorCode::InvalidArgument, fmt::format("kernel of {} weights; expected {}, or {} for each of {} axes",
                                                        given.weights.size(), kSize, kSize, N));
  for (const double weight : given.weights)
    if (!std::isfinite(weight))
      throw Error(ErrorCode::InvalidArgument, fmt::format("kernel with the weight {}; expected finite ones", weight));
  LineKernel<N> kernel;
  std::size_t stride = 1;
  for (int a = 0; a < N; ++a, stride *= 3) {
    // digits of an index of the kernel along axis 0: those at 0 and a are exchanged
    const auto at = [&](std::size_t i) {
      if (has_all) return given.weights[static_cast<std::size_t>(a) * kSize + i];
      const std::size_t first = i % 3, other = i / stride % 3;
      return given.weights[i - first - other * stride + other + first * stride];
    };
    double sum = 0.0, largest = 0.0;
    for (std::size_t line = 0; line < LineKernel<N>::kLines; ++line) {
      const std::size_t middle = LineKernel<N>::middle(line, stride);
      const double behind = at(middle - stride), here = at(middle), ahead = at(middle + stride);
      const double size = std::max({std::abs(behind), std::abs(here), std::abs(ahead)});
      if (std::abs(behind + here + ahead) > 1e-12 * size)
        throw Error(ErrorCode::InvalidArgument,
                    fmt::format("kernel with the weights {}, {}, {} on a line along axis {}; expected 0 as their sum",
                                behind, here, ahead, a));
      kernel.lines[a][line] = {-behind, ahead};
      sum += ahead - behind;
      largest = std::max(largest, size);
    }
    if (!(std::abs(sum) > 1e-12 * largest))
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("kernel whose differences along axis {} have weights that sum to {}; expected another sum", a,
                      sum));
    for (auto& weights : kernel.lines[a]) weights = {weights.backward / sum, weights.forward / sum};
  }
  return kernel;
}

/// The kernel of a kind of normals. Throws InvalidArgument.
template <int N>
LineKernel<N> line_kernel_of(Normals kind, const GradientKernel& given) {
  if (kind == Normals::kernel) return line_kernel_of<N>(given);
  if (kind == Normals::sobel) return symmetric_kernel<N>([](int away) { return 1.0 / (1 + away); });
  if (kind == Normals::prewitt) return symmetric_kernel<N>([](int) { return 1.0; });
  LineKernel<N> kernel;
  for (auto& lines : kernel.lines)
    lines[LineKernel<N>::kLines / 2] = {kind == Normals::backward ? 1.0 : 0.0, kind == Normals::forward ? 1.0 : 0.0};
  return kernel;
}

/// The gradient in axis coordinates. Each line has its own difference quotients; if one of them is not finite, the
/// other takes its weight. Lines outside the image or without finite differences are omitted, and the remaining
/// weights are normalised: a linear field has its exact slope everywhere.
template <int N>
std::array<double, N> kernel_gradient(const LineKernel<N>& kernel, const ValuesAround<N>& values,
                                      const std::array<StepWeights, N>& steps) noexcept {
  std::array<double, N> gradient{};
  std::size_t stride = 1;
  for (int a = 0; a < N; ++a, stride *= 3) {
    double sum = 0.0;
    double present = 0.0;
    for (std::size_t line = 0; line < LineKernel<N>::kLines; ++line) {
      const auto [backward, forward] = kernel.lines[a][line];
      const double weight = backward + forward;
      if (weight == 0.0 && backward == 0.0) continue;
      const std::size_t middle = LineKernel<N>::middle(line, stride);
      const double here = values[middle];
      // A weight of 0 means that there is no neighbour.
      const double behind = steps[a].backward == 0.0 ? here : values[middle - stride];
      const double ahead = steps[a].forward == 0.0 ? here : values[middle + stride];
      const bool knows_back = steps[a].backward != 0.0 && std::isfinite(here - behind);
      const bool knows_ahead = steps[a].forward != 0.0 && std::isfinite(ahead - here);
      if (!knows_back && !knows_ahead) continue;
      if (backward == forward || !knows_back || !knows_ahead) {
        sum += weight * derivative(behind, here, ahead, steps[a]);
      } else {
        // steps are halved where there are two
        sum += 2.0 * (backward * (here - behind) * steps[a].backward + forward * (ahead - here) * steps[a].forward);
      }
      present += weight;
    }
    gradient[a] = present != 0.0 ? sum / present : 0.0;
  }
  return gradient;
}

}  // namespace tegl::detail
