// SPDX-License-Identifier: BSD-3-Clause
//
// Test images: analytic fields whose contours have known topology and measure, and seeded noise.
//
// A field is a function object from a position (std::array<double, N>) to a double, positive inside. `sample_field`
// samples it on a grid. Positions are axis coordinates, before the grid's world map. Noise depends only on its seed:
// the bits come from std::mt19937_64, which the standard specifies, and code below converts them to values, because the
// standard distributions differ between libraries.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "tegl/image.hpp"
#include "view_of.hpp"

namespace tegl::test {

template <int N>
using Point = std::array<double, N>;

/// The value of type T nearest to a real number: rounded and clamped for integers.
template <Value T>
T value_cast(double value) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(value);
  } else {
    constexpr auto lowest = static_cast<double>(std::numeric_limits<T>::lowest());
    constexpr auto highest = static_cast<double>(std::numeric_limits<T>::max());
    return static_cast<T>(std::clamp(std::nearbyint(value), lowest, highest));
  }
}

/// The number of samples of a grid.
template <int N>
std::size_t sample_count(const Grid<N>& grid) {
  std::size_t count = 1;
  for (const Axis& axis : grid.axes) count *= axis.size();
  return count;
}

/// Calls visit(linear index, index) for every sample, axis 0 fastest.
template <int N, class Visit>
void for_each_sample(const Grid<N>& grid, Visit&& visit) {
  std::array<std::size_t, N> index{};
  const std::size_t count = sample_count(grid);
  for (std::size_t i = 0; i < count; ++i) {
    visit(i, index);
    for (int a = 0; a < N && ++index[a] == grid.axes[a].size(); ++a) index[a] = 0;
  }
}

/// Samples scale * field + shift on a grid; scale and shift map a field to an integer type's range.
template <Value T, int N, class Field>
OwnedImage<T, N> sample_field(const Grid<N>& grid, const Field& field, double scale = 1.0, double shift = 0.0) {
  OwnedImage<T, N> image{grid, std::vector<T>(sample_count(grid))};
  for_each_sample<N>(grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    Point<N> x;
    for (int a = 0; a < N; ++a) x[a] = grid.axes[a][index[a]];
    image.values[i] = value_cast<T>(scale * field(x) + shift);
  });
  return image;
}

/// A grid of `samples` samples along every axis, from -half_width to half_width.
template <int N>
Grid<N> centred_grid(std::size_t samples, double half_width) {
  Grid<N> grid;
  for (Axis& axis : grid.axes)
    axis = Axis::uniform(samples, -half_width, 2.0 * half_width / static_cast<double>(samples - 1));
  return grid;
}

// ---- analytic fields ----

/// Radius minus distance from the centre. Contour at 0: a sphere S^(N-1).
template <int N>
struct Ball {
  Point<N> centre{};
  double radius = 1.0;

  double operator()(const Point<N>& x) const {
    double square = 0.0;
    for (int a = 0; a < N; ++a) square += (x[a] - centre[a]) * (x[a] - centre[a]);
    return radius - std::sqrt(square);
  }
  /// Length, area or volume of the sphere (4-dimensional volume for N = 5).
  [[nodiscard]] double surface() const {
    constexpr double kPi = std::numbers::pi;
    if constexpr (N == 2) return 2.0 * kPi * radius;
    if constexpr (N == 3) return 4.0 * kPi * radius * radius;
    if constexpr (N == 4) return 2.0 * kPi * kPi * radius * radius * radius;
    if constexpr (N == 5) return 8.0 / 3.0 * kPi * kPi * radius * radius * radius * radius;
  }
  /// Enclosed area or volume.
  [[nodiscard]] double content() const { return surface() * radius / N; }
};

/// A tube of radius `tube` around the circle of radius `ring` in the x-y plane: a torus for N = 3 (Euler characteristic
/// 0), S^1 x S^2 for N = 4 (0).
template <int N>
requires(N == 3 || N == 4) struct RingTube {
  double ring = 1.0;
  double tube = 0.4;

  double operator()(const Point<N>& x) const {
    const double out = std::hypot(x[0], x[1]) - ring;
    double square = out * out;
    for (int a = 2; a < N; ++a) square += x[a] * x[a];
    return tube - std::sqrt(square);
  }
  [[nodiscard]] double surface() const {  // theorem of Pappus
    constexpr double kPi = std::numbers::pi;
    return 2.0 * kPi * ring * (N == 3 ? 2.0 * kPi * tube : 4.0 * kPi * tube * tube);
  }
  [[nodiscard]] double content() const { return surface() * tube / (N - 1); }
};

/// A tube around the 2-sphere of radius `ring` in x, y, z: S^2 x S^1 in 4-space, Euler characteristic 0.
struct SphereTube {
  double ring = 1.0;
  double tube = 0.4;

  double operator()(const Point<4>& x) const { return tube - std::hypot(std::hypot(x[0], x[1], x[2]) - ring, x[3]); }
  [[nodiscard]] double surface() const {
    constexpr double kPi = std::numbers::pi;
    return 4.0 * kPi * kPi * tube * (2.0 * ring * ring + tube * tube);
  }
};

