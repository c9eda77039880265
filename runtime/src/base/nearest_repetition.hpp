// SPDX-License-Identifier: BSD-3-Clause
//
// Distances to the nearest of all repetitions of a point, also for oblique periods.
//
// Based on: Conway, Sloane, Low-Dimensional Lattices VI: Voronoi Reduction of Three-Dimensional Forms, 1992. For a
// reduced basis, the vectors that bound the Voronoi cell of a lattice are sums of basis vectors with factors -1, 0, 1.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "base/periods.hpp"

namespace tegl::detail {

/// Distances modulo periods. Differences of coordinates are divided by `steps`, by axis. Exact for periods along axes,
/// and for up to three oblique ones.
template <int N>
class NearestRepetition {
 public:
  using Point = std::array<double, N>;

  NearestRepetition(std::span<const Period<N>> periods, const Point& steps) : periods_(periods), steps_(steps) {
    bool is_oblique = false;
    for (const Period<N>& period : periods) {
      int axes = 0;
      for (int a = 0; a < N; ++a) axes += period.vector[a] != 0.0 || period.dual[a] != 0.0 ? 1 : 0;
      is_oblique |= axes > 1;
    }
    if (is_oblique) list_shifts();
  }

  /// The square of the distance from a point to the nearest repetition of x.
  [[nodiscard]] double square(const Point& point, Point x) const noexcept {
    move_near<N>(periods_, point, x);
    for (int a = 0; a < N; ++a) x[a] = (x[a] - point[a]) / steps_[a];
    shorten(shifts_, x);
    return product(x, x);
  }

 private:
  static double product(const Point& x, const Point& y) noexcept {
    double sum = 0;
    for (int a = 0; a < N; ++a) sum += x[a] * y[a];
    return sum;
  }

  /// Adds shifts to x as long as it becomes shorter. Returns whether it did.
  static bool shorten(const std::vector<Point>& shifts, Point& x) noexcept {
    constexpr double kShorter = 1e-12;  // more than rounding, so that this ends
    bool was_shortened = false;
    for (std::size_t since = 0, i = 0; since < shifts.size(); ++since, i = (i + 1) % shifts.size()) {
      const double length = product(shifts[i], shifts[i]);
      const double times = -std::round(product(shifts[i], x) / length);
      if (times == 0.0 || !std::isfinite(times)) continue;
      Point shorter = x;
      for (int a = 0; a < N; ++a) shorter[a] += times * shifts[i][a];
      if (product(shorter, shorter) >= product(x, x) * (1 - kShorter)) continue;
      x = shorter;
      since = 0;
      was_shortened = true;
    }
    return was_shortened;
  }

  /// All sums of vectors with factors -1, 0, 1, one of each pair of opposites.
  static std::vector<Point> sums(const std::vector<Point>& vectors) {
    std::vector<Point> all = {Point{}};
    for (const Point& vector : vectors)
      for (std::size_t i = 0, before = all.size(); i < before; ++i)
        for (const double sign : {1.0, -1.0}) {
          if (i == 0 && sign < 0) continue;  // the opposite of the vector alone
          Point sum = all[i];
          for (int a = 0; a < N; ++a) sum[a] += sign * vector[a];
          all.push_back(sum);
        }
    all.erase(all.begin());
    return all;
  }

  /// Reduces the periods, in steps, and lists their sums.
  void list_shifts() {
    std::vector<Point> basis;
    for (const Period<N>& period : periods_) {
      basis.emplace_back();
      for (int a = 0; a < N; ++a) basis.back()[a] = period.vector[a] / steps_[a];
    }
    for (std::size_t i = 0, since = 0; since < basis.size(); ++since, i = (i + 1) % basis.size()) {
      std::vector<Point> others = basis;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      if (shorten(sums(others), basis[i])) since = 0;
    }
    shifts_ = sums(basis);
  }

  std::span<const Period<N>> periods_;
  Point steps_;
  std::vector<Point> shifts_;  ///< empty unless periods are oblique
};

}  // namespace tegl::detail
