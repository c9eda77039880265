// SPDX-License-Identifier: BSD-3-Clause
//
// Brute-force distances between contours at random points, over every simplex and each of its faces. They are lower
// bounds of the distances that the library bounds from above.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>

#include "fields.hpp"
#include "tegl/contour.hpp"

namespace tegl::test {

/// The distance of a point from a simplex: the minimum over all faces that contain the point's projection on their
/// affine hull.
template <int N>
double distance_to_simplex_by_faces(const Point<N>& p, const std::array<Point<N>, N>& corners) {
  const auto vector = [](const Point<N>& x) { return Eigen::Map<const Eigen::Matrix<double, N, 1>>(x.data()); };
  double best = std::numeric_limits<double>::infinity();
  for (unsigned face = 1; face < 1u << N; ++face) {
    int first = 0;
    while ((face >> first & 1u) == 0) ++first;
    Eigen::MatrixXd edges(N, 0);
    for (int i = first + 1; i < N; ++i)
      if ((face >> i & 1u) != 0) {
        edges.conservativeResize(N, edges.cols() + 1);
        edges.col(edges.cols() - 1) = vector(corners[i]) - vector(corners[first]);
      }
    const Eigen::VectorXd way = vector(p) - vector(corners[first]);
    Eigen::VectorXd weights(0);
    if (edges.cols() > 0) weights = edges.colPivHouseholderQr().solve(way);
    if ((weights.array() < 0.0).any() || weights.sum() > 1.0) continue;
    best = std::min(best, edges.cols() > 0 ? (way - edges * weights).norm() : way.norm());
  }
  return best;
}

/// Maximum distance of `samples` random points of one contour from the other.
template <int N, class Real>
double sampled_deviation(const Contour<N, Real>& from, const Contour<N, Real>& to, int samples, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  const auto corners_of = [](const Contour<N, Real>& contour, std::size_t s) {
    std::array<Point<N>, N> corners;
    for (int i = 0; i < N; ++i)
      for (int a = 0; a < N; ++a) corners[i][a] = static_cast<double>(contour.vertices[contour.simplices[s][i]][a]);
    return corners;
  };
  double largest = 0.0;
  for (int k = 0; k < samples; ++k) {
    const auto corners = corners_of(from, random_below(bits, from.simplices.size()));
    std::array<double, N> weights;
    double sum = 0.0;
    for (double& w : weights) sum += w = -std::log(1.0 - unit_random(bits));
    Point<N> p{};
    for (int i = 0; i < N; ++i)
      for (int a = 0; a < N; ++a) p[a] += weights[i] / sum * corners[i][a];
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& vertex : to.vertices) {
      double square = 0.0;
      for (int a = 0; a < N; ++a) square += std::pow(p[a] - static_cast<double>(vertex[a]), 2);
      nearest = std::min(nearest, std::sqrt(square));
    }
    for (std::size_t t = 0; t < to.simplices.size(); ++t) {
      const auto other = corners_of(to, t);
      // Every point of the simplex is at least (distance to its nearest corner - its longest edge) away.
      double corner = std::numeric_limits<double>::infinity(), edge = 0.0;
      for (int i = 0; i < N; ++i) {
        double square = 0.0, along = 0.0;
        for (int a = 0; a < N; ++a) {
          square += (p[a] - other[i][a]) * (p[a] - other[i][a]);
          along += (other[0][a] - other[i][a]) * (other[0][a] - other[i][a]);
        }
        corner = std::min(corner, std::sqrt(square));
        edge = std::max(edge, std::sqrt(along));
      }
      if (corner - edge > nearest) continue;
      nearest = std::min(nearest, distance_to_simplex_by_faces<N>(p, other));
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

}  // namespace tegl::test
