// SPDX-License-Identifier: BSD-3-Clause
//
// Edges of cells, sorted and without duplicates, by buckets of their smaller ends.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// The ends of an edge: the smaller number of a point first.
using EdgeEnds = std::array<Index, 2>;

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

  /// Sorts larger ends and drops duplicates; returns how many are left.
  static std::uint64_t make_unique(Index* begin, Index* end);

  std::vector<std::uint64_t> first_;  ///< first edge of each point, and the number of edges
  std::vector<EdgeEnds> ends_;
};

template <class Visit>
SortedEdges::SortedEdges(std::size_t points, std::size_t parts, const Visit& visit, const WorkOptions& work) {
  const bool is_one = work.threads == 1;
  const auto next = [is_one](std::uint64_t& count) {
    return is_one ? count++ : std::atomic_ref<std::uint64_t>(count).fetch_add(1, std::memory_order_relaxed);
  };
  // count the edges of each smaller end, exclusive scan
  std::vector<std::uint64_t> bucket(points + 1, 0);
  for_each_block(parts, 1, work.threads, part_of(work.progress, 0.0, 0.3),
                 [&](std::size_t part, std::size_t, std::size_t) {
                   visit(part, [&](Index p, Index q) { next(bucket[std::min(p, q)]); });
                 });
  std::uint64_t sum = 0;
  for (std::uint64_t& start : bucket) {
    const std::uint64_t count = start;
    start = sum;
    sum += count;
  }
  // write the larger ends; afterwards bucket[p] is the end of point p
  std::vector<Index> others(sum);
  for_each_block(parts, 1, work.threads, part_of(work.progress, 0.3, 0.7),
                 [&](std::size_t part, std::size_t, std::size_t) {
                   visit(part, [&](Index p, Index q) { others[next(bucket[std::min(p, q)])] = std::max(p, q); });
                 });
  const auto start_of = [&](std::size_t p) { return p == 0 ? 0 : bucket[p - 1]; };
  // sort each bucket, exclusive scan, write
  first_.assign(points + 1, 0);
  for_each_item(points, work.threads, part_of(work.progress, 0.7, 0.9), [&](std::size_t p) {
    first_[p + 1] = make_unique(others.data() + start_of(p), others.data() + bucket[p]);
  });
  for (std::size_t p = 0; p < points; ++p) first_[p + 1] += first_[p];
  ends_.resize(first_.back());
  for_each_item(points, work.threads, part_of(work.progress, 0.9, 1.0), [&](std::size_t p) {
    const Index* const other = others.data() + start_of(p);
    for (std::uint64_t i = first_[p]; i < first_[p + 1]; ++i) ends_[i] = {static_cast<Index>(p), other[i - first_[p]]};
  });
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
