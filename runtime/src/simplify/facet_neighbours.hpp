// SPDX-License-Identifier: BSD-3-Clause
//
// The simplex across each facet of a complex, if the facet is in exactly two simplices that are oriented alike.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/equal_keys.hpp"
#include "base/workers.hpp"
#include "mesh/faces_of_stars.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

template <int N>
class FacetNeighbours {
 public:
  static constexpr Index kNone = std::numeric_limits<Index>::max();

  FacetNeighbours(std::span<const std::array<Index, N>> simplices, std::size_t vertex_count, unsigned threads,
                  const Progress& progress)
      : across_(simplices.size()) {
    const std::span<const Index> rows(simplices.empty() ? nullptr : simplices[0].data(), simplices.size() * N);
    const Stars stars = make_stars<N>(rows, vertex_count, threads, part_of(progress, 0.0, 0.3));
    join(
        simplices, vertex_count, [&](std::size_t v) { return stars.of(v); }, threads, part_of(progress, 0.3, 1.0));
  }
  /// `star_of(v)`: the simplices at vertex v, ascending. Threads call it at the same time, for different vertices.
  template <class StarOf>
  FacetNeighbours(std::span<const std::array<Index, N>> simplices, std::size_t vertex_count, const StarOf& star_of,
                  unsigned threads, const Progress& progress)
      : across_(simplices.size()) {
    join(simplices, vertex_count, star_of, threads, progress);
  }
  /// For the same simplices in another order: simplex i is simplex `order[i]` of `other`, with its corners in the same
  /// places.
  FacetNeighbours(const FacetNeighbours& other, std::span<const Index> order, unsigned threads,
                  const Progress& progress)
      : across_(order.size()) {
    std::vector<Index> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<Index>(i);
    for_each_item(order.size(), threads, progress, [&](std::size_t i) {
      for (int corner = 0; corner < N; ++corner) {
        const Index next = other.across(order[i], corner);
        across_[i][corner] = next == kNone ? kNone : place[next];
      }
    });
  }

  /// The simplex across the facet opposite to this corner; kNone if the facet is on the border, in more than two
  /// simplices, or between simplices of opposite orientations.
  [[nodiscard]] Index across(Index simplex, int corner) const { return across_[simplex][corner]; }

  using Facet = std::array<Index, N - 1>;
  /// The vertices of the facet opposite to a corner, ascending. Returns whether the simplex induces that order.
  static bool facet_of(const std::array<Index, N>& row, int corner, Facet& facet) {
    for (int i = 0, k = 0; i < N; ++i)
      if (i != corner) facet[k++] = row[i];
    bool is_even = corner % 2 == 0;
    for (int i = 1; i < N - 1; ++i)  // insertion sort, to count the exchanges
      for (int j = i; j > 0 && facet[j] < facet[j - 1]; --j) {
        std::swap(facet[j], facet[j - 1]);
        is_even = !is_even;
      }
    return is_even;
  }

 private:
  /// A facet with v as its smallest vertex, seen from one of its simplices.
  struct Side {
    std::uint64_t others;  ///< the other vertices, ascending
    Index simplex;
    std::uint8_t corner;  ///< the corner opposite to the facet
    bool is_even;         ///< whether the simplex induces the ascending order of the vertices
  };

  struct Sides {
    std::vector<Side> all;
    EqualKeys equal;
  };

  template <class StarOf>
  void join(std::span<const std::array<Index, N>> simplices, std::size_t vertex_count, const StarOf& star_of,
            unsigned threads, const Progress& progress) {
    std::array<Index, N> none;
    none.fill(kNone);
    std::fill(across_.begin(), across_.end(), none);
    for_each_block(
        vertex_count, kBlock, threads, progress, [] { return Sides(); },
        [&](std::size_t, std::size_t from, std::size_t to, Sides& sides) {
          for (std::size_t v = from; v < to; ++v) join_at(static_cast<Index>(v), star_of(v), simplices, sides);
        });
  }

  /// Joins the simplices at the facets whose smallest vertex is v. Each facet is joined at one vertex, so no two
  /// threads write the same entry.
  void join_at(Index v, std::span<const Index> star, std::span<const std::array<Index, N>> simplices, Sides& sides) {
    sides.all.clear();
    for (const Index s : star)
      for (int corner = 0; corner < N; ++corner) add_side(v, simplices[s], s, corner, sides.all);
    for (const auto& group : sides.equal.groups(sides.all.size(), [&](auto i) { return sides.all[i].others; })) {
      const Side &a = sides.all[group.first], &b = sides.all[group.second];
      if (group.count != 2 || a.is_even == b.is_even) continue;
      across_[a.simplex][a.corner] = b.simplex;
      across_[b.simplex][b.corner] = a.simplex;
    }
  }

  static void add_side(Index v, const std::array<Index, N>& row, Index s, int corner, std::vector<Side>& sides) {
    if (row[corner] == v) return;
    for (int i = 0; i < N; ++i)
      if (i != corner && row[i] < v) return;
    Facet facet;
    const bool is_even = facet_of(row, corner, facet);
    std::uint64_t others = 0;
    for (int i = 1; i < N - 1; ++i) others = others << 32 | facet[i];
    sides.push_back({others, s, static_cast<std::uint8_t>(corner), is_even});
  }

  Buffer<std::array<Index, N>> across_;
};

}  // namespace tegl::detail
