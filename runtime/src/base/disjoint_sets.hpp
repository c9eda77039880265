// SPDX-License-Identifier: BSD-3-Clause
//
// Union-find for many threads at a time; the one for one thread is in tegl/tile/disjoint_sets.hpp. The smallest number
// of a set is its root, so the result does not depend on the order of joins.
//
// Based on: R. J. Anderson and H. Woll, Wait-free parallel algorithms for the union-find problem, 1991 (roots are
// linked by compare-and-swap, always towards the smaller number, so that no cycle can arise).
#pragma once

#include <atomic>
#include <cstddef>
#include <numeric>
#include <utility>

#include "tegl/contour.hpp"
#include "tegl/tile/disjoint_sets.hpp"

namespace tegl::detail {

/// For one thread.
using DisjointSets = BasicDisjointSets<Index>;

/// Sets of 0 ... n-1. Any number of threads may call `join` and `find` concurrently. `find` returns the smallest number
/// of the set once no thread calls `join` any more. A number's parent is never larger than the number.
class SharedDisjointSets {
 public:
  explicit SharedDisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), Index{0}); }

  Index find(Index i) noexcept {
    while (true) {
      const Index parent = load(i);
      if (parent == i) return i;
      const Index grandparent = load(parent);
      // Path halving. If another thread was faster, it moved i closer to the root.
      Index expected = parent;
      if (grandparent != parent) at(i).compare_exchange_weak(expected, grandparent, std::memory_order_relaxed);
      i = grandparent;
    }
  }
  void join(Index a, Index b) noexcept {
    while (true) {
      a = find(a);
      b = find(b);
      if (a == b) return;
      if (a > b) std::swap(a, b);
      Index expected = b;  // is b still a root?
      if (at(b).compare_exchange_strong(expected, a, std::memory_order_relaxed)) return;
    }
  }

 private:
  std::atomic_ref<Index> at(Index i) noexcept { return std::atomic_ref<Index>(parent_[i]); }
  Index load(Index i) noexcept { return at(i).load(std::memory_order_relaxed); }

  Buffer<Index> parent_;
};

}  // namespace tegl::detail
