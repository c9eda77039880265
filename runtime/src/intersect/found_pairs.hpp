// SPDX-License-Identifier: BSD-3-Clause
//
// Intersecting pairs, counted, of which only the first few are kept.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "tegl/intersections.hpp"

namespace tegl::detail {

/// A set of simplices, one bit each. Simplices may be added concurrently.
class SimplexSet {
 public:
  explicit SimplexSet(std::size_t simplices) : words_((simplices + 63) / 64) {}

  void add(Index s) noexcept {
    const std::atomic_ref word(words_[s / 64]);
    const std::uint64_t bit = std::uint64_t{1} << s % 64;
    if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
  }
  [[nodiscard]] bool contains(Index s) const noexcept { return (words_[s / 64] >> s % 64 & 1u) != 0; }
  [[nodiscard]] std::uint64_t size() const noexcept {
    std::uint64_t result = 0;
    for (const std::uint64_t word : words_) result += static_cast<std::uint64_t>(std::popcount(word));
    return result;
  }

 private:
  std::vector<std::uint64_t> words_;
};

/// Counts pairs, and keeps at most `most` of them: the first ones by numbers, or by depth, the deepest first. The
/// result does not depend on the order in which pairs are added.
template <int N>
class FoundPairs {
 public:
  using Pair = IntersectingPair<N>;

  FoundPairs(std::size_t most, bool deepest_first) : most_(most), deepest_first_(deepest_first) {}

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// The maximum depth of all pairs.
  [[nodiscard]] double depth() const noexcept { return depth_; }

  void add(const Pair& pair) {
    ++count_;
    depth_ = std::max(depth_, pair.depth);
    keep(pair);
  }
  /// Adds the pairs of another object with the same options, and clears it.
  void take(FoundPairs& other) {
    count_ += std::exchange(other.count_, 0);
    depth_ = std::max(depth_, std::exchange(other.depth_, 0.0));
    for (const Pair& pair : other.pairs_) keep(pair);
    other.pairs_.clear();
    other.is_full_ = false;
  }
  /// The first pairs in their order; they are removed.
  [[nodiscard]] std::vector<Pair> first_pairs() {
    if (pairs_.size() > most_) shorten();
    std::sort(pairs_.begin(), pairs_.end(), [this](const Pair& p, const Pair& q) { return is_before(p, q); });
    return std::move(pairs_);
  }

 private:
  [[nodiscard]] bool is_before(const Pair& p, const Pair& q) const noexcept {
    if (deepest_first_ && p.depth != q.depth) return p.depth > q.depth;
    return p.first != q.first ? p.first < q.first : p.second < q.second;
  }
  void keep(const Pair& pair) {
    if (most_ == 0 || (is_full_ && !is_before(pair, last_))) return;
    pairs_.push_back(pair);
    if (pairs_.size() / 2 >= most_) shorten();
  }
  /// Removes all but the first `most_`.
  void shorten() {
    const auto last = pairs_.begin() + static_cast<std::ptrdiff_t>(most_ - 1);
    std::nth_element(pairs_.begin(), last, pairs_.end(),
                     [this](const Pair& p, const Pair& q) { return is_before(p, q); });
    pairs_.resize(most_);
    last_ = pairs_.back();
    is_full_ = true;
  }

  std::size_t most_;
  bool deepest_first_;
  std::uint64_t count_ = 0;
  double depth_ = 0.0;
  std::vector<Pair> pairs_;  ///< fewer than 2 most_
  bool is_full_ = false;     ///< most_ pairs up to last_ are in pairs_
  Pair last_{};
};

}  // namespace tegl::detail
