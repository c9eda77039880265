// SPDX-License-Identifier: BSD-3-Clause
//
// Union-find for one thread, and for many threads at a time. The smallest number of a set is its root, so the result
// does not depend on the order of joins.
//
// Based on: R. E. Tarjan and J. van Leeuwen, Worst-case analysis of set union algorithms, 1984 (path halving); R. J.
// Anderson and H. Woll, Wait-free parallel algorithms for the union-find problem, 1991 (roots are linked by
// compare-and-swap, always towards the smaller number, so that no cycle can arise).
#pragma once

#include <atomic>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Sets of 0 ... n-1, for one thread.
template <class Number>
class BasicDisjointSets {
 public:
  BasicDisjointSets() = default;
  explicit BasicDisjointSets(std::size_t n) { reset(n); }
  void reset(std::size_t n) {
    parent_.resize(n);
    std::iota(parent_.begin(), parent_.end(), Number{0});
  }
  /// Adds one number, in a set of its own.
  Number add() {
    parent_.push_back(static_cast<Number>(parent_.size()));
    return parent_.back();
  }
  Number find(Number i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// Returns whether the two were in different sets.
  bool join(Number a, Number b) {
    a = find(a);
    b = find(b);
    if (a == b) return false;
    if (a > b) std::swap(a, b);
    parent_[b] = a;
    return true;
  }
  /// Joins two sets with a given root instead of the smallest number. `other` and `leader` must be roots.
  void hang(Number other, Number leader) noexcept { parent_[other] = leader; }
  [[nodiscard]] std::size_t size() const noexcept { return parent_.size(); }

 private:
  std::vector<Number> parent_;
};
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
