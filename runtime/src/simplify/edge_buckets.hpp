// SPDX-License-Identifier: BSD-3-Clause
//
// Edges in buckets of similar keys, smallest keys first. Within a bucket, edges come in the order of their vertices:
// neighbouring edges follow each other, so the memory around them is in the cache. A push costs no comparison.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

class EdgeBuckets {
 public:
  struct Entry {
    Index a;
    Index b;
    std::uint32_t stamp;
    bool operator<(const Entry& other) const { return std::tie(a, b, stamp) < std::tie(other.a, other.b, other.stamp); }
  };

  /// `key`: 0 or more; other keys, and NaN, come last.
  void push(double key, const Entry& entry) {
    const std::size_t number = key >= 0.0 ? (std::bit_cast<std::uint64_t>(key) & kUnsigned) >> kShift : kBuckets - 1;
    (number > current_ ? buckets_[number] : again_).push_back(entry);
  }

  /// The next entry; null if there is none. `is_current(entry)`: false for entries to skip. `push_late()`: called when
  /// all loaded entries were taken; may push others. An entry pushed earlier would not have come sooner, so pushes can
  /// wait until then. The pointer is valid until the next call.
  template <class IsCurrent, class PushLate>
  const Entry* next(const IsCurrent& is_current, const PushLate& push_late) {
    for (;;) {
      while (position_ < entries_.size()) {
        const Entry& entry = entries_[position_++];
        if (is_current(entry)) return &entry;
      }
      push_late();
      if (!refill(is_current)) return nullptr;
    }
  }
  template <class IsCurrent>
  const Entry* next(const IsCurrent& is_current) {
    return next(is_current, [] {});
  }

  /// For each of the steps, calls request(step, entry) for the entries that will come within so many calls of `next`,
  /// each once.
  template <std::size_t Count, class Request>
  void request_ahead(const std::array<std::size_t, Count>& calls, const Request& request) {
    static_assert(Count <= kMostSteps);
    for (std::size_t step = 0; step < Count; ++step)
      for (; requested_[step] < std::min(position_ + calls[step], entries_.size()); ++requested_[step])
        request(step, entries_[requested_[step]]);
  }

 private:
  /// Keys of a bucket differ by at most a sixteenth: the sign, the exponent and four bits of the fraction.
  static constexpr int kShift = 48;
  static constexpr std::size_t kBuckets = std::size_t{1} << (63 - kShift);
  static constexpr std::size_t kMostSteps = 4;                        ///< of request_ahead
  static constexpr std::uint64_t kUnsigned = ~std::uint64_t{0} >> 1;  ///< without the sign, which -0.0 has

  /// Loads the entries pushed to the current bucket since it was loaded, or else the next bucket.
  template <class IsCurrent>
  bool refill(const IsCurrent& is_current) {
    entries_.clear();
    position_ = 0;
    requested_.fill(0);
    if (!again_.empty()) {
      entries_.swap(again_);
    } else {
      while (current_ < kBuckets && buckets_[current_].empty()) ++current_;
      if (current_ == kBuckets) {
        current_ = 0;
        return false;
      }
      entries_.swap(buckets_[current_]);
      buckets_[current_] = {};
    }
    std::erase_if(entries_, [&](const Entry& entry) { return !is_current(entry); });
    std::sort(entries_.begin(), entries_.end());
    return true;
  }

  std::vector<std::vector<Entry>> buckets_ = std::vector<std::vector<Entry>>(kBuckets);
  std::size_t current_ = 0;
  std::vector<Entry> entries_;  ///< of the current bucket, sorted
  std::size_t position_ = 0;
  std::array<std::size_t, kMostSteps> requested_{};  ///< by step: entries for which request_ahead was called
  std::vector<Entry> again_;                         ///< pushed to the current bucket or an earlier one
};

}  // namespace tegl::detail
