// SPDX-License-Identifier: BSD-3-Clause
//
// Measures of a contour: length, area or 3-volume, and enclosed content.
#pragma once

#include <cmath>

#include <Eigen/Dense>

#include "tegl/contour.hpp"

namespace tegl::test {

/// The edge vectors v_1 - v_0, …, v_{N-1} - v_0 of a simplex as columns, N x (N - 1).
template <int N, class Real>
Eigen::Matrix<double, N, N - 1> edge_vectors(const Contour<N, Real>& contour, std::size_t s) {
  Eigen::Matrix<double, N, N - 1> edges;
  const auto& simplex = contour.simplices[s];
  for (int j = 1; j < N; ++j)
    for (int a = 0; a < N; ++a)
      edges(a, j - 1) =
          static_cast<double>(contour.vertices[simplex[j]][a]) - static_cast<double>(contour.vertices[simplex[0]][a]);
  return edges;
}

constexpr double factorial(int n) { return n < 2 ? 1.0 : n * factorial(n - 1); }

/// The (N-1)-dimensional measure of one simplex: sqrt(det(E^T E)) / (N-1)!.
template <int N, class Real>
double simplex_measure(const Contour<N, Real>& contour, std::size_t s) {
  const auto edges = edge_vectors(contour, s);
  const double gram = (edges.transpose() * edges).eval().determinant();
  return std::sqrt(std::max(gram, 0.0)) / factorial(N - 1);
}

/// Length (N = 2), area (3) or 3-volume (4) of the whole contour.
template <int N, class Real>
double measure(const Contour<N, Real>& contour) {
  double sum = 0.0;
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) sum += simplex_measure(contour, s);
  return sum;
}

/// The content of the high side of a closed contour, by the divergence theorem: 1/N of the outward flux of x (high to
/// low). Negative if the contour is oriented against its `direction`.
template <int N, class Real>
double enclosed_content(const Contour<N, Real>& contour) {
  double sum = 0.0;
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) {
    Eigen::Matrix<double, N, N> frame;
    frame.template leftCols<N - 1>() = edge_vectors(contour, s);
    for (int a = 0; a < N; ++a) frame(a, N - 1) = static_cast<double>(contour.vertices[contour.simplices[s][0]][a]);
    sum += frame.determinant();
  }
  return (contour.direction == GradientDirection::descent ? sum : -sum) / factorial(N);
}

/// The share of simplices, weighted by measure, whose normal has a positive component along `outwards(centroid)`: 1 for
/// a contour oriented that way everywhere, 0 for the reverse.
template <int N, class Real, class Outwards>
double share_facing(const Contour<N, Real>& contour, const Outwards& outwards) {
  double facing = 0.0;
  double total = 0.0;
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) {
    std::array<double, N> centroid{};
    for (const Index v : contour.simplices[s])
      for (int a = 0; a < N; ++a) centroid[a] += static_cast<double>(contour.vertices[v][a]) / N;
    const std::array<double, N> direction = outwards(centroid);
    Eigen::Matrix<double, N, N> frame;
    frame.template leftCols<N - 1>() = edge_vectors(contour, s);
    for (int a = 0; a < N; ++a) frame(a, N - 1) = direction[a];
    const double size = simplex_measure(contour, s);
    total += size;
    if (frame.determinant() > 0) facing += size;
  }
  return total > 0 ? facing / total : 0.0;
}

/// The order p of convergence from the errors at steps h and h / 2: error ~ h^p.
inline double convergence_order(double coarse_error, double fine_error) {
  return std::log2(std::abs(coarse_error) / std::abs(fine_error));
}

}  // namespace tegl::test
