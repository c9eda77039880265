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

#include "base/workers.hpp"
#include "mesh/simplex_shapes.hpp"
#include "simplify/corner_lanes.hpp"
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
    const auto& row = rows_[s].values;
    std::array<float, N> share{};  // one more than needed: compilers make use of whole registers
    for (int a = 0; a < N; ++a) {
      const float way = p[a] - row[kCorner + a];
      for (int i = 0; i < N; ++i) share[i] += way * row[a * D + i];
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
    return distance(p, corners_[s], weights);
  }
  [[nodiscard]] static double distance(const PointN<N>& p, const CornersN<N>& at, const Weights& weights) {
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
  /// The same for the corners of a simplex.
  [[nodiscard]] std::array<double, N> distances(Index s, const CornerLanes<N>& points) const {
    std::array<double, N> result;
    if constexpr (N == 4)
      if (distances_by_gradients(rows_[s].values, corners_[s], origin_, points, result)) return result;
    for (int k = 0; k < N; ++k) {
      const PointN<N> p = points[k];
      result[k] = distance(s, p, weights(s, local(p)));
    }
    return result;
  }

 private:
  static constexpr float kLargest = 1e30f;

  /// The gradients of the coordinates of corners 1 to D, axis by axis; then corner 0, relative to the origin.
  struct alignas(N == 4 ? 64 : alignof(float)) Row {
    std::array<float, N * D + N> values;
  };
  static constexpr std::size_t kCorner = N * D;

  [[nodiscard]] Row row_of(const CornersN<N>& at) const {
    Row row{};
    const PlacedSimplex<N> placed(at);
    const bool is_flat = placed.is_flat();
    const Local corner = local(at[0]);
    for (int a = 0; a < N; ++a) row.values[kCorner + a] = is_flat ? std::numeric_limits<float>::quiet_NaN() : corner[a];
    if (is_flat) return row;
    const auto gradients = placed.gradients();
    for (int a = 0; a < N; ++a)
      for (int i = 0; i < D; ++i) row.values[a * D + i] = static_cast<float>(gradients[i][a]);
    return row;
  }

  SimplexCorners<N> corners_;
  PointN<N> origin_{};
  Buffer<Row> rows_;
};

}  // namespace tegl::detail
