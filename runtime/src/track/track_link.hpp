// SPDX-License-Identifier: BSD-3-Clause
//
// The neighbourhood of a vertex of a swept complex: its star, and its lower and upper link.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/workers.hpp"
#include "mesh/measure_pieces.hpp"
#include "mesh/vertex_stars.hpp"
#include "track/sweep_result.hpp"

namespace tegl::detail {

/// A list of faces by their vertices, which counts each face once.
template <int N>
class Faces {
 public:
  void clear() { keys_.clear(); }

  /// Adds the faces of a simplex (vertices[0 … count - 1]) for which wanted(mask) is true; bit i of mask: vertex i.
  template <class Wanted>
  void add(const std::array<Index, N>& vertices, int count, const Wanted& wanted) {
    for (unsigned mask = 1; mask < (1u << count); ++mask) {
      if (!wanted(mask)) continue;
      Key key;
      key.fill(kNone);
      int size = 0;
      for (int i = 0; i < count; ++i)
        if (((mask >> i) & 1u) != 0) key[size++] = vertices[i];
      std::sort(key.begin(), key.begin() + size);
      keys_.push_back(key);
    }
  }

  /// Euler characteristic: number of vertices - edges + triangles - …
  [[nodiscard]] std::int64_t euler() {
    std::sort(keys_.begin(), keys_.end());
    const auto end = std::unique(keys_.begin(), keys_.end());
    std::int64_t sum = 0;
    for (auto key = keys_.begin(); key != end; ++key) {
      const auto dim = std::find(key->begin(), key->end(), kNone) - key->begin() - 1;
      sum += dim % 2 == 0 ? 1 : -1;
    }
    return sum;
  }

 private:
  using Key = std::array<Index, N>;
  std::vector<Key> keys_;
};

/// A simplicial complex whose vertices are ordered by the last coordinate (time).
template <int N>
class SweptComplex {
 public:
  using Simplex = std::array<Index, N>;

  SweptComplex(const SimplexView<N>& contour, unsigned threads, const Progress& progress)
      : contour_(contour), stars_(make_stars<N>(contour.rows(), contour.vertex_count(), threads, part_of(progress, 0.0, 0.3))) {
    rank_vertices(part_of(progress, 0.3, 0.5));
    find_border(threads, part_of(progress, 0.5, 1.0));
  }

  [[nodiscard]] const SimplexView<N>& contour() const { return contour_; }
  [[nodiscard]] const Simplex& simplex(Index s) const { return contour_.simplices()[s]; }
  [[nodiscard]] double time(Index v) const { return contour_.coordinate(v, N - 1); }
  /// Vertices by time, then number; `rank` is the position of a vertex in that order.
  [[nodiscard]] std::span<const Index> order() const { return order_; }
  [[nodiscard]] Index rank(Index v) const { return rank_[v]; }
  /// Simplices around a vertex, ascending, without those that repeat a vertex.
  [[nodiscard]] std::span<const Index> star(Index v) const { return stars_.of(v); }
  /// Bit i: the facet without vertex i is in no other simplex (border).
  [[nodiscard]] unsigned border(Index s) const { return border_[s]; }

 private:
  /// Merge sort in parts, so that progress can be reported in between.
  void rank_vertices(const Progress& progress) {
    constexpr std::size_t kPart = std::size_t{1} << 16;
    const auto comes_first = [&](Index a, Index b) {
      const double ta = time(a);
      const double tb = time(b);
      return ta != tb ? ta < tb : a < b;
    };
    const std::size_t count = contour_.vertex_count();
    order_.resize(count);
    rank_.resize(count);
    std::iota(order_.begin(), order_.end(), Index{0});
    const auto at = [&](Buffer<Index>& of, std::size_t i) {
      return of.begin() + static_cast<std::ptrdiff_t>(std::min(i, count));
    };
    // sort each part
    in_parts(
        count, part_of(progress, 0.0, 0.5),
        [&](std::size_t from, std::size_t to) { std::sort(at(order_, from), at(order_, to), comes_first); }, kPart);
    tell(progress, 0.5);
    Buffer<Index>& merged = rank_;  // unused so far: scratch for merging
    // merge parts in pairs
    for (std::size_t size = kPart; size < count; size *= 2) {
      in_parts(
          count, {},
          [&](std::size_t from, std::size_t to) {
            std::merge(at(order_, from), at(order_, from + size), at(order_, from + size), at(order_, to),
                       at(merged, from), comes_first);
            tell(progress, 0.5);
          },
          2 * size);
      order_.swap(merged);
    }
    for (std::size_t i = 0; i < count; ++i) rank_[order_[i]] = static_cast<Index>(i);
  }

  /// A facet of a simplex, without its lowest-numbered vertex, at which it is searched.
  struct Facet {
    std::array<Index, N - 2> others;
    Index simplex;
    int omitted;
    bool operator<(const Facet& other) const { return others < other.others; }
  };

  void find_border(unsigned threads, const Progress& progress) {
    border_.assign(contour_.simplices().size(), 0);
    for_each_block(
        contour_.vertex_count(), kBlock, threads, progress, [] { return std::vector<Facet>(); },
        [&](std::size_t, std::size_t from, std::size_t to, std::vector<Facet>& facets) {
          for (std::size_t v = from; v < to; ++v) find_border_at(static_cast<Index>(v), facets);
        });
  }

