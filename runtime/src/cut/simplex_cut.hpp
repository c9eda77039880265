// SPDX-License-Identifier: BSD-3-Clause
//
// How a hyperplane divides one simplex: the pieces between its vertices above and the others. Orientations are derived
// at the top of closed_cut.cpp: a piece, followed by the upward direction, is a negative frame of the simplex.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>

#include "base/monotone_paths.hpp"
#include "cut/slice_piece.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The positions of a simplex's vertices with those in `high` (bit j: vertex j) first, by an even permutation.
template <int N>
constexpr std::array<std::uint8_t, N> high_first(unsigned high) {
  std::array<std::uint8_t, N> sorted{};
  for (int j = 0; j < N; ++j) sorted[j] = static_cast<std::uint8_t>(j);
  const auto is_first = [&](int i) { return ((high >> sorted[i]) & 1u) != 0; };
  bool odd = false;
  for (int i = 1; i < N; ++i)
    for (int j = i; j > 0 && is_first(j) && !is_first(j - 1); --j) {
      std::swap(sorted[j], sorted[j - 1]);
      odd = !odd;
    }
  // With at least three vertices, one side has two of them; exchanging them makes the permutation even.
  const int high_count = std::popcount(high);
  if (odd && high_count >= 2) std::swap(sorted[0], sorted[1]);
  if (odd && high_count < 2) std::swap(sorted[N - 2], sorted[N - 1]);
  return sorted;
}

/// The edges of a simplex, by the positions of their ends, that carry the cut points between the vertices in a set and
/// the others: of a segment, or of a polygon in cyclic order.
struct EdgesOfCut {
  std::array<std::uint8_t, 4> above{};
  std::array<std::uint8_t, 4> below{};
  int count = 0;
};
template <int N>
constexpr EdgesOfCut edges_of_cut(unsigned high) {
  using Pairs = std::array<std::pair<int, int>, 4>;  // above and below, in the order of `high_first`
  const int high_count = std::popcount(high);
  EdgesOfCut edges;
  Pairs pairs{};
  if (N == 3) {
    pairs = high_count == 1 ? Pairs{{{0, 2}, {0, 1}}} : Pairs{{{0, 2}, {1, 2}}};
    edges.count = 2;
  } else if (high_count == 1) {
    pairs = {{{0, 1}, {0, 2}, {0, 3}}};
    edges.count = 3;
  } else if (high_count == 2) {
    pairs = {{{0, 2}, {0, 3}, {1, 3}, {1, 2}}};
    edges.count = 4;
  } else {
    pairs = {{{0, 3}, {1, 3}, {2, 3}}};
    edges.count = 3;
  }
  const auto order = high_first<N>(high);
  for (int i = 0; i < edges.count; ++i) {
    edges.above[i] = order[pairs[i].first];
    edges.below[i] = order[pairs[i].second];
  }
  return edges;
}
/// By set of the vertices above; neither none nor all.
template <int N>
constexpr auto kEdgesOfCut = [] {
  std::array<EdgesOfCut, 1u << N> all{};
  for (unsigned high = 1; high + 1 < all.size(); ++high) all[high] = edges_of_cut<N>(high);
  return all;
}();

/// The cut of a 4-simplex between `high_count` vertices and the others is a tetrahedron or a prism over a triangle. The
/// prism is a product of two simplices, divided by its monotone paths, so neighbours agree.
struct TetrahedraOfCut {
  /// Pairs (above, below); those above are 0 to high_count - 1.
  std::array<std::array<VertexPair, 4>, 3> points{};
  int count = 0;
};

/// The determinant of f_1, f_2, f_3 and the upward direction in the frame of the simplex, up to a positive factor.
constexpr int frame_of_cut(const std::array<VertexPair, 4>& points, int high_count) {
  std::array<std::array<int, 5>, 4> rows{};
  for (int i = 1; i < 4; ++i) {
    ++rows[i - 1][points[i].first], ++rows[i - 1][points[i].second];
    --rows[i - 1][points[0].first], --rows[i - 1][points[0].second];
  }
  for (int j = 0; j < 5; ++j) rows[3][j] = j < high_count ? 5 - high_count : -high_count;
  // Leibniz' formula, without the coordinate of the simplex's first vertex
  int sum = 0;
  std::array<int, 4> order{0, 1, 2, 3};
  do {
    int product = 1;
    for (int i = 0; i < 4; ++i) {
      product *= rows[i][order[i] + 1];
      for (int j = 0; j < i; ++j) product *= order[j] > order[i] ? -1 : 1;
    }
    sum += product;
  } while (std::next_permutation(order.begin(), order.end()));
  return sum;
}

constexpr TetrahedraOfCut tetrahedra_of_cut(int high_count) {
  TetrahedraOfCut result;
  for_each_monotone_path<4>(high_count, [&](const std::array<VertexPair, 4>& path) {
    auto& points = result.points[result.count++];
    points = path;
    for (VertexPair& pair : points) pair.second = static_cast<std::uint8_t>(pair.second + high_count);
    if (frame_of_cut(points, high_count) > 0) std::swap(points[2], points[3]);
  });
  return result;
}
inline constexpr std::array<TetrahedraOfCut, 5> kTetrahedraOfCut = {
    TetrahedraOfCut{}, tetrahedra_of_cut(1), tetrahedra_of_cut(2), tetrahedra_of_cut(3), tetrahedra_of_cut(4)};

/// The vertices of a 4-simplex with those in `high` first, both parts in ascending order of their numbers, so that all
/// simplices divide a common face alike; and whether that is an odd permutation.
inline std::pair<std::array<Index, 5>, bool> sides_in_order(const std::array<Index, 5>& simplex, unsigned high) {
  std::array<std::uint64_t, 5> keys;  // the side, then the number
  for (unsigned j = 0; j < 5; ++j) keys[j] = (std::uint64_t{((high >> j) & 1u) == 0} << 32) | simplex[j];
  bool odd = false;
  for (unsigned i = 1; i < 5; ++i)
    for (unsigned j = i; j > 0 && keys[j] < keys[j - 1]; --j) {
      std::swap(keys[j], keys[j - 1]);
      odd = !odd;
    }
  std::array<Index, 5> sorted;
  for (unsigned j = 0; j < 5; ++j) sorted[j] = static_cast<Index>(keys[j] & 0xffffffffu);
  return {sorted, odd};
}

/// Calls `visit` with the pieces between the `high` vertices of simplex number `number` and the others; one for N < 5.
template <int N, class Visit>
void visit_pieces(const std::array<Index, N>& simplex, Index number, unsigned high, const Visit& visit) {
  Piece piece;
  piece.simplex = number;
  if constexpr (N < 5) {
    const EdgesOfCut& edges = kEdgesOfCut<N>[high];
    piece.count = edges.count;
    for (int i = 0; i < edges.count; ++i)
      piece.points[i] = edge_point(simplex[edges.below[i]], simplex[edges.above[i]]);
    visit(piece);
  } else {
    const auto [sorted, odd] = sides_in_order(simplex, high);
    const TetrahedraOfCut& cut = kTetrahedraOfCut[static_cast<unsigned>(std::popcount(high))];
    piece.count = 4;
    for (int k = 0; k < cut.count; ++k) {
      for (int i = 0; i < 4; ++i) {
        const auto [above, below] = cut.points[k][i];
        piece.points[i] = edge_point(sorted[below], sorted[above]);
      }
      if (odd) std::swap(piece.points[2], piece.points[3]);
      visit(piece);
    }
  }
}

}  // namespace tegl::detail
