// SPDX-License-Identifier: BSD-3-Clause
//
// Intersections of simplices by rational numbers, with another method than the library: the vertices of the polytope of
// all pairs of equal points. Slow.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <gmpxx.h>

#include "tegl/contour.hpp"

namespace tegl::test {

template <int N>
using RationalPoint = std::array<mpq_class, N>;

/// The weights of the vertices of two simplices such that both weighted means are the same point: N + 2 linear
/// equations in 2 N non-negative weights.
template <int N>
class EqualPoints {
 public:
  static constexpr std::size_t kWeights = 2 * N;
  using Weights = std::array<mpq_class, kWeights>;

  EqualPoints(const std::array<RationalPoint<N>, N>& a, const std::array<RationalPoint<N>, N>& b) {
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t k = 0; k < N; ++k) {
        rows_[k][i] = a[i][k];
        rows_[k][N + i] = -b[i][k];
      }
    for (std::size_t i = 0; i < N; ++i) rows_[N][i] = rows_[N + 1][N + i] = 1;
    rows_[N][kWeights] = rows_[N + 1][kWeights] = 1;
    eliminate();
  }

  /// Whether any vertex of the polytope satisfies the condition.
  template <class Condition>
  [[nodiscard]] bool any_vertex(const Condition& condition) const {
    for (std::size_t i = rank_; i < kRows; ++i)
      if (rows_[i][kWeights] != 0) return false;
    for (unsigned basis = 0; basis < 1u << kWeights; ++basis) {
      if (static_cast<std::size_t>(std::popcount(basis)) != rank_) continue;
      const std::optional<Weights> weights = solve(basis);
      if (weights && condition(*weights)) return true;
    }
    return false;
  }

 private:
  static constexpr std::size_t kRows = N + 2;
  using Row = std::array<mpq_class, kWeights + 1>;

  static void subtract(Row& row, const Row& pivot, std::size_t column) {
    if (row[column] == 0) return;
    const mpq_class factor = row[column] / pivot[column];
    for (std::size_t j = 0; j <= kWeights; ++j) row[j] -= factor * pivot[j];
  }

  /// Moves a row with an entry in the column to `place` and removes the column from the others; false if none has.
  static bool pivot(std::array<Row, kRows>& rows, std::size_t place, std::size_t end, std::size_t column) {
    std::size_t row = place;
    while (row < end && rows[row][column] == 0) ++row;
    if (row == end) return false;
    std::swap(rows[place], rows[row]);
    for (std::size_t i = 0; i < end; ++i)
      if (i != place) subtract(rows[i], rows[place], column);
    return true;
  }

  void eliminate() {
    for (std::size_t column = 0; column < kWeights && rank_ < kRows; ++column)
      if (pivot(rows_, rank_, kRows, column)) ++rank_;
  }

  [[nodiscard]] std::optional<Weights> solve(unsigned basis) const {
    std::array<Row, kRows> rows = rows_;
    std::size_t k = 0;
    for (std::size_t column = 0; column < kWeights; ++column)
      if ((basis >> column & 1u) != 0 && !pivot(rows, k++, rank_, column)) return std::nullopt;
    Weights weights;
    k = 0;
    for (std::size_t column = 0; column < kWeights; ++column) {
      if ((basis >> column & 1u) == 0) continue;
      weights[column] = rows[k][kWeights] / rows[k][column];
      if (weights[column] < 0) return std::nullopt;
      ++k;
    }
    return weights;
  }

  std::array<Row, kRows> rows_{};
  std::size_t rank_ = 0;
};

template <int N>
using RationalCorners = std::array<RationalPoint<N>, N>;

/// Whether the bounding boxes have no common point.
template <int N>
bool boxes_are_apart(const RationalCorners<N>& a, const RationalCorners<N>& b) {
  for (std::size_t k = 0; k < N; ++k) {
    const auto less = [k](const auto& p, const auto& q) { return p[k] < q[k]; };
    const auto [a_low, a_high] = std::minmax_element(a.begin(), a.end(), less);
    const auto [b_low, b_high] = std::minmax_element(b.begin(), b.end(), less);
    if ((*a_high)[k] < (*b_low)[k] || (*b_high)[k] < (*a_low)[k]) return true;
  }
  return false;
}

/// Whether the corners are affinely dependent.
template <int N>
bool is_flat_rationally(const RationalCorners<N>& corners) {
  std::vector<RationalPoint<N>> edges;
  for (std::size_t i = 1; i < N; ++i) {
    RationalPoint<N> edge;
    for (std::size_t a = 0; a < N; ++a) edge[a] = corners[i][a] - corners[0][a];
    for (const auto& other : edges) {
      std::size_t lead = 0;
      while (other[lead] == 0) ++lead;
      const mpq_class factor = edge[lead] / other[lead];
      for (std::size_t a = 0; a < N; ++a) edge[a] -= factor * other[a];
    }
    if (std::all_of(edge.begin(), edge.end(), [](const mpq_class& x) { return x == 0; })) return true;
    edges.push_back(edge);
  }
  return false;
}

/// The simplices of a contour by rational numbers.
template <int N>
class RationalSimplices {
 public:
  template <class Real>
  explicit RationalSimplices(const Contour<N, Real>& contour)
      : rows_(contour.simplices.begin(), contour.simplices.end()), corners_(rows_.size()) {
    for (std::size_t s = 0; s < rows_.size(); ++s)
      for (std::size_t i = 0; i < N; ++i)
        for (std::size_t a = 0; a < N; ++a) corners_[s][i][a] = static_cast<double>(contour.vertices[rows_[s][i]][a]);
  }

  [[nodiscard]] std::set<Index> flat() const {
    std::set<Index> result;
    for (Index s = 0; s < rows_.size(); ++s)
      if (is_flat_rationally<N>(corners_[s])) result.insert(s);
    return result;
  }

  /// All pairs that intersect, of simplices that are not flat.
  [[nodiscard]] std::set<std::pair<Index, Index>> pairs() const {
    std::set<std::pair<Index, Index>> result;
    const std::set<Index> without = flat();
    for (Index s = 0; s < rows_.size(); ++s)
      for (Index t = s + 1; t < rows_.size(); ++t)
        if (!without.contains(s) && !without.contains(t) && intersect(s, t)) result.insert({s, t});
    return result;
  }

 private:
  /// Whether two simplices have a common point outside of the hull of their common vertices, or the same vertices.
  [[nodiscard]] bool intersect(Index s, Index t) const {
    std::array<bool, 2 * N> common{};
    int count = 0;
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t j = 0; j < N; ++j)
        if (rows_[s][i] == rows_[t][j]) {
          common[i] = common[N + j] = true;
          ++count;
        }
    if (count == N) return true;
    if (boxes_are_apart<N>(corners_[s], corners_[t])) return false;
    return EqualPoints<N>(corners_[s], corners_[t]).any_vertex([&](const auto& weights) {
      for (std::size_t i = 0; i < weights.size(); ++i)
        if (!common[i] && weights[i] != 0) return true;
      return false;
    });
  }

  std::vector<std::array<Index, N>> rows_;
  std::vector<RationalCorners<N>> corners_;
};

}  // namespace tegl::test
