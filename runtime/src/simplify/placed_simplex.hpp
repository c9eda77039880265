// SPDX-License-Identifier: BSD-3-Clause
//
// A simplex prepared for the distances of many points.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/simplex_shapes.hpp"

namespace tegl::detail {

/// Upper bounds of the distances of points from one simplex. The simplex must outlive it.
template <int N>
class PlacedSimplex {
 public:
  static constexpr int D = N - 1;

  explicit PlacedSimplex(const CornersN<N>& corners) : corners_(corners) {
    // the inverse of the matrix of scalar products of the edges, by its cofactors
    for (int i = 0; i < D; ++i) edges_[i] = minus(corners[i + 1], corners[0]);
    std::array<std::array<double, D>, D> product;
    double cube = 1.0;
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j <= i; ++j) product[i][j] = product[j][i] = dot(edges_[i], edges_[j]);
      cube *= product[i][i];
    }
    double content = 0.0;
    if constexpr (D == 1) {
      inverse_[0][0] = 1.0;
      content = product[0][0];
    } else if constexpr (D == 2) {
      inverse_ = {{{product[1][1], -product[1][0]}, {-product[1][0], product[0][0]}}};
      content = product[0][0] * product[1][1] - product[1][0] * product[1][0];
    } else {
      for (int i = 0; i < D; ++i)
        for (int j = 0; j <= i; ++j) {
          const int a = (i + 1) % D, b = (i + 2) % D, c = (j + 1) % D, d = (j + 2) % D;
          inverse_[i][j] = inverse_[j][i] = product[a][c] * product[b][d] - product[a][d] * product[b][c];
        }
      for (int j = 0; j < D; ++j) content += product[0][j] * inverse_[0][j];
    }
    flat_ = !(content > kFlat * cube);
    const double factor = 1.0 / content;
    for (auto& row : inverse_)
      for (double& x : row) x *= factor;
  }

  struct Place {
    double distance;                  ///< of a point of the simplex; the nearest one if `inside`
    bool inside;                      ///< whether the projection onto the hyperplane is inside
    std::array<double, N> weights{};  ///< barycentric coordinates of the projection
  };
  /// The point of the simplex below p; else one near it, with the negative barycentric coordinates of p set to 0. The
  /// distance is that of a point of the simplex, whatever the rounding errors of the weights.
  [[nodiscard]] Place place(const PointN<N>& p) const {
    Place result{};
    if (flat_) {
      result.distance = distance_to_simplex<N>(p, corners_, N);
      result.inside = true;
      return result;
    }
    PointN<N> rest = minus(p, corners_[0]);
    std::array<double, D> along;
    for (int i = 0; i < D; ++i) along[i] = dot(rest, edges_[i]);
    auto& weights = result.weights;
    weights[0] = 1.0;
    for (int i = 0; i < D; ++i) {
      weights[i + 1] = dot(inverse_[i], along);
      weights[0] -= weights[i + 1];
    }
    double positive = 0.0;
    result.inside = true;
    for (const double weight : weights) {
      positive += std::max(0.0, weight);
      result.inside = result.inside && weight >= 0.0;
    }
    const double factor = result.inside ? 1.0 : 1.0 / positive;
    for (int i = 0; i < D; ++i) {
      const double share = std::max(0.0, weights[i + 1]) * factor;
      for (int a = 0; a < N; ++a) rest[a] -= share * edges_[i][a];
    }
    result.distance = norm(rest);
    return result;
  }

  [[nodiscard]] bool is_flat() const noexcept { return flat_; }
  /// The gradients of the barycentric coordinates of corners 1 to D; not for flat simplices.
  [[nodiscard]] std::array<PointN<N>, D> gradients() const {
    std::array<PointN<N>, D> result{};
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        for (int a = 0; a < N; ++a) result[i][a] += inverse_[i][j] * edges_[j][a];
    return result;
  }

 private:
  /// Square of the relative content of simplices that count as flat. Weights of others have errors of about 1e-8.
  static constexpr double kFlat = 1e-8;

  const CornersN<N>& corners_;
  std::array<PointN<N>, D> edges_;  ///< from corner 0
  std::array<std::array<double, D>, D> inverse_;
  bool flat_;
};

}  // namespace tegl::detail
