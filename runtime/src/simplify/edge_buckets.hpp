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
#include <span>
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

  /// Loads the entries of the next bucket, or those pushed to the loaded one or to earlier ones meanwhile. They are
  /// sorted; none if there are no others. `is_current(entry)`: false for entries to omit. Valid until the next call;
  /// others may be pushed meanwhile.
  template <class IsCurrent>
  std::span<const Entry> load(const IsCurrent& is_current) {
    do {
      if (!refill()) return {};
      std::erase_if(entries_, [&](const Entry& entry) { return !is_current(entry); });
    } while (entries_.empty());
    std::sort(entries_.begin(), entries_.end());
    return entries_;
  }

 private:
  /// Keys of a bucket differ by at most a sixteenth: the sign, the exponent and four bits of the fraction.
  static constexpr int kShift = 48;
  static constexpr std::size_t kBuckets = std::size_t{1} << (63 - kShift);
  static constexpr std::uint64_t kUnsigned = ~std::uint64_t{0} >> 1;  ///< without the sign, which -0.0 has

  bool refill() {
    entries_.clear();
    if (!again_.empty()) {
      entries_.swap(again_);
      return true;
    }
    while (current_ < kBuckets && buckets_[current_].empty()) ++current_;
    if (current_ == kBuckets) {
      current_ = 0;
      return false;
    }
    entries_.swap(buckets_[current_]);
    buckets_[current_] = {};
    return true;
  }

  std::vector<std::vector<Entry>> buckets_ = std::vector<std::vector<Entry>>(kBuckets);
  std::size_t current_ = 0;
  std::vector<Entry> entries_;  ///< loaded
  std::vector<Entry> again_;    ///< pushed to the current bucket or an earlier one
};

/// Requests memory for the entries of a list some turns before they are used, in several steps.
template <std::size_t Steps>
class EdgesAhead {
 public:
  /// `turns`: by step, how many turns before an entry is used. The entries must outlive it.
  EdgesAhead(std::span<const EdgeBuckets::Entry> entries, const std::array<std::size_t, Steps>& turns)
      : entries_(entries), turns_(turns) {}

  /// Calls request(step, entry) for the entries up to so many turns after this position, each once.
  template <class Request>
  void request(std::size_t position, const Request& request) {
    for (std::size_t step = 0; step < Steps; ++step)
      for (; requested_[step] < std::min(position + 1 + turns_[step], entries_.size()); ++requested_[step])
        request(step, entries_[requested_[step]]);
  }

 private:
  std::span<const EdgeBuckets::Entry> entries_;
  std::array<std::size_t, Steps> turns_;
  std::array<std::size_t, Steps> requested_{};
};

}  // namespace tegl::detail
