// SPDX-License-Identifier: BSD-3-Clause
//
// Quadric error metric: the weighted sum of squared distances from hyperplanes as a quadratic function.
//
// Based on: M. Garland and P. Heckbert, Surface simplification using quadric error metrics, 1997, and Simplifying
// surfaces with color and texture using quadric error metrics, 1998 (any number of dimensions).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/simplex_shapes.hpp"

namespace tegl::detail {

/// The solution x of a x = b for a symmetric positive definite matrix, whose lower triangle is given by rows: by the
/// decomposition into L D L^T. Not finite for other matrices.
template <int N>
PointN<N> solve_positive(std::array<double, N*(N + 1) / 2> a, PointN<N> b) {
  const auto at = [](int i, int j) { return i * (i + 1) / 2 + j; };
  PointN<N> inverse;  // of D
  for (int j = 0; j < N; ++j) {
    inverse[j] = 1.0 / a[at(j, j)];
    for (int i = j + 1; i < N; ++i) {
      const double factor = a[at(i, j)] * inverse[j];
      for (int k = j + 1; k <= i; ++k) a[at(i, k)] -= factor * a[at(k, j)];
      b[i] -= factor * b[j];
    }
  }
  for (int j = N - 1; j >= 0; --j) {
    for (int i = j + 1; i < N; ++i) b[j] -= a[at(i, j)] * b[i];
    b[j] *= inverse[j];
  }
  return b;
}

/// x -> sum of w (n.x - d)^2 over hyperplanes with unit normal n, offset d and weight w.
template <int N>
class Quadric {
 public:
  static constexpr std::size_t kMatrix = N * (N + 1) / 2;
  static constexpr std::size_t kValues = kMatrix + N + 2;
  /// Weight of the squared distance from a given place, relative to the trace of the matrix.
  static constexpr double kPull = 1e-3;

  void add_plane(const PointN<N>& normal, const PointN<N>& point, double weight) {
    const double offset = dot(normal, point);
    int k = 0;
    for (int i = 0; i < N; ++i) {
      for (int j = 0; j <= i; ++j) values_[k++] += weight * normal[i] * normal[j];
      values_[kMatrix + i] += weight * offset * normal[i];
    }
    values_[kMatrix + N] += weight * offset * offset;
    values_[kMatrix + N + 1] += weight;
  }

  Quadric& operator+=(const Quadric& other) {
    for (std::size_t k = 0; k < kValues; ++k) values_[k] += other.values_[k];
    return *this;
  }

  [[nodiscard]] double weight() const noexcept { return values_[kMatrix + N + 1]; }
  /// The lower triangle of the matrix by rows, the vector, the constant and the weight.
  [[nodiscard]] const std::array<double, kValues>& values() const noexcept { return values_; }

  /// The value at x; never negative, despite rounding.
  [[nodiscard]] double operator()(const PointN<N>& x) const {
    double sum = values_[kMatrix + N];
    int k = 0;
    for (int i = 0; i < N; ++i) {
      double row = -2.0 * values_[kMatrix + i];
      for (int j = 0; j < i; ++j) row += 2.0 * values_[k++] * x[j];
      row += values_[k++] * x[i];
      sum += row * x[i];
    }
    return std::max(0.0, sum);
  }

  /// Minimizes the function plus a small multiple of the squared distance from `near`. The second term makes the
  /// minimum unique where the surface is flat.
  [[nodiscard]] PointN<N> least_near(const PointN<N>& near) const {
    double trace = 0.0;
    for (int i = 0; i < N; ++i) trace += values_[i * (i + 3) / 2];
    const double pull = kPull * trace;
    if (!(pull > 0.0)) return near;
    std::array<double, kMatrix> a;
    std::copy_n(values_.begin(), kMatrix, a.begin());
    PointN<N> b;
    for (int i = 0; i < N; ++i) {
      b[i] = values_[kMatrix + i] + pull * near[i];
      a[i * (i + 3) / 2] += pull;
    }
    return solve_positive<N>(a, b);
  }

  /// The t in [0, 1] that minimizes the function at a + t (b - a); 1/2 if it is constant.
  [[nodiscard]] double least_between(const PointN<N>& a, const PointN<N>& b) const {
    const double at_a = (*this)(a), at_b = (*this)(b), middle = (*this)(between(a, b, 0.5));
    const double bend = at_a + at_b - 2.0 * middle;  // a quarter of the second derivative by t
    if (!(bend > 1e-12 * (at_a + at_b))) return at_a < at_b ? 0.0 : (at_b < at_a ? 1.0 : 0.5);
    return std::clamp(0.5 + (at_a - at_b) / (4.0 * bend), 0.0, 1.0);
  }

 private:
  std::array<double, kValues> values_{};
};

}  // namespace tegl::detail
