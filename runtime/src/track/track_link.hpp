// SPDX-License-Identifier: BSD-3-Clause
//
// A complex swept through time, and the neighbourhood of each of its vertices: its star, and its lower and upper link.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/atomic_minimum.hpp"
#include "base/disjoint_sets.hpp"
#include "base/radix_sort.hpp"
#include "base/workers.hpp"
#include "mesh/incidence_data.hpp"
#include "mesh/measure_pieces.hpp"
#include "mesh/vertex_stars.hpp"
#include "track/face_list.hpp"
#include "track/link_sides.hpp"
#include "track/sides_across.hpp"
#include "track/sweep_result.hpp"

namespace tegl::detail {

/// A simplicial complex whose vertices are ordered by the last coordinate (time), then by number. Vertices have their
/// *ranks*, their positions in that order, and each simplex lists its vertices by rank: those below a vertex come
/// before it, those above it after it.
template <int N>
class SweptComplex {
 public:
  using Simplex = std::array<Index, N>;

  /// `incidence`: null if it is not known; must outlive the complex. Tetrahedra are then given one.
  SweptComplex(const SimplexView<N>& contour, const IncidenceData<N>* incidence, unsigned threads,
               const Progress& progress)
      : contour_(contour), incidence_(incidence) {
    rank_vertices(threads, part_of(progress, 0.0, 0.2));
    if constexpr (N == 4)
      if (incidence == nullptr) {
        own_ = make_incidence<4>(contour.rows(), contour.vertex_count(), false, threads, part_of(progress, 0.2, 0.7));
        incidence_ = &own_;
      }
    border_.assign(contour.simplices().size(), 0);
    in_border_.assign(contour.vertex_count(), 0);
    rank_simplices(threads, part_of(progress, 0.7, 0.75));
    if constexpr (N != 4)
      if (incidence_ == nullptr) {
        stars_ = make_stars<N>(flat_rows(std::span<const Simplex>(simplices_)), contour.vertex_count(), threads,
                               part_of(progress, 0.75, 0.77));
        find_border(threads, part_of(progress, 0.77, 0.8));
      }
    find_passages(threads, part_of(progress, 0.8, 1.0));
  }

  SweptComplex(const SweptComplex&) = delete;
  SweptComplex& operator=(const SweptComplex&) = delete;

  [[nodiscard]] const SimplexView<N>& contour() const { return contour_; }
  /// Vertices by rank, ascending.
  [[nodiscard]] const Simplex& simplex(Index s) const { return simplices_[s]; }
  [[nodiscard]] std::size_t vertex_count() const { return times_.size(); }
  [[nodiscard]] double time(Index v) const { return times_[v]; }
  /// Of all vertices, ascending.
  [[nodiscard]] std::span<const double> all_times() const { return times_; }
  /// Times of the lowest and the highest vertex of a simplex; 0 if there are none.
  [[nodiscard]] std::pair<double, double> times() const {
    if (simplices_.empty()) return {0.0, 0.0};
    return {times_[lowest_], times_[times_.size() - 1 - from_highest_]};
  }
  /// The vertex of the contour.
  [[nodiscard]] Index vertex(Index rank) const { return order_[rank]; }
  /// Simplices around a vertex, ascending, without those that repeat a vertex.
  [[nodiscard]] std::span<const Index> star(Index v) const {
    return incidence_ != nullptr ? incidence_->stars.of(order_[v]) : stars_.of(v);
  }
  /// N = 4: by place, the simplex across the facet without that vertex, or a constant of Incidence.
  [[nodiscard]] const Simplex& across(Index s) const { return across_[s]; }
  /// N = 4: fetches the rows of a simplex. Inlined, as GCC omits calls of functions that only fetch.
  [[gnu::always_inline]] void prefetch(Index s) const {
    __builtin_prefetch(&simplices_[s]);
    __builtin_prefetch(&across_[s]);
  }
  /// Bit i: the facet without vertex i is in no other simplex (border).
  [[nodiscard]] unsigned border(Index s) const { return border_[s]; }
  /// The same for positions in the simplex of the contour.
  [[nodiscard]] unsigned border_of_contour(Index s) const {
    unsigned border = 0;
    for (int i = 0; border_[s] != 0 && i < N; ++i) {
      const Index rank = rank_[contour_.simplices()[s][i]];
      const auto at = std::find(simplices_[s].begin(), simplices_[s].end(), rank) - simplices_[s].begin();
      border |= ((border_[s] >> at) & 1u) << i;
    }
    return border;
  }
  /// How the level set passes a vertex whose lower and upper link are connected and not empty: no component begins,
  /// ends, merges or splits there.
  struct Passage {
    Index below = kNone;      ///< a cell just below the vertex; kNone if the above does not hold, or is not known
    Index front = kNone;      ///< the lowest vertex of that cell
    std::int32_t growth = 0;  ///< cells that begin at the vertex minus those that end
    std::int32_t euler = 0;   ///< change of the level set's Euler characteristic: 0 except in the border
  };
  /// Unknown for some vertices whose links are large.
  [[nodiscard]] const Passage& passage(Index v) const { return passages_[v]; }

