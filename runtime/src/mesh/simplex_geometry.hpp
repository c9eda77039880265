// SPDX-License-Identifier: BSD-3-Clause
//
// Geometry of single simplices of a contour, in double precision: corners, centroid, and the normal vector whose length
// is the measure of the simplex.
#pragma once

#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/LU>

#include "tegl/contour.hpp"

namespace tegl::detail {

template <int N>
using PointOf = std::array<double, N>;

/// The corners of simplex s, N points.
template <int N, class Real>
std::array<PointOf<N>, N> corners_of(const Contour<N, Real>& contour, std::size_t s) noexcept {
  std::array<PointOf<N>, N> corners;
  for (int j = 0; j < N; ++j)
    for (int a = 0; a < N; ++a) corners[j][a] = static_cast<double>(contour.vertices[contour.simplices[s][j]][a]);
  return corners;
}

template <int N>
double length_of(const PointOf<N>& v) noexcept {
  // Scaled as in hypot, so that squares neither overflow nor underflow.
  double largest = 0.0;
  for (const double x : v) largest = std::max(largest, std::abs(x));
  if (!(largest > 0.0) || std::isinf(largest)) return largest;
  double square = 0.0;
  for (const double x : v) square += (x / largest) * (x / largest);
  return largest * std::sqrt(square);
}

template <int N>
PointOf<N> centroid_of(const std::array<PointOf<N>, N>& corners) noexcept {
  PointOf<N> sum{};
  for (const PointOf<N>& corner : corners)
    for (int a = 0; a < N; ++a) sum[a] += corner[a];
  for (double& x : sum) x /= N;
  return sum;
}

/// The vector n with n . w = det(e_1, ..., e_{N-1}, w) / (N-1)! for the edges e_j = corner_j - corner_0. It is
/// perpendicular to the simplex, its length is the measure of the simplex, and it points to the side that the
/// orientation faces. It is a covector and needs no metric.
template <int N>
PointOf<N> normal_vector_of(const std::array<PointOf<N>, N>& corners) noexcept {
  using Minor = Eigen::Matrix<double, N - 1, N - 1>;
  constexpr double kFactorial = [] {
    double product = 1.0;
    for (int k = 2; k < N; ++k) product *= k;
    return product;
  }();
  PointOf<N> normal;
  for (int a = 0; a < N; ++a) {
    Minor minor;
    for (int row = 0, b = 0; b < N; ++b) {
      if (b == a) continue;
      for (int j = 0; j < N - 1; ++j) minor(row, j) = corners[j + 1][b] - corners[0][b];
      ++row;
    }
    const double cofactor = minor.determinant();
    normal[a] = ((a + N - 1) % 2 == 0 ? cofactor : -cofactor) / kFactorial;
  }
  return normal;
}

}  // namespace tegl::detail
