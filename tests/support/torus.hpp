// SPDX-License-Identifier: BSD-3-Clause
//
// Images on tori: fields with the period 1 along all axes.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

#include "tegl/check.hpp"
#include "tegl/image.hpp"
#include "tegl/periodic.hpp"

namespace tegl::test {

inline constexpr double kTurn = 2.0 * std::numbers::pi;

/// Samples of f(x) with x in [0, 1)^N, at multiples of the steps, moved by `shift` samples along all axes.
template <int N, class T = float, class F>
OwnedImage<T, N> torus_image(const std::array<std::size_t, N>& sizes, const F& f, std::size_t shift = 0) {
  OwnedImage<T, N> image;
  std::size_t count = 1;
  for (int a = 0; a < N; ++a) {
    image.grid.axes[a] = Axis::uniform(sizes[a], 0.0, 1.0 / static_cast<double>(sizes[a]));
    count *= sizes[a];
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, N> x;
    std::size_t rest = i;
    for (int a = 0; a < N; ++a) {
      x[a] = static_cast<double>((rest % sizes[a] + shift) % sizes[a]) / static_cast<double>(sizes[a]);
      rest /= sizes[a];
    }
    image.values.push_back(static_cast<T>(f(x)));
  }
  return image;
}

template <int N>
AxisPeriods<N> all_periodic() {
  AxisPeriods<N> periods;
  periods.fill(1.0);
  return periods;
}

/// For each axis whether it is periodic, by the bits of `axes`.
template <int N>
AxisPeriods<N> periodic_along(unsigned axes) {
  AxisPeriods<N> periods{};
  for (int a = 0; a < N; ++a) periods[a] = (axes >> a & 1u) != 0 ? 1.0 : 0.0;
  return periods;
}

inline double gyroid(const std::array<double, 3>& x) {
  const auto s = [&](int a) { return std::sin(kTurn * x[a]); };
  const auto c = [&](int a) { return std::cos(kTurn * x[a]); };
  return s(0) * c(1) + s(1) * c(2) + s(2) * c(0);
}

/// A field of noise by the sample's place.
template <int N>
auto noise_of(unsigned seed) {
  return [seed](const std::array<double, N>& x) {
    std::uint64_t state = seed;
    for (const double each : x) state = state * 6364136223846793005u + static_cast<std::uint64_t>(each * 4096.0) + 1;
    std::mt19937_64 random(state);
    return std::uniform_real_distribution<double>(-1.0, 1.0)(random);
  };
}

inline bool is_manifold(const MeshReport& report) {
  return report.nonmanifold_simplices == 0 && report.bad_links == 0 && report.orientation_conflicts == 0;
}
inline bool is_closed(const MeshReport& report) { return is_manifold(report) && report.boundary_simplices == 0; }

/// The wrapped contour of an image, which may be a temporary.
template <class Real = float, class T, int N>
Contour<N, Real> wrapped(const OwnedImage<T, N>& image, const AxisPeriods<N>& periods, double isovalue,
                         const ExtractOptions& options = {}) {
  return extract_periodic<Real>(image.view(), periods, isovalue, options);
}

}  // namespace tegl::test
