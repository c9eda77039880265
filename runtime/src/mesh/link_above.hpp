// SPDX-License-Identifier: BSD-3-Clause
//
// Counts the faces of triangles and tetrahedra that have a vertex as their smallest one, if the orientations of
// neighbours agree, as in nearly all stars of a contour. Other stars are left to the caller.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/link_numbers.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// N vertices per simplex, 3 or 4. Use one object per thread.
template <int N>
class LinkAbove {
  static_assert(N == 3 || N == 4);

 public:
  /// `rows`: #S x N, row = simplex. `with_edges`: whether `edges` counts all edges.
  LinkAbove(const Index* rows, std::size_t vertex_count, bool with_edges)
      : rows_(rows), least_(N == 3 || with_edges ? 1 : 2), numbers_(vertex_count) {
    out_.fill(0);
    in_.fill(0);
  }

  /// Loads the star of v, simplices that repeat no vertex. False if more than about 60 of the link's vertices are
  /// greater than v, or if an (N-2)-face with v as its smallest vertex is in three simplices or in two of the same
  /// orientation.
  [[nodiscard]] bool load(Index v, std::span<const Index> star) {
    for (unsigned a = 0; a < numbers_.size(); ++a) out_[a] = in_[a] = 0;
    Loading state(*this, v);
    for (std::size_t i = 0; i < star.size() && state.number.size() <= LinkNumbers::kMost - N; ++i) {
      const Index* const row = rows_ + std::size_t{star[i]} * N;
      unsigned above = 0;
      for (unsigned j = 0; j < N; ++j) above += row[j] > v ? 1 : 0;
      if (above >= least_) state.add(row);
    }
    numbers_.keep(state.number);
    simplices_ = state.simplices;
    ridges_ = state.ridges;
    return state.repeated == 0 && state.number.size() <= LinkNumbers::kMost - N;
  }

  /// Simplices, edges and (N-2)-faces of the last star whose smallest vertex is its centre.
  [[nodiscard]] std::uint64_t simplices() const noexcept { return simplices_; }
  [[nodiscard]] std::uint64_t edges() const noexcept { return numbers_.size(); }
  [[nodiscard]] std::uint64_t ridges() const noexcept { return N == 3 ? edges() : ridges_; }
  /// Calls on_open(others) for each of those (N-2)-faces that is in only one simplex, and returns their number.
  /// `others`: its vertices without the centre, ascending.
  template <class OnOpen>
  std::uint64_t visit_open(const OnOpen& on_open) const {
    std::uint64_t open = 0;
    for (unsigned a = 0; a < numbers_.size(); ++a) {
      const Index first = numbers_.vertex(a);
      if constexpr (N == 3) {
        if (out_[a] == in_[a]) continue;
        ++open;
        on_open(std::array<Index, 1>{first});
      } else {
        for (Set rest = out_[a] & ~in_[a]; rest != 0; rest &= rest - 1) {
          ++open;
          const Index second = numbers_.vertex(static_cast<unsigned>(std::countr_zero(rest)));
          on_open(first < second ? std::array<Index, 2>{first, second} : std::array<Index, 2>{second, first});
        }
      }
    }
    return open;
  }

 private:
  using Set = LinkNumbers::Set;
  static constexpr unsigned kBelow = LinkNumbers::kMost;  ///< in place of a number: a vertex below the centre

  /// A link while it is loaded. A local variable, whose members the compiler keeps in registers.
  struct Loading {
    Index v;
    LinkNumbers::Numbering number;
    Set* out;
    Set* in;
    std::uint64_t simplices = 0, ridges = 0;
    Set repeated = 0;  ///< not empty if a face was added twice with the same orientation

    Loading(LinkAbove& link, Index centre)
        : v(centre), number(link.numbers_, centre), out(link.out_.data()), in(link.in_.data()) {}

    /// Adds the (N-2)-faces of a simplex with v as their smallest vertex. Oriented so that v followed by the vertices
    /// of an arrow, and by the one that the arrow lacks, is the simplex. Without a branch: it depends irregularly on
    /// the simplex which vertices are above v.
    void add(const Index* row) {
      const OthersOfSimplex<N> others(row, v);
      std::array<unsigned, N - 1> at;
      std::array<Set, N - 1> one;  // empty for vertices below v
      bool is_least = true;
      for (unsigned i = 0; i + 1 < N; ++i) {
        const Index u = others[i];
        const bool is_above = u > v;
        is_least = is_least & is_above;
        at[i] = number.of_if(is_above, u, kBelow);
        one[i] = is_above ? LinkNumbers::one(at[i]) : 0;
      }
      simplices += is_least ? 1 : 0;
      if constexpr (N == 3) {  // one arrow; the faces are its ends
        put(out[at[0]], one[0] != 0 ? 1 : 0);
        put(in[at[1]], one[1] != 0 ? 1 : 0);
      } else {
        for (unsigned i = 0; i < 3; ++i) {
          const unsigned next = i == 2 ? 0 : i + 1;
          const bool is_counted = (one[i] != 0) & (one[next] != 0);
          const bool is_second = (in[at[i]] & one[next]) != 0;
          ridges += is_counted & !is_second ? 1 : 0;
          put(out[at[i]], is_counted ? one[next] : 0);
          in[at[next]] |= is_counted ? one[i] : 0;
        }
      }
    }

    void put(Set& set, Set members) noexcept {
      repeated |= set & members;
      set |= members;
    }
  };

  const Index* rows_;
  unsigned least_;       ///< simplices with fewer vertices above the centre are left out
  LinkNumbers numbers_;  ///< of vertices above the centre
  std::uint64_t simplices_ = 0, ridges_ = 0;
  /// By number: the vertices to which and from which there are arrows. N = 3: 1 if the vertex begins, if it ends an
  /// arrow.
  std::array<Set, LinkNumbers::kMost + 1> out_, in_;  // nothing at kBelow
};

}  // namespace tegl::detail
