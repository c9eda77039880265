// SPDX-License-Identifier: BSD-3-Clause
//
// Union-find. The smallest number of a set is its root, so the result does not depend on the order of joins.
//
// Based on: R. E. Tarjan and J. van Leeuwen, Worst-case analysis of set union algorithms, 1984 (path halving).
#pragma once

#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

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
  void join_under(Number other, Number leader) noexcept { parent_[other] = leader; }
  [[nodiscard]] std::size_t size() const noexcept { return parent_.size(); }

 private:
  std::vector<Number> parent_;
};

}  // namespace tegl::detail
