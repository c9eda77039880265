// SPDX-License-Identifier: BSD-3-Clause
//
// Finds equal keys among a few, by a table of hashes: without sorting, and in time proportional to their number also if
// there are many.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tegl::detail {

/// Use one per thread.
class EqualKeys {
 public:
  struct Group {
    std::uint32_t first, second;  ///< numbers of the first two elements with the key; equal if there is one only
    std::uint32_t count;
  };

  /// The groups of equal keys, by their first elements. `key_of(i)`: the key of element i of `count`. Valid until the
  /// next call.
  template <class KeyOf>
  const std::vector<Group>& groups(std::size_t count, const KeyOf& key_of) {
    groups_.clear();
    const std::size_t size = std::bit_ceil(2 * count + 1);
    const int shift = 64 - std::countr_zero(size);
    table_.assign(size, 0);
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint64_t key = key_of(i);
      std::size_t at = key * kHash >> shift;
      while (table_[at] != 0 && key_of(groups_[table_[at] - 1].first) != key) at = (at + 1) & (size - 1);
      if (table_[at] == 0) {
        groups_.push_back({i, i, 1});
        table_[at] = static_cast<std::uint32_t>(groups_.size());
        continue;
      }
      Group& group = groups_[table_[at] - 1];
      if (++group.count == 2) group.second = i;
    }
    return groups_;
  }

 private:
  static constexpr std::uint64_t kHash = 0x9E3779B97F4A7C15u;

  std::vector<Group> groups_;
  std::vector<std::uint32_t> table_;  ///< number of a group plus 1; 0: empty
};

}  // namespace tegl::detail
