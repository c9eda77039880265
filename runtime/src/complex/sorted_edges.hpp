// SPDX-License-Identifier: BSD-3-Clause
//
// Edges of cells without duplicates: of a block of cells in a hash table, of all cells sorted by ranges of
// their smaller ends, then by smaller ends.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// The ends of an edge: the smaller number of a point first.
using EdgeEnds = std::array<Index, 2>;

/// Distinct edges in the order of their first occurrence. A hash table with open addressing: small, as it only has the
/// edges of one block, so that it stays in the nearest caches.
class EdgeSet {
 public:
  /// Removes all edges. `edges`: how many will be added, equal ones included.
  void clear(std::size_t edges) {
    // As many of them are expected to be distinct as of those before: a fifth in a tetrahedral mesh, two fifths in a
    // mixed one. A table that is too small at first takes longer, as its edges are added again.
    if (added_ > 0) share_ = static_cast<double>(size_) / static_cast<double>(added_);
    added_ = edges;
    size_ = 0;
    const double distinct = 1.05 * share_ * static_cast<double>(edges);
    resize(std::bit_ceil(std::max<std::size_t>(64, kSlotsPerEdge * static_cast<std::size_t>(distinct))));
  }

  /// The number of an edge, which is added if it is new.
  Index add(Index p, Index q) {
    const std::uint64_t edge = std::uint64_t{std::min(p, q)} << 32 | std::max(p, q);
    if (size_ == edges_.size()) grow();
    // A free slot has a larger number than all edges. The edge at size_ is the new one, so that one comparison finds
    // both an old edge and a free slot: which of the two it is cannot be predicted.
    edges_[size_] = edge;
    for (std::size_t slot = slot_of(edge);; slot = (slot + 1) & (slots_.size() - 1)) {
      const Index number = std::min(slots_[slot], static_cast<Index>(size_));
      if (edges_[number] != edge) continue;
      slots_[slot] = number;
      size_ += number == size_ ? 1 : 0;
      return number;
    }
  }

  /// The edges by number.
  [[nodiscard]] std::vector<EdgeEnds> edges() const {
    std::vector<EdgeEnds> ends(size_);
    for (std::size_t i = 0; i < size_; ++i)
      ends[i] = {static_cast<Index>(edges_[i] >> 32), static_cast<Index>(edges_[i])};
    return ends;
  }

 private:
  static constexpr Index kFree = std::numeric_limits<Index>::max();
  static constexpr std::size_t kSlotsPerEdge = 4;  // at least

  [[nodiscard]] std::size_t slot_of(std::uint64_t edge) const noexcept {
    return static_cast<std::size_t>((edge * 0x9e3779b97f4a7c15u) >> shift_);
  }
  void resize(std::size_t slots) {
    slots_.assign(slots, kFree);
    shift_ = 64 - static_cast<unsigned>(std::countr_zero(slots));
    edges_.resize(slots / kSlotsPerEdge);
  }
  void grow() {
    resize(2 * slots_.size());
    for (std::size_t i = 0; i < size_; ++i) {
      std::size_t slot = slot_of(edges_[i]);
      while (slots_[slot] != kFree) slot = (slot + 1) & (slots_.size() - 1);
      slots_[slot] = static_cast<Index>(i);
    }
  }

  std::vector<Index> slots_;  ///< numbers of edges; a power of two
  unsigned shift_ = 0;
  std::vector<std::uint64_t> edges_;  ///< the first size_, and free ones; the smaller end is in the upper half
  std::size_t size_ = 0;
  std::size_t added_ = 0;  ///< how many were to be added
  double share_ = 0.2;     ///< of distinct edges
};

/// Edges in ascending order.
class SortedEdges {
 public:
  SortedEdges() = default;
  /// `visit(part, add)` calls add(p, q) for the edges in part 0 ... parts - 1, in any order and any number of times; it
  /// is called twice for each part, on several threads. O(E log e) time for E calls of `add` and at most e at a point,
  /// O(E + points) memory. Errors: Cancelled.
  template <class Visit>
  SortedEdges(std::size_t points, std::size_t parts, const Visit& visit, const WorkOptions& work);

  [[nodiscard]] const std::vector<EdgeEnds>& ends() const noexcept { return ends_; }
  [[nodiscard]] std::vector<EdgeEnds> take_ends() noexcept { return std::move(ends_); }

  /// The number of an edge that is there.
  [[nodiscard]] std::uint64_t number(Index p, Index q) const noexcept {
    const EdgeEnds edge{std::min(p, q), std::max(p, q)};
    std::uint64_t i = first_[edge[0]];
    if (const std::uint64_t end = first_[edge[0] + std::size_t{1}]; end - i > kFew)
      return static_cast<std::uint64_t>(std::lower_bound(ends_.begin() + static_cast<std::ptrdiff_t>(i),
                                                         ends_.begin() + static_cast<std::ptrdiff_t>(end), edge) -
                                        ends_.begin());
    while (ends_[i][1] != edge[1]) ++i;
    return i;
  }

 private:
  static constexpr std::uint64_t kFew =
      32;  ///< up to this many edges at a point, comparing one after the other is fast

  /// At most 2^kRangeBits + 1 ranges of points.
  static constexpr unsigned kRangeBits = 8;
  struct RangeScratch {
    std::vector<std::uint64_t> bucket;
    std::vector<Index> others;
  };

