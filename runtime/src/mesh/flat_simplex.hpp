// SPDX-License-Identifier: BSD-3-Clause
//
// Whether a simplex has measure zero, as `check` counts it (tegl/check.hpp).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Edge vectors of a simplex from its first corner.
template <int D, int Space, class Real>
std::array<std::array<double, Space>, D> edges_of(const Index* row, std::size_t space_dim, const Real* values) {
  std::array<std::array<double, Space>, D> edges;
  for (int j = 0; j < D; ++j)
    for (std::size_t a = 0; a < Space && a < space_dim; ++a)
      edges[j][a] =
          static_cast<double>(values[row[j + 1] * space_dim + a]) - static_cast<double>(values[row[0] * space_dim + a]);
  return edges;
}

/// True only if no height of a simplex is less than 1e-6 of its longest edge: let V be the volume of the parallelepiped
/// of its edges, whose longest is L. A height is V over the volume of a face of it, which is at most (2 L)^(D-1). V² is
/// Gram's determinant, up to a few 1e-15 L^(2D). False if there is doubt. D = 2, 3.
template <int D, class Real>
bool is_surely_solid(const Index* row, const Real* values) {
  const auto edges = edges_of<D, D + 1>(row, D + 1, values);
  std::array<std::array<double, D>, D> gram;
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j) {
      gram[i][j] = 0.0;
      for (int a = 0; a <= D; ++a) gram[i][j] += edges[i][a] * edges[j][a];
    }
  double longest = std::max(gram[0][0], gram[1][1]);
  double square = gram[0][0] * gram[1][1] - gram[0][1] * gram[0][1];
  double limit = longest * longest;
  if constexpr (D == 3) {
    square = square * gram[2][2] - gram[0][0] * gram[1][2] * gram[1][2] - gram[1][1] * gram[0][2] * gram[0][2] +
             2.0 * gram[0][1] * gram[0][2] * gram[1][2];
    longest = std::max(longest, gram[2][2]);
    limit = longest * longest * longest;
  }
  // false for NaN; extreme lengths are left to is_flat
  return square > 1e-10 * limit && limit > 1e-200 && limit < 1e200;
}

/// Whether D edge vectors from one corner span less than D dimensions, up to rounding. Gram–Schmidt with pivoting,
/// longest remainder first; the remainders are heights of the simplex in decreasing order.
template <int D, class Real>
bool is_flat_by_heights(const Index* row, int space_dim, const Real* values) {
  constexpr int kMaxSpace = 8;
  constexpr double kFlat = 1e-14;
  auto edges = edges_of<D, kMaxSpace>(row, static_cast<std::size_t>(space_dim), values);
  const auto dot = [space_dim](const auto& x, const auto& y) {
    double sum = 0.0;
    for (int a = 0; a < space_dim; ++a) sum += x[a] * y[a];
    return sum;
  };
  double longest = 0.0;
  for (int step = 0; step < D; ++step) {
    // pivot: the longest remainder
    int pivot = step;
    double best = -1.0;
    for (int j = step; j < D; ++j) {
      const double square = dot(edges[j], edges[j]);
      if (!std::isfinite(square)) return true;
      if (square > best) {
        best = square;
        pivot = j;
      }
    }
    std::swap(edges[step], edges[pivot]);
    longest = std::max(longest, best);
    if (best <= kFlat * kFlat * longest) return true;
    // subtract its direction from the others
    for (int j = step + 1; j < D; ++j) {
      const double along = dot(edges[j], edges[step]) / best;
      for (int a = 0; a < space_dim; ++a) edges[j][a] -= along * edges[step][a];
    }
  }
  return false;
}

template <int D, class Real>
bool is_flat(const Index* row, int space_dim, const Real* values) {
  if constexpr (D == 2 || D == 3)
    if (space_dim == D + 1 && is_surely_solid<D>(row, values)) return false;
  return is_flat_by_heights<D>(row, space_dim, values);
}

}  // namespace tegl::detail
