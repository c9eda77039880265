// SPDX-License-Identifier: BSD-3-Clause
//
// Weights of one-dimensional smoothing kernels, and sigmas in samples.
//
// Based on: T. Lindeberg, Scale-space for discrete signals, IEEE PAMI 12, 1990; the backward recurrence of Bessel
// functions by J. C. P. Miller (W. Gautschi, Computational aspects of three-term recurrence relations, 1967).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tegl/filter.hpp"

namespace tegl {

namespace {

/// Longest kernel: 2 kMostRadius + 1 weights.
constexpr double kMostRadius = 100000;

void require_sigma(double sigma, double most) {
  if (!(sigma >= 0) || sigma > most)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("sigma is {} samples; expected a number from 0 to {}", sigma, most));
}

/// The weights w(0), w(1), ... on both sides, divided by their sum.
AxisWeights mirrored(const std::vector<double>& half) {
  double sum = 0;
  for (std::size_t i = half.size(); i-- > 1;) sum += 2 * half[i];
  sum += half[0];
  const std::size_t radius = half.size() - 1;
  AxisWeights weights(2 * radius + 1);
  for (std::size_t i = 0; i <= radius; ++i) weights[radius - i] = weights[radius + i] = half[i] / sum;
  return weights;
}

}  // namespace

AxisWeights gaussian_weights(double sigma, double truncate) {
  require_sigma(sigma, kMostRadius / 4);
  if (!(truncate > 0) || truncate > 40)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("the Gaussian is truncated at {} sigma; expected more than 0, at most 40", truncate));
  const double radius = std::floor(truncate * sigma + 0.5);
  std::vector<double> half;
  for (double i = 0; i <= std::min(radius, kMostRadius); ++i)
    half.push_back(i == 0 ? 1.0 : std::exp(-0.5 * (i / sigma) * (i / sigma)));
  return mirrored(half);
}

AxisWeights discrete_gaussian_weights(double sigma) {
  require_sigma(sigma, kMostRadius / 10);
  const double t = sigma * sigma;
  if (t < 1e-8) return {1.0};  // less than the remainder that is dropped below
  // Miller's recurrence I_(k-1) = I_(k+1) + (2 k / t) I_k, downwards from where I_k is negligible; scaled by
  // e^t = I_0 + 2 I_1 + 2 I_2 + ..., which `mirrored` divides by.
  const auto start = static_cast<std::size_t>(std::ceil(t + 12 * sigma + 20));
  const std::size_t top = std::min(start, static_cast<std::size_t>(std::ceil(12 * sigma + 30)));
  std::vector<double> half(top + 1);
  double above = 0;
  double here = 1e-300;
  for (std::size_t k = top; k > 0; --k) {
    half[k] = here;
    const double below = above + 2 * static_cast<double>(k) / t * here;
    above = here;
    here = below;
    if (here > 1e250) {
      for (std::size_t i = k; i <= top; ++i) half[i] *= 1e-250;
      above *= 1e-250;
      here *= 1e-250;
    }
  }
  half[0] = here;
  // drop the remainder
  double sum = half[0];
  for (std::size_t k = 1; k <= top; ++k) sum += 2 * half[k];
  constexpr double kRemainder = 1e-7;
  double dropped = 0;
  while (half.size() > 1 && dropped + 2 * half.back() < kRemainder * sum) {
    dropped += 2 * half.back();
    half.pop_back();
  }
  return mirrored(half);
}

AxisWeights binomial_weights(double sigma) {
  constexpr double kMostSigma = 100;
  require_sigma(sigma, kMostSigma);
  const auto half_order = static_cast<std::size_t>(std::llround(2 * sigma * sigma));
  std::vector<double> half = {1.0};
  for (std::size_t i = 1; i <= half_order; ++i)
    half.push_back(half.back() * static_cast<double>(half_order - i + 1) / static_cast<double>(half_order + i));
  while (half.size() > 1 && half.back() < 1e-30) half.pop_back();
  return mirrored(half);
}

template <int N>
std::array<double, N> sigmas_in_samples(const Grid<N>& grid, const std::array<double, N>& sigmas) {
  std::array<double, N> result{};
  for (int a = 0; a < N; ++a) {
    if (sigmas[a] == 0) continue;
    if (!grid.axes[a].is_uniform())
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("sigma is {} along axis {} '{}', whose steps differ; expected a sigma in samples for it",
                              sigmas[a], a, grid.axes[a].name));
    double square = 0;
    for (int row = 0; row < N; ++row) square += grid.linear[row][a] * grid.linear[row][a];
    result[a] = sigmas[a] / (std::abs(grid.axes[a].step()) * std::sqrt(square));
  }
  return result;
}
template std::array<double, 2> sigmas_in_samples<2>(const Grid<2>&, const std::array<double, 2>&);
template std::array<double, 3> sigmas_in_samples<3>(const Grid<3>&, const std::array<double, 3>&);
template std::array<double, 4> sigmas_in_samples<4>(const Grid<4>&, const std::array<double, 4>&);
template std::array<double, 5> sigmas_in_samples<5>(const Grid<5>&, const std::array<double, 5>&);

}  // namespace tegl
