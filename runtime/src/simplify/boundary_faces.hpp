// SPDX-License-Identifier: BSD-3-Clause
//
// The faces of a contour at which the orientations of its simplices do not cancel: its borders.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <tuple>
#include <vector>

#include "base/progress.hpp"
#include "mesh/faces_of_stars.hpp"
#include "mesh/vertex_stars.hpp"
#include "simplify/facet_neighbours.hpp"
#include "simplify/scaled_simplices.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Boundary of the chain of a contour's simplices. By simplex, bit i: the orientations at the face opposite to corner i
/// do not cancel.
template <int N>
class BoundaryFaces {
 public:
  BoundaryFaces(const ScaledSimplices<N>& contour, const FacetNeighbours<N>& neighbours, unsigned threads,
                const Progress& progress)
      : faces_(contour.simplices.size(), 0) {
    find_unjoined(contour.simplices, neighbours);
    // Vertices at equal places are identified: files may store each simplex with its own vertices.
    if (!ridges_.empty() && unite(contour)) find(contour.points.size(), threads, progress);
    rows_ = {};
  }
  [[nodiscard]] unsigned of(Index simplex) const { return faces_[simplex]; }

 private:
  using Ridge = typename FacesOfStars<N>::Ridge;

  /// Two simplices that are joined at a face cancel there, so only the others are compared.
  void find_unjoined(std::span<const std::array<Index, N>> simplices, const FacetNeighbours<N>& neighbours) {
    struct Side {
      Ridge ridge;
      Index simplex;
      std::uint8_t corner;
      bool is_even;
    };
    std::vector<Side> sides;
    for (Index s = 0; s < simplices.size(); ++s)
      for (int corner = 0; corner < N; ++corner) {
        if (neighbours.across(s, corner) != FacetNeighbours<N>::kNone) continue;
        if (repeats_a_vertex(simplices[s])) break;
        Side side{{}, s, static_cast<std::uint8_t>(corner), false};
        side.is_even = FacetNeighbours<N>::facet_of(simplices[s], corner, side.ridge);
        sides.push_back(side);
      }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
      return std::tie(a.ridge, a.simplex, a.corner) < std::tie(b.ridge, b.simplex, b.corner);
    });
    for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
      std::ptrdiff_t sum = 0;
      for (; j < sides.size() && sides[j].ridge == sides[i].ridge; ++j) sum += sides[j].is_even ? 1 : -1;
      if (sum == 0) continue;
      ridges_.push_back(sides[i].ridge);
      for (std::size_t k = i; k < j; ++k) faces_[sides[k].simplex] |= static_cast<std::uint8_t>(1u << sides[k].corner);
    }
  }

  static bool repeats_a_vertex(std::array<Index, N> simplex) {
    std::sort(simplex.begin(), simplex.end());
    return std::adjacent_find(simplex.begin(), simplex.end()) != simplex.end();
  }

  void find(std::size_t vertices, unsigned threads, const Progress& progress) {
    const std::span<const Index> rows(rows_.empty() ? nullptr : rows_[0].data(), rows_.size() * N);
    const Stars stars = make_stars<N>(rows, vertices, threads, part_of(progress, 0.0, 0.2));
    std::vector<std::vector<Ridge>> parts(block_count(vertices, kBlock));
    count_faces<N>(rows, stars, {}, 1, false, threads, part_of(progress, 0.2, 1.0),
                   [&](std::size_t block, const Ridge& ridge) { parts[block].push_back(ridge); });
    std::fill(faces_.begin(), faces_.end(), std::uint8_t{0});
    ridges_.clear();
    for (const auto& part : parts)
      for (const Ridge& ridge : part) {
        ridges_.push_back(ridge);
        for (const Index s : stars.of(ridge[0])) mark(s, ridge);
      }
  }

  void mark(Index s, const Ridge& ridge) {
    unsigned others = 0;
    for (int i = 0; i < N; ++i)
      if (std::find(ridge.begin(), ridge.end(), rows_[s][i]) == ridge.end()) others |= 1u << i;
    if (std::has_single_bit(others)) faces_[s] |= static_cast<std::uint8_t>(others);
  }

  /// Identifies vertices of open faces at equal places. Returns false if there are none.
  bool unite(const ScaledSimplices<N>& contour) {
    const Buffer<PointN<N>>& points = contour.points;
    std::vector<Index> open;
    for (const Ridge& ridge : ridges_) open.insert(open.end(), ridge.begin(), ridge.end());
    const auto before = [&](Index a, Index b) { return points[a] != points[b] ? points[a] < points[b] : a < b; };
    std::sort(open.begin(), open.end(), before);
    open.erase(std::unique(open.begin(), open.end()), open.end());
    std::vector<Index> first(points.size());
    std::iota(first.begin(), first.end(), Index{0});
    bool any = false;
    for (std::size_t i = 1; i < open.size(); ++i) {
      if (points[open[i]] != points[open[i - 1]]) continue;
      first[open[i]] = first[open[i - 1]];
      any = true;
    }
    if (!any) return false;
    rows_.assign(contour.simplices.begin(), contour.simplices.end());
    for (auto& row : rows_)
      for (Index& v : row) v = first[v];
    return true;
  }

  std::vector<std::array<Index, N>> rows_;
  std::vector<std::uint8_t> faces_;
  std::vector<Ridge> ridges_;
};

}  // namespace tegl::detail