  /// Sorts edges whose smaller ends are `from` and the points after it, and drops duplicates. `ends` receives for each
  /// point the number of edges up to its last one. Returns their number.
  static std::uint64_t sort_range(std::span<EdgeEnds> edges, std::size_t from, std::span<std::uint64_t> ends,
                                  RangeScratch& scratch);
  /// Sorts larger ends and drops duplicates; returns how many are left.
  static std::uint64_t make_unique(Index* begin, Index* end);

  std::vector<std::uint64_t> first_;  ///< first edge of each point, and the number of edges
  std::vector<EdgeEnds> ends_;
};

template <class Visit>
SortedEdges::SortedEdges(std::size_t points, std::size_t parts, const Visit& visit, const WorkOptions& work) {
  // Edges go to ranges of smaller ends first: then no two threads write to one place, and a range fits the cache.
  const auto bits = static_cast<unsigned>(std::bit_width(points));
  const unsigned shift = bits > kRangeBits ? bits - kRangeBits : 0;
  const std::size_t ranges = (points >> shift) + 1;
  // count by part and range, exclusive scan with all parts of a range together
  std::vector<std::uint64_t> next(parts * ranges, 0);
  for_each_block(parts, 1, work.threads, part_of(work.progress, 0.0, 0.25),
                 [&](std::size_t part, std::size_t, std::size_t) {
                   std::uint64_t* const counts = next.data() + part * ranges;
                   visit(part, [&](Index p, Index q) { ++counts[std::min(p, q) >> shift]; });
                 });
  std::vector<std::uint64_t> begin(ranges + 1, 0);
  std::uint64_t sum = 0;
  for (std::size_t r = 0; r < ranges; ++r) {
    begin[r] = sum;
    for (std::size_t part = 0; part < parts; ++part) {
      const std::uint64_t count = next[part * ranges + r];
      next[part * ranges + r] = sum;
      sum += count;
    }
  }
  begin[ranges] = sum;
  // write
  std::vector<EdgeEnds> all(sum);
  for_each_block(parts, 1, work.threads, part_of(work.progress, 0.25, 0.5),
                 [&](std::size_t part, std::size_t, std::size_t) {
                   std::uint64_t* const place = next.data() + part * ranges;
                   visit(part, [&](Index p, Index q) {
                     all[place[std::min(p, q) >> shift]++] = {std::min(p, q), std::max(p, q)};
                   });
                 });
  // sort each range, and keep its edges at its beginning
  first_.assign(points + 1, 0);
  std::vector<std::uint64_t> kept(ranges + 1, 0);
  for_each_block(
      ranges, 1, work.threads, part_of(work.progress, 0.5, 0.9), [] { return RangeScratch(); },
      [&](std::size_t r, std::size_t, std::size_t, RangeScratch& scratch) {
        const std::size_t from = r << shift, to = std::min(points, (r + 1) << shift);
        const std::span<EdgeEnds> edges(all.data() + begin[r], all.data() + begin[r + 1]);
        kept[r + 1] = from < to ? sort_range(edges, from, {first_.data() + from + 1, to - from}, scratch) : 0;
      });
  for (std::size_t r = 0; r < ranges; ++r) kept[r + 1] += kept[r];
  // copy
  ends_.resize(kept.back());
  for_each_block(ranges, 1, work.threads, part_of(work.progress, 0.9, 1.0),
                 [&](std::size_t r, std::size_t, std::size_t) {
                   std::copy_n(all.data() + begin[r], kept[r + 1] - kept[r], ends_.data() + kept[r]);
                   for (std::size_t p = r << shift; p < std::min(points, (r + 1) << shift); ++p)
                     first_[p + 1] += kept[r];
                 });
}

inline std::uint64_t SortedEdges::sort_range(std::span<EdgeEnds> edges, std::size_t from, std::span<std::uint64_t> ends,
                                             RangeScratch& scratch) {
  // larger ends by smaller end: count, exclusive scan, write; afterwards bucket[p] is the end of point p
  std::vector<std::uint64_t>& bucket = scratch.bucket;
  bucket.assign(ends.size(), 0);
  for (const EdgeEnds& edge : edges) ++bucket[edge[0] - from];
  std::uint64_t sum = 0;
  for (std::uint64_t& start : bucket) {
    const std::uint64_t count = start;
    start = sum;
    sum += count;
  }
  scratch.others.resize(edges.size());
  for (const EdgeEnds& edge : edges) scratch.others[bucket[edge[0] - from]++] = edge[1];
  // drop duplicates
  std::uint64_t kept = 0;
  for (std::size_t p = 0; p < ends.size(); ++p) {
    Index* const others = scratch.others.data() + (p == 0 ? 0 : bucket[p - 1]);
    const std::uint64_t count = make_unique(others, scratch.others.data() + bucket[p]);
    for (std::uint64_t i = 0; i < count; ++i) edges[kept++] = {static_cast<Index>(from + p), others[i]};
    ends[p] = kept;
  }
  return kept;
}

inline std::uint64_t SortedEdges::make_unique(Index* begin, Index* end) {
  if (end - begin > 64) {
    std::sort(begin, end);
    return static_cast<std::uint64_t>(std::unique(begin, end) - begin);
  }
  // insert one after the other: most are there already
  Index* last = begin;
  for (const Index* from = begin; from != end; ++from) {
    const Index value = *from;
    Index* at = last;
    while (at != begin && at[-1] > value) --at;
    if (at != begin && at[-1] == value) continue;
    std::move_backward(at, last, last + 1);
    *at = value;
    ++last;
  }
  return static_cast<std::uint64_t>(last - begin);
}

}  // namespace tegl::detail
