// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of vertices after those on the seam are merged. Each set of equal vertices keeps its smallest number. The
// last vertices move to the places of the merged ones, so that few simplices change.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "image/bitplanes.hpp"
#include "tegl/contour.hpp"
#include "tegl/tile/disjoint_sets.hpp"

namespace tegl::detail {

class SeamNumbers {
 public:
  /// `pairs` of equal vertices, of `total` vertices. O(total / 64 + pairs) time and memory.
  SeamNumbers(std::span<const std::pair<Index, Index>> pairs, std::size_t total) : marks_(total / kWordBits + 1) {
    for (const auto& [a, b] : pairs)
      for (const Index v : {a, b}) marks_[v / kWordBits] |= Word{1} << (v % kWordBits);
    for (const Word word : marks_) {
      ranks_.push_back(marked_);
      marked_ += static_cast<Index>(std::popcount(word));
    }
    BasicDisjointSets<Index> sets(marked_);
    for (const auto& [a, b] : pairs) dropped_ += sets.join(rank(a), rank(b)) ? 1 : 0;
    kept_ = static_cast<Index>(total - dropped_);
    number(sets);
  }

  /// Number of vertices after merging.
  [[nodiscard]] std::size_t kept() const noexcept { return kept_; }
  [[nodiscard]] std::size_t dropped() const noexcept { return dropped_; }
  /// Calls move(from, to) for each vertex that moves to the place of a merged one, and somewhat earlier request(to).
  template <class Request, class Move>
  void for_each_move(const Request& request, const Move& move) const {
    constexpr std::size_t kAhead = 16;
    for (std::size_t i = 0; i < tail_.size(); ++i) {
      if (i + kAhead < tail_.size()) request(tail_[i + kAhead]);
      if (const auto from = static_cast<Index>(kept_ + i); tail_[i] != from && !is_merged(from)) move(from, tail_[i]);
    }
  }
  /// The number after merging of a vertex's number before.
  [[nodiscard]] Index operator()(Index v) const noexcept {
    if (is_marked(v)) return of_marked_[rank(v)];
    return v < kept_ ? v : tail_[v - kept_];
  }

 private:
  [[nodiscard]] bool is_marked(Index v) const noexcept { return (marks_[v / kWordBits] >> (v % kWordBits) & 1u) != 0; }
  [[nodiscard]] bool is_merged(Index v) const noexcept { return is_marked(v) && is_merged_[rank(v)]; }
  [[nodiscard]] Index rank(Index v) const noexcept {
    const Word below = (Word{1} << (v % kWordBits)) - 1;
    return ranks_[v / kWordBits] + static_cast<Index>(std::popcount(marks_[v / kWordBits] & below));
  }

  void number(BasicDisjointSets<Index>& sets) {
    // the vertices on the seam, ascending
    std::vector<Index> vertices;
    vertices.reserve(marked_);
    for (std::size_t w = 0; w < marks_.size(); ++w)
      for (Word rest = marks_[w]; rest != 0; rest &= rest - 1)
        vertices.push_back(static_cast<Index>(w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest))));
    is_merged_.resize(marked_);
    for (Index i = 0; i < marked_; ++i) is_merged_[i] = sets.find(i) != i;
    // the last vertices that stay, in ascending order, to the places of merged ones
    tail_.resize(dropped_);
    std::size_t hole = 0;
    for (std::size_t i = 0; i < tail_.size(); ++i) {
      if (is_merged(static_cast<Index>(kept_ + i))) continue;
      while (!is_merged_[hole]) ++hole;
      tail_[i] = vertices[hole++];
    }
    of_marked_.resize(marked_);
    for (Index i = 0; i < marked_; ++i) {
      const Index v = vertices[sets.find(i)];
      of_marked_[i] = v < kept_ ? v : tail_[v - kept_];
    }
  }

  std::vector<Word> marks_;       ///< by vertex: whether it is on the seam
  std::vector<Index> ranks_;      ///< by word of `marks_`: marked vertices before it
  std::vector<bool> is_merged_;   ///< by marked vertex: another one of its set has the smallest number
  std::vector<Index> of_marked_;  ///< by marked vertex: number after merging
  std::vector<Index> tail_;       ///< by vertex from kept() on: number after merging, if it is not merged
  Index marked_ = 0, kept_ = 0;
  std::size_t dropped_ = 0;
};

}  // namespace tegl::detail
