// SPDX-License-Identifier: BSD-3-Clause
//
// Points and simplices in the order of a space-filling curve: what is near in space is near in memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "base/radix_sort.hpp"
#include "mesh/simplex_shapes.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The numbers of points along the curve that interleaves the bits of their coordinates. `point(i)`: point i of
/// `count`.
template <int N, class PointOf>
std::vector<Index> order_along_curve(std::size_t count, const PointOf& point) {
  constexpr unsigned kBits = std::min(16, 64 / N);
  constexpr double kMostCells = (1u << kBits) - 1;
  PointN<N> low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < count; ++i) {
    const PointN<N> p = point(i);
    for (int a = 0; a < N; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
  }
  struct Keyed {
    std::uint64_t key;
    Index number;
  };
  std::vector<Keyed> keyed(count);
  for (std::size_t i = 0; i < count; ++i) {
    const PointN<N> p = point(i);
    std::array<std::uint64_t, N> cell{};
    for (int a = 0; a < N; ++a) {
      const double share = (p[a] - low[a]) / (high[a] - low[a]);
      if (share > 0.0) cell[a] = static_cast<std::uint64_t>(std::min(1.0, share) * kMostCells);
    }
    std::uint64_t key = 0;
    for (unsigned bit = kBits; bit-- > 0;)
      for (int a = 0; a < N; ++a) key = key << 1 | (cell[a] >> bit & 1u);
    keyed[i] = {key, static_cast<Index>(i)};
  }
  sort_by_bits(keyed, kBits * N, [](const Keyed& one) { return one.key; });
  std::vector<Index> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = keyed[i].number;
  return order;
}

/// Vertices along the curve, and simplices by their first vertex on it.
template <int N>
struct CurveOrder {
  std::vector<Index> vertices;        ///< the original numbers, along the curve
  std::vector<Index> places;          ///< the place of each original vertex on the curve
  std::vector<Index> simplices;       ///< the original numbers, in the new order
  Buffer<std::array<Index, N>> rows;  ///< the simplices in that order, with places as vertices

  template <class PointOf>
  CurveOrder(std::span<const std::array<Index, N>> all, std::size_t vertex_count, const PointOf& point)
      : vertices(order_along_curve<N>(vertex_count, point)), places(vertex_count), simplices(all.size()) {
    for (std::size_t i = 0; i < vertices.size(); ++i) places[vertices[i]] = static_cast<Index>(i);
    // by the first vertex: counts, then places
    std::vector<std::size_t> next(vertex_count + 1, 0);
    const auto first_of = [&](const std::array<Index, N>& simplex) {
      Index first = places[simplex[0]];
      for (const Index v : simplex) first = std::min(first, places[v]);
      return first;
    };
    for (const auto& simplex : all) ++next[first_of(simplex) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    rows.resize(all.size());
    for (std::size_t s = 0; s < all.size(); ++s) {
      const std::size_t to = next[first_of(all[s])]++;
      simplices[to] = static_cast<Index>(s);
      for (int i = 0; i < N; ++i) rows[to][i] = places[all[s][i]];
    }
  }
};

}  // namespace tegl::detail
