// SPDX-License-Identifier: BSD-3-Clause
//
// Geometry of single simplices of a contour, in double precision: corners, centroid, and the normal vector whose length
// is the measure of the simplex.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>

#include "base/periods.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

template <int N>
using PointOf = std::array<double, N>;

/// The corners of simplex s, N points; in a wrapped contour they are moved next to the first one.
template <int N, class Real>
std::array<PointOf<N>, N> corners_of(const Contour<N, Real>& contour, std::size_t s) noexcept {
  std::array<PointOf<N>, N> corners;
  for (int j = 0; j < N; ++j)
    for (int a = 0; a < N; ++a) corners[j][a] = static_cast<double>(contour.vertices[contour.simplices[s][j]][a]);
  if (!contour.periods.empty())
    for (int j = 1; j < N; ++j) move_near(std::span<const Period<N>>(contour.periods), corners[0], corners[j]);
  return corners;
}

/// Scaled as in hypot, so that squares neither overflow nor underflow.
template <int N>
[[gnu::noinline]] double scaled_length_of(const PointOf<N>& v) noexcept {
  double largest = 0.0;
  for (const double x : v) largest = std::max(largest, std::abs(x));
  if (!(largest > 0.0) || std::isinf(largest)) return largest;
  double square = 0.0;
  for (const double x : v) square += (x / largest) * (x / largest);
  return largest * std::sqrt(square);
}

template <int N>
inline double length_of(const PointOf<N>& v) noexcept {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  if (sum > 1e-280 && sum < 1e280) [[likely]]
    return std::sqrt(sum);
  return scaled_length_of<N>(v);
}

template <int N>
PointOf<N> centroid_of(const std::array<PointOf<N>, N>& corners) noexcept {
  PointOf<N> sum{};
  for (const PointOf<N>& corner : corners)
    for (int a = 0; a < N; ++a) sum[a] += corner[a];
  for (double& x : sum) x /= N;
  return sum;
}

/// For `normal_vector_of`, by cofactors of any size.
template <int N>
PointOf<N> normal_vector_by_minors(const std::array<PointOf<N>, N>& corners) noexcept;

extern template PointOf<2> normal_vector_by_minors<2>(const std::array<PointOf<2>, 2>&) noexcept;
extern template PointOf<5> normal_vector_by_minors<5>(const std::array<PointOf<5>, 5>&) noexcept;

/// The vector n with n . w = det(e_1, ..., e_{N-1}, w) / (N-1)! for the edges e_j = corner_j - corner_0. It is
/// perpendicular to the simplex, its length is the measure of the simplex, and it points to the side that the
/// orientation faces. It is a covector and needs no metric.
template <int N>
inline PointOf<N> normal_vector_of(const std::array<PointOf<N>, N>& corners) noexcept {
  if constexpr (N != 3 && N != 4) {
    return normal_vector_by_minors<N>(corners);
  } else {
    // Written out, since sums over all simplices of a contour spend most of their time here.
    std::array<PointOf<N>, N - 1> e;
    for (int j = 0; j < N - 1; ++j)
      for (int a = 0; a < N; ++a) e[j][a] = corners[j + 1][a] - corners[0][a];
    // the determinants of some rows of the matrix whose columns are the edges
    if constexpr (N == 3) {
      const auto det = [&e](int a, int b) { return e[0][a] * e[1][b] - e[0][b] * e[1][a]; };
      return {det(1, 2) / 2.0, -det(0, 2) / 2.0, det(0, 1) / 2.0};
    } else {
      const auto det = [&e](int a, int b, int c) {
        const double first = e[0][a] * (e[1][b] * e[2][c] - e[2][b] * e[1][c]);
        const double second = e[1][a] * (e[0][b] * e[2][c] - e[2][b] * e[0][c]);
        const double third = e[2][a] * (e[0][b] * e[1][c] - e[1][b] * e[0][c]);
        return first - second + third;
      };
      return {-det(1, 2, 3) / 6.0, det(0, 2, 3) / 6.0, -det(0, 1, 3) / 6.0, det(0, 1, 2) / 6.0};
    }
  }
}

/// The simplices of a contour with coordinates of either type, read in double precision. The contour must outlive it.
template <int N>
class SimplexView {
 public:
  template <class Real>
  explicit SimplexView(const Contour<N, Real>& contour) noexcept
      : simplices_(contour.simplices),
        is_single_(std::is_same_v<Real, float>),
        vertex_count_(contour.vertices.size()),
        periods_(contour.periods) {
    if constexpr (std::is_same_v<Real, float>)
      singles_ = contour.vertices.data();
    else
      doubles_ = contour.vertices.data();
  }

  [[nodiscard]] std::size_t vertex_count() const noexcept { return vertex_count_; }
  [[nodiscard]] std::span<const std::array<Index, N>> simplices() const noexcept { return simplices_; }
  /// The periods of a wrapped contour.
  [[nodiscard]] std::span<const Period<N>> periods() const noexcept { return periods_; }
  /// Whether the coordinates are in single precision.
  [[nodiscard]] bool is_single() const noexcept { return is_single_; }
  /// Vertex numbers, #S x N, row = simplex.
  [[nodiscard]] std::span<const Index> rows() const noexcept {
    return {simplices_.empty() ? nullptr : simplices_.data()->data(), simplices_.size() * N};
  }
  /// Calls f with a pointer to the vertices.
  template <class F>
  decltype(auto) with_points(const F& f) const {
    return is_single_ ? f(singles_) : f(doubles_);
  }
  [[nodiscard]] PointOf<N> point(Index v) const noexcept {
    if (!is_single_) return doubles_[v];
    PointOf<N> result;
    for (int a = 0; a < N; ++a) result[a] = static_cast<double>(singles_[v][a]);
    return result;
  }
  /// One coordinate of a vertex.
  [[nodiscard]] double coordinate(Index v, int axis) const noexcept {
    return is_single_ ? static_cast<double>(singles_[v][axis]) : doubles_[v][axis];
  }
  /// The corners of simplex s, N points; in a wrapped contour they are moved next to the first one.
  [[nodiscard]] std::array<PointOf<N>, N> corners(std::size_t s) const noexcept {
    std::array<PointOf<N>, N> result;
    for (int j = 0; j < N; ++j) result[j] = point(simplices_[s][j]);
    if (!periods_.empty())
      for (int j = 1; j < N; ++j) move_near(periods_, result[0], result[j]);
    return result;
  }

 private:
  std::span<const std::array<Index, N>> simplices_;
  const std::array<float, N>* singles_ = nullptr;
  const std::array<double, N>* doubles_ = nullptr;
  bool is_single_;
  std::size_t vertex_count_;
  std::span<const Period<N>> periods_;
};

}  // namespace tegl::detail
