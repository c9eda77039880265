// SPDX-License-Identifier: BSD-3-Clause
//
// Images for tests of divisions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "complex/complex_cases.hpp"
#include "tegl/division.hpp"

namespace tegl::test {

/// An image of samples^N over [-1, 1]^N.
template <int N, class F>
OwnedImage<double, N> sampled(std::size_t samples, F f) {
  OwnedImage<double, N> image;
  std::size_t count = 1;
  for (Axis& axis : image.grid.axes) {
    axis = Axis::uniform(samples, -1.0, 2.0 / static_cast<double>(samples - 1));
    count *= samples;
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, N> x;
    for (std::size_t a = 0, rest = i; a < N; ++a, rest /= samples) x[a] = image.grid.axes[a][rest % samples];
    image.values.push_back(f(x));
  }
  return image;
}

/// Noise, low at the border.
template <int N>
OwnedImage<double, N> noise(std::size_t samples, unsigned seed) {
  return sampled<N>(samples, [random = std::mt19937(seed)](const std::array<double, N>& x) mutable {
    const double value = std::uniform_real_distribution<double>()(random);
    return std::all_of(x.begin(), x.end(), [](double each) { return std::abs(each) < 0.999; }) ? value : 0.0;
  });
}

}  // namespace tegl::test
