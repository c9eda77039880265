// SPDX-License-Identifier: BSD-3-Clause
//
// A contour for measurements of distances: scaled, and sorted along a curve, so that the walks from simplex to simplex
// find their neighbours in the cache.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "mesh/simplex_shapes.hpp"
#include "simplify/curve_order.hpp"
#include "simplify/simplex_corners.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The scaled simplices of a contour, along a curve.
template <int N>
struct ScaledSimplices {
  CurveOrder<N> order;
  std::span<const std::array<Index, N>> simplices;
  Buffer<PointN<N>> points;
  SimplexCorners<N> corners;

  template <class Real>
  ScaledSimplices(const Contour<N, Real>& contour, const std::array<double, N>& scale)
      : order(contour.simplices, contour.vertices.size(),
              [&](std::size_t v) { return scaled<Real>(contour.vertices[v], scale); }),
        simplices(order.rows),
        points(contour.vertices.size()),
        corners(simplices, points) {
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i] = scaled<Real>(contour.vertices[order.vertices[i]], scale);
  }
  ScaledSimplices(const ScaledSimplices&) = delete;
  ScaledSimplices& operator=(const ScaledSimplices&) = delete;

  /// Values by simplex, in the order of the contour.
  [[nodiscard]] std::vector<double> in_order_of_contour(const std::vector<double>& values) const {
    std::vector<double> result(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) result[order.simplices[i]] = values[i];
    return result;
  }

 private:
  template <class Real>
  static PointN<N> scaled(const std::array<Real, N>& vertex, const std::array<double, N>& scale) {
    PointN<N> point;
    for (int a = 0; a < N; ++a) point[a] = static_cast<double>(vertex[a]) * scale[a];
    return point;
  }
};

}  // namespace tegl::detail
