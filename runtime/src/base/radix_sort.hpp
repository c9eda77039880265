// SPDX-License-Identifier: BSD-3-Clause
//
// Radix sort.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace tegl::detail {

/// Sorts stably by key(item), integers below 2^bits, starting with the lowest digit. O(n bits / 11) time; memory for n
/// items.
template <class Item, class Key>
void sort_by_bits(std::vector<Item>& items, unsigned bits, const Key& key) {
  constexpr std::size_t kFew = 512;  // below this, comparisons cost less than counting digits
  if (items.size() < kFew) {
    std::stable_sort(items.begin(), items.end(), [&](const Item& a, const Item& b) { return key(a) < key(b); });
    return;
  }
  constexpr unsigned kDigitBits = 11;
  constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
  std::vector<Item> other(items.size());
  for (unsigned shift = 0; shift < bits; shift += kDigitBits) {
    const auto digit = [&](const Item& item) { return static_cast<std::size_t>(key(item) >> shift) & (kDigits - 1); };
    // count, skip a digit that all have in common, exclusive scan, move
    std::array<std::size_t, kDigits> next{};
    for (const Item& item : items) ++next[digit(item)];
    if (next[digit(items[0])] == items.size()) continue;
    std::size_t sum = 0;
    for (std::size_t& start : next) {
      const std::size_t count = start;
      start = sum;
      sum += count;
    }
    for (const Item& item : items) other[next[digit(item)]++] = item;
    items.swap(other);
  }
}

}  // namespace tegl::detail