/// A tube around the flat torus |(x, y)| = first, |(z, t)| = second: a 3-torus in 4-space, Euler characteristic 0.
struct TorusTube {
  double first = 1.0;
  double second = 1.0;
  double tube = 0.4;

  double operator()(const Point<4>& x) const {
    return tube - std::hypot(std::hypot(x[0], x[1]) - first, std::hypot(x[2], x[3]) - second);
  }
  [[nodiscard]] double surface() const {
    constexpr double kPi = std::numbers::pi;
    return 8.0 * kPi * kPi * kPi * first * second * tube;
  }
};

/// Two balls in N - 1 dimensions that approach each other along x as the last coordinate t grows: their centres are at
/// x = -d and x = +d with d = distance - speed * t. They touch at `event`; the slice has two components before (for N =
/// 4: Euler characteristic 4) and one after (2).
template <int N>
struct MergingBalls {
  double radius = 1.0;
  double distance = 2.0;
  double speed = 1.0;

  double operator()(const Point<N>& x) const {
    const double d = distance - speed * x[N - 1];
    double square = 0.0;
    for (int a = 1; a < N - 1; ++a) square += x[a] * x[a];
    const double nearest = std::abs(std::abs(x[0]) - std::abs(d));
    return radius - std::sqrt(square + nearest * nearest);
  }
  [[nodiscard]] double event() const { return (distance - radius) / speed; }
};

/// The gyroid and its cyclic sum in other dimensions: sum of sin(k x_a) cos(k x_{a+1}).
template <int N>
struct Gyroid {
  double frequency = 2.0 * std::numbers::pi;

  double operator()(const Point<N>& x) const {
    double sum = 0.0;
    for (int a = 0; a < N; ++a) sum += std::sin(frequency * x[a]) * std::cos(frequency * x[(a + 1) % N]);
    return sum;
  }
};

/// A sum of Gaussian bumps of one width; never negative. Typical isovalues lie between 0 and 1.
template <int N>
struct Metaballs {
  std::vector<Point<N>> centres;
  double width = 0.3;

  double operator()(const Point<N>& x) const {
    double sum = 0.0;
    for (const Point<N>& centre : centres) {
      double square = 0.0;
      for (int a = 0; a < N; ++a) square += (x[a] - centre[a]) * (x[a] - centre[a]);
      sum += std::exp(-square / (2.0 * width * width));
    }
    return sum;
  }
};

// ---- noise ----

/// A number in [0, 1) from 53 random bits.
inline double unit_random(std::mt19937_64& bits) { return static_cast<double>(bits() >> 11) * 0x1p-53; }

/// An integer in [0, count), from the generator's top bits (bias at most count / 2^53).
inline std::uint64_t random_below(std::mt19937_64& bits, std::uint64_t count) {
  return static_cast<std::uint64_t>(unit_random(bits) * static_cast<double>(count));
}

/// Independent values: integers over the whole range of T, reals in [0, 1). `noise_isovalue<T>()` is their median.
template <Value T, int N>
OwnedImage<T, N> noise(const Grid<N>& grid, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  OwnedImage<T, N> image{grid, std::vector<T>(sample_count(grid))};
  for (T& value : image.values) {
    if constexpr (std::is_floating_point_v<T>)
      value = std::min(static_cast<T>(unit_random(bits)), std::nextafter(T{1}, T{0}));
    else
      value = static_cast<T>(bits() >> (64 - 8 * sizeof(T)));
  }
  return image;
}

template <Value T, int N>
OwnedImage<T, N> noise(const std::array<std::size_t, N>& sizes, std::uint64_t seed) {
  return noise<T, N>(Grid<N>::unit(sizes), seed);
}

/// A cube of noise with `samples` samples along every axis and unit steps.
template <Value T, int N>
OwnedImage<T, N> noise(std::size_t samples, std::uint64_t seed) {
  std::array<std::size_t, N> sizes;
  sizes.fill(samples);
  return noise<T, N>(sizes, seed);
}

/// An isovalue exceeded by half of `noise<T>` that no sample of an integer image equals.
template <Value T>
constexpr double noise_isovalue() {
  if constexpr (std::is_floating_point_v<T>) return 0.5;
  return (static_cast<double>(std::numeric_limits<T>::lowest()) + static_cast<double>(std::numeric_limits<T>::max())) /
         2;
}

/// Noise of few values, 0 … levels - 1; at isovalue 1, many samples equal it exactly.
template <Value T, int N>
OwnedImage<T, N> coarse_noise(const Grid<N>& grid, std::uint64_t seed, std::uint64_t levels) {
  std::mt19937_64 bits(seed);
  OwnedImage<T, N> image{grid, std::vector<T>(sample_count(grid))};
  for (T& value : image.values) value = static_cast<T>(random_below(bits, levels));
  return image;
}

/// Noise of reals in which a share of the samples is missing (NaN).
template <Value T, int N>
requires std::is_floating_point_v<T> OwnedImage<T, N> noise_with_missing(const Grid<N>& grid, std::uint64_t seed,
                                                                         double share) {
  OwnedImage<T, N> image = noise<T, N>(grid, seed);
  std::mt19937_64 bits(seed + 1);
  for (T& value : image.values)
    if (unit_random(bits) < share) value = std::numeric_limits<T>::quiet_NaN();
  return image;
}

}  // namespace tegl::test
