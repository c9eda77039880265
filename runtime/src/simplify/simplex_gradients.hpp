// SPDX-License-Identifier: BSD-3-Clause
//
// Barycentric coordinates of points by a contour's simplices, in single precision: one cache line for a tetrahedron in
// 4-space. A walk chooses the next simplex by them. Distances are measured to points of the contour, in double
// precision, so they are upper bounds whatever the errors of the coordinates.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/workers.hpp"
#include "mesh/simplex_shapes.hpp"
#include "simplify/placed_simplex.hpp"
#include "simplify/simplex_corners.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

template <int N>
class SimplexGradients {
 public:
  static constexpr int D = N - 1;

  SimplexGradients(const SimplexCorners<N>& corners, unsigned threads, const Progress& progress)
      : corners_(corners), rows_(corners.size()) {
    if (corners.size() != 0) origin_ = corners[0][0];
    for_each_item(corners.size(), threads, progress, [&](std::size_t s) { rows_[s] = row_of(corners_[s]); });
  }

  [[nodiscard]] CornersN<N> corners(Index s) const { return corners_[s]; }

  /// A point relative to the origin of the rows.
  using Local = std::array<float, N>;
  [[nodiscard]] Local local(const PointN<N>& p) const {
    Local result;
    for (int a = 0; a < N; ++a) result[a] = static_cast<float>(p[a] - origin_[a]);
    return result;
  }

  struct Weights {
    std::array<float, N> of_corners;
    bool inside;  ///< whether none is negative; also for flat simplices, whose coordinates are not defined
  };
  [[nodiscard]] Weights weights(Index s, const Local& p) const {
    const Row& row = rows_[s];
    std::array<float, D> share{};
    for (int a = 0; a < N; ++a) {
      const float way = p[a] - row.corner[a];
      for (int i = 0; i < D; ++i) share[i] += way * row.gradients[a][i];
    }
    Weights result;
    result.of_corners[0] = 1.0f;
    bool outside = false;
    for (int i = 0; i < D; ++i) {
      result.of_corners[i + 1] = share[i];
      result.of_corners[0] -= share[i];
      outside = outside || share[i] < 0.0f;
    }
    result.inside = !outside && !(result.of_corners[0] < 0.0f);
    return result;
  }

  /// The distance of the point from the simplex if its projection is inside, else from a point of the simplex near the
  /// nearest one.
  [[nodiscard]] double distance(Index s, const PointN<N>& p, const Weights& weights) const {
    const CornersN<N> at = corners_[s];
    for (const float weight : weights.of_corners)  // flat, or very far away
      if (!(std::abs(weight) <= kLargest)) return distance_to_simplex<N>(p, at, N);
    double positive = 0.0;
    for (const float weight : weights.of_corners) positive += std::max(0.0f, weight);
    const double factor = 1.0 / positive;
    PointN<N> rest = minus(p, at[0]);
    for (int i = 1; i < N; ++i) {
      const double share = factor * static_cast<double>(std::max(0.0f, weights.of_corners[i]));
      for (int a = 0; a < N; ++a) rest[a] -= share * (at[i][a] - at[0][a]);
    }
    return norm(rest);
  }

 private:
  static constexpr float kLargest = 1e30f;

  struct Row {
    std::array<float, N> corner;                    ///< corner 0, relative to the origin
    std::array<std::array<float, D>, N> gradients;  ///< by axis; of the coordinates of the other corners
  };

  [[nodiscard]] Row row_of(const CornersN<N>& at) const {
    Row row;
    row.corner = local(at[0]);
    const PlacedSimplex<N> placed(at);
    if (placed.is_flat()) {
      row.corner.fill(std::numeric_limits<float>::quiet_NaN());
      row.gradients = {};
      return row;
    }
    const auto gradients = placed.gradients();
    for (int a = 0; a < N; ++a)
      for (int i = 0; i < D; ++i) row.gradients[a][i] = static_cast<float>(gradients[i][a]);
    return row;
  }

  SimplexCorners<N> corners_;
  PointN<N> origin_{};
  std::vector<Row> rows_;
};

}  // namespace tegl::detail