 private:
  struct Timed {
    std::uint64_t key;  ///< as ordered as the time
    Index vertex;
  };
  /// Radix sort by the bits of the times, which are finite.
  void rank_vertices(unsigned threads, const Progress& progress) {
    const std::size_t count = contour_.vertex_count();
    std::vector<Timed> timed(count);
    for_each_item(count, threads, part_of(progress, 0.0, 0.2), [&](std::size_t v) {
      const double time = contour_.coordinate(static_cast<Index>(v), N - 1) + 0.0;  // no negative zero
      constexpr std::uint64_t kNegative = std::uint64_t{1} << 63;
      const auto bits = std::bit_cast<std::uint64_t>(time);
      timed[v] = {(bits & kNegative) != 0 ? ~bits : bits | kNegative, static_cast<Index>(v)};
    });
    sort_by_bits(
        timed, 64, [](const Timed& vertex) { return vertex.key; }, threads);
    tell(progress, 0.8);
    order_.resize(count);
    rank_.resize(count);
    times_.resize(count);
    for_each_item(count, threads, part_of(progress, 0.8, 1.0), [&](std::size_t i) {
      order_[i] = timed[i].vertex;
      rank_[timed[i].vertex] = static_cast<Index>(i);
      times_[i] = contour_.coordinate(timed[i].vertex, N - 1);
    });
  }

  /// Also finds the border if the incidence is known.
  void rank_simplices(unsigned threads, const Progress& progress) {
    simplices_.resize(contour_.simplices().size());
    const Simplex* across = incidence_ != nullptr ? incidence_->across.data() : nullptr;
    if constexpr (N == 4) {
      if (incidence_ == &own_)
        across_ = std::move(own_.across);  // ordered in place
      else
        across_.resize(simplices_.size());
      if (incidence_ == &own_) across = across_.data();
    }
    for_each_part(simplices_.size(), threads, progress, [&](std::size_t from, std::size_t to) {
      Index lowest = kNone, highest = 0;
      for (std::size_t s = from; s < to; ++s) {
        rank_simplex(s, across);
        lowest = std::min(lowest, simplices_[s].front());
        highest = std::max(highest, simplices_[s].back());
      }
      lower_to(lowest_, lowest);
      lower_to(from_highest_, times_.size() - 1 - highest);
    });
  }
  void rank_simplex(std::size_t s, const Simplex* across) {
    Simplex given;
    for (int i = 0; i < N; ++i) given[i] = rank_[contour_.simplices()[s][i]];
    Simplex there;
    there.fill(kSeveralSimplices);
    if (across != nullptr) there = across[s];
    Simplex ranks{}, sorted_across{};
    for (int i = 0; i < N; ++i) {
      int place = 0;
      for (int j = 0; j < N; ++j) place += (j < i ? given[j] <= given[i] : given[j] < given[i]) ? 1 : 0;
      ranks[place] = given[i];
      sorted_across[place] = there[i];
    }
    simplices_[s] = ranks;
    if constexpr (N == 4) across_[s] = sorted_across;
    if (std::find(there.begin(), there.end(), kNoSimplex) != there.end()) mark_border(s, sorted_across);
  }
  void mark_border(std::size_t s, const Simplex& across) {
    const Simplex& simplex = simplices_[s];
    if (is_collapsed<N>(simplex.data())) return;
    unsigned border = 0;
    for (int i = 0; i < N; ++i) {
      if (across[i] != kNoSimplex) continue;
      border |= 1u << i;
      for (int j = 0; j < N; ++j)
        if (j != i) std::atomic_ref(in_border_[simplex[j]]).store(1, std::memory_order_relaxed);
    }
    border_[s] = static_cast<std::uint8_t>(border);
  }