  void find_border_at(Index v, std::vector<Facet>& facets) {
    facets.clear();
    for (const Index s : star(v))
      for (int omitted = 0; omitted < N; ++omitted) {
        const Simplex& all = simplex(s);
        Facet facet{{}, s, omitted};
        bool is_least = all[omitted] != v;
        for (int i = 0, k = 0; i < N && is_least; ++i) {
          if (i == omitted || all[i] == v) continue;
          is_least = all[i] > v;
          facet.others[k++] = all[i];
        }
        if (!is_least) continue;
        std::sort(facet.others.begin(), facet.others.end());
        facets.push_back(facet);
      }
    std::sort(facets.begin(), facets.end());
    for (std::size_t i = 0, j = 0; i < facets.size(); i = j) {
      while (j < facets.size() && facets[j].others == facets[i].others) ++j;
      // Another thread may set another bit of the same simplex.
      if (j - i == 1)
        std::atomic_ref(border_[facets[i].simplex]).fetch_or(static_cast<std::uint8_t>(1u << facets[i].omitted));
    }
  }

  SimplexView<N> contour_;
  Stars stars_;
  Buffer<Index> order_;
  Buffer<Index> rank_;
  std::vector<std::uint8_t> border_;
};

/// Star and link of one vertex at a time.
template <int N>
class VertexStar {
 public:
  explicit VertexStar(const SweptComplex<N>& complex)
      : complex_(complex), met_(complex.order().size(), kNone), number_(complex.order().size()) {}

  void load(Index v) {
    v_ = v;
    link_.clear();
    cells_ = complex_.star(v);
    for (const Index s : cells_)
      for (const Index u : complex_.simplex(s)) {
        if (u == v || met_[u] == v) continue;
        met_[u] = v;
        number_[u] = static_cast<Index>(link_.size());
        link_.push_back(u);
      }
    sets_.reset(link_.size());
    for (const Index s : cells_) join_sides(complex_.simplex(s));
    parts_ = {0, 0};
    for (const Index u : link_)
      if (sets_.find(number_[u]) == number_[u]) ++parts_[is_above(u) ? 1 : 0];
  }

  [[nodiscard]] std::span<const Index> cells() const { return cells_; }
  /// Number of connected components of the lower and the upper link.
  [[nodiscard]] Index parts_below() const { return parts_[0]; }
  [[nodiscard]] Index parts_above() const { return parts_[1]; }

  /// The component of the lower or upper link that contains vertices of a cell: a number below `link_size`; kNone if
  /// the cell has no vertex on that side.
  [[nodiscard]] Index part(Index s, bool above) {
    for (const Index u : complex_.simplex(s))
      if (u != v_ && is_above(u) == above) return sets_.find(number_[u]);
    return kNone;
  }
  [[nodiscard]] std::size_t link_size() const { return link_.size(); }

  [[nodiscard]] std::int64_t euler(bool above) {
    faces_.clear();
    for (const Index s : cells_) {
      std::array<Index, N> side{};
      int count = 0;
      for (const Index u : complex_.simplex(s))
        if (u != v_ && is_above(u) == above) side[count++] = u;
      faces_.add(side, count, [](unsigned) { return true; });
    }
    return faces_.euler();
  }

  [[nodiscard]] bool at_border() const {
    for (const Index s : cells_) {
      const unsigned open = complex_.border(s);
      for (int i = 0; open != 0 && i < N; ++i)
        if (((open >> i) & 1u) != 0 && complex_.simplex(s)[i] != v_) return true;
    }
    return false;
  }

  [[nodiscard]] Flatness flatness() const {
    Flatness result = Flatness::none;
    for (const Index s : cells_) {
      unsigned level = 0;
      for (int i = 0; i < N; ++i) level |= complex_.time(complex_.simplex(s)[i]) == complex_.time(v_) ? 1u << i : 0u;
      constexpr unsigned kAll = (1u << N) - 1;
      if (level == kAll) result = std::max(result, Flatness::simplex);
      for (int i = 0; i < N; ++i)
        if (((complex_.border(s) >> i) & 1u) != 0 && (level | (1u << i)) == kAll && complex_.simplex(s)[i] != v_)
          result = Flatness::border;
    }
    return result;
  }

 private:
  [[nodiscard]] bool is_above(Index u) const { return complex_.rank(u) > complex_.rank(v_); }

  /// Connects the vertices of a cell on each side.
  void join_sides(const std::array<Index, N>& simplex) {
    std::array<Index, 2> last{kNone, kNone};
    for (const Index u : simplex) {
      if (u == v_) continue;
      Index& side = last[is_above(u) ? 1 : 0];
      if (side != kNone) sets_.join(number_[side], number_[u]);
      side = u;
    }
  }

  const SweptComplex<N>& complex_;
  Index v_ = kNone;
  std::span<const Index> cells_;
  std::vector<Index> met_;  ///< by vertex: the last vertex in whose link it was met
  std::vector<Index> number_;
  std::vector<Index> link_;
  DisjointSets sets_;
  std::array<Index, 2> parts_{};
  Faces<N> faces_;
};

}  // namespace tegl::detail
