// SPDX-License-Identifier: BSD-3-Clause
//
// Priority queue with changeable keys. Each number occurs at most once, so there are no outdated entries and the queue
// never has more than `count` entries.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Priority queue of numbers below `count`. The smallest key comes first; of equal keys, the smallest number. A heap
/// with four children per node: half as many levels as with two, and a node's children are adjacent in memory.
class KeyedQueue {
 public:
  explicit KeyedQueue(std::size_t count) : place_(count, kNone) {}

  [[nodiscard]] bool empty() const noexcept { return heap_.empty(); }

  /// Inserts the number or changes its key. O(log count).
  void set(Index number, double key) {
    if (place_[number] == kNone) {
      heap_.push_back({key, number});
      rise(heap_.size() - 1);
      return;
    }
    const std::size_t at = place_[number];
    const Entry entry = {key, number};
    const bool up = entry < heap_[at];
    heap_[at] = entry;
    up ? rise(at) : sink(at);
  }

  /// Removes and returns the first number. The queue must not be empty. O(log count).
  Index pop() {
    const Index first = heap_.front().number;
    place_[first] = kNone;
    const Entry last = heap_.back();
    heap_.pop_back();
    if (!heap_.empty()) {
      heap_.front() = last;
      sink(0);
    }
    return first;
  }

 private:
  static constexpr Index kNone = std::numeric_limits<Index>::max();
  static constexpr std::size_t kChildren = 4;
  struct Entry {
    double key;
    Index number;
    bool operator<(const Entry& other) const { return key != other.key ? key < other.key : number < other.number; }
  };

  void put(std::size_t at, const Entry& entry) {
    heap_[at] = entry;
    place_[entry.number] = static_cast<Index>(at);
  }
  void rise(std::size_t at) {
    const Entry entry = heap_[at];
    for (; at > 0 && entry < heap_[(at - 1) / kChildren]; at = (at - 1) / kChildren)
      put(at, heap_[(at - 1) / kChildren]);
    put(at, entry);
  }
  void sink(std::size_t at) {
    const Entry entry = heap_[at];
    for (std::size_t first; (first = kChildren * at + 1) < heap_.size();) {
      const std::size_t end = std::min(first + kChildren, heap_.size());
      std::size_t least = first;
      for (std::size_t child = first + 1; child < end; ++child)
        if (heap_[child] < heap_[least]) least = child;
      if (!(heap_[least] < entry)) break;
      put(at, heap_[least]);
      at = least;
    }
    put(at, entry);
  }

  std::vector<Entry> heap_;
  std::vector<Index> place_;  ///< index of each number in heap_
};

}  // namespace tegl::detail