  void find_border(unsigned threads, const Progress& progress) {
    for_each_block(
        contour_.vertex_count(), kBlock, threads, progress,
        [&] { return SingleFaces<N>(simplices_, contour_.vertex_count()); },
        [&](std::size_t, std::size_t from, std::size_t to, SingleFaces<N>& faces) {
          for (std::size_t v = from; v < to; ++v)
            faces.visit(static_cast<Index>(v), star(static_cast<Index>(v)), [&](Index s, int omitted) {
              // Another thread may set another bit of the same simplex.
              std::atomic_ref(border_[s]).fetch_or(static_cast<std::uint8_t>(1u << omitted), std::memory_order_relaxed);
              for (int i = 0; i < N; ++i)
                if (i != omitted) std::atomic_ref(in_border_[simplices_[s][i]]).store(1, std::memory_order_relaxed);
            });
        });
  }

  void find_passages(unsigned threads, const Progress& progress) {
    passages_.resize(contour_.vertex_count());
    for_each_block(
        contour_.vertex_count(), kBlock, threads, progress,
        [&] { return LinkSides<N>(simplices_, contour_.vertex_count()); },
        [&](std::size_t, std::size_t from, std::size_t to, LinkSides<N>& links) {
          std::vector<StarSides> sides(N == 4 ? to - from : 0);
          if constexpr (N == 4)
            find_sides({simplices_.data(), across_.data(), incidence_->stars}, from,
                       std::span<const Index>(rank_).subspan(from, to - from), sides);
          for (std::size_t i = from; i < to; ++i) {  // in the order of the contour: stars are near each other
            const Index v = rank_[i];
            passages_[v] = {};
            if (N == 4 && sides[i - from].are_connected) {
              const auto [below, growth, connected] = sides[i - from];
              passages_[v] = {below, simplices_[below].front(), growth, 0};
              continue;
            }
            // In 5D the level set's Euler characteristic may change at the border; the sweep computes by how much.
            if (N == 5 && in_border_[v] != 0) continue;
            if (!links.are_connected(v, star(v))) continue;
            passages_[v] = count_cells(v);
            if constexpr (N == 4)
              if (in_border_[v] != 0) passages_[v].euler = static_cast<std::int32_t>(links.euler_change(v, star(v)));
          }
        });
  }
  [[nodiscard]] Passage count_cells(Index v) const {
    Passage passage;
    for (const Index s : star(v)) {
      const Simplex& simplex = simplices_[s];
      const bool begins = simplex.front() == v;
      passage.growth += (begins ? 1 : 0) - (simplex.back() == v ? 1 : 0);
      passage.below = begins ? passage.below : s;
      passage.front = begins ? passage.front : simplex.front();
    }
    return passage;
  }

  SimplexView<N> contour_;
  IncidenceData<N> own_;  ///< N = 4, if none was given; without `across`
  const IncidenceData<N>* incidence_;
  Buffer<Index> order_;
  Buffer<Index> rank_;
  Buffer<double> times_;       ///< by rank
  Buffer<Simplex> simplices_;  ///< by ranks
  /// Minimum rank of the vertices of simplices, and the number of ranks above the maximum.
  std::atomic<std::size_t> lowest_ = kNone, from_highest_ = kNone;
  /// N = 4: the simplices across the facet without the vertex at the same place, or constants of Incidence.
  Buffer<Simplex> across_;
  Stars stars_;  ///< empty if the incidence is known
  std::vector<std::uint8_t> border_;
  std::vector<std::uint8_t> in_border_;  ///< by vertex: whether it is in the border
  Buffer<Passage> passages_;
};

/// Star and link of one vertex at a time.
template <int N>
class VertexStar {
 public:
  explicit VertexStar(const SweptComplex<N>& complex)
      : complex_(complex), met_(complex.vertex_count(), kNone), number_(complex.vertex_count()) {}

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
  [[nodiscard]] bool is_above(Index u) const { return u > v_; }

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
