// SPDX-License-Identifier: BSD-3-Clause
//
// Radix sort.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "base/workers.hpp"

namespace tegl::detail {

/// Sorts stably by key(item), integers below 2^bits, starting with the lowest digit. O(n bits / 11) time; memory for n
/// items. `threads`: 0 for all of the machine; the result does not depend on them.
template <class Item, class Key>
void sort_by_bits(std::vector<Item>& items, unsigned bits, const Key& key, unsigned threads = 1) {
  constexpr std::size_t kFew = 512;  // below this, comparisons cost less than counting digits
  if (items.size() < kFew) {
    std::stable_sort(items.begin(), items.end(), [&](const Item& a, const Item& b) { return key(a) < key(b); });
    return;
  }
  constexpr unsigned kDigitBits = 11;
  constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
  constexpr std::size_t kPart = std::size_t{1} << 16;  // smaller parts are not worth a thread
  constexpr std::size_t kMostParts = 8;
  const std::size_t parts = std::clamp<std::size_t>(items.size() / kPart, 1, threads == 1 ? 1 : kMostParts);
  const auto first_of = [&](std::size_t part) { return items.size() * part / parts; };
  const auto for_parts = [&](const auto& work) {
    if (parts == 1) return work(0);
    for_each_block(parts, 1, threads, {}, [&](std::size_t part, std::size_t, std::size_t) { work(part); });
  };
  std::vector<Item> other(items.size());
  std::vector<std::array<std::size_t, kDigits>> next(parts);  // by part and digit: counts, then places
  for (unsigned shift = 0; shift < bits; shift += kDigitBits) {
    const auto digit = [&](const Item& item) { return static_cast<std::size_t>(key(item) >> shift) & (kDigits - 1); };
    for_parts([&](std::size_t part) {
      next[part].fill(0);
      for (std::size_t i = first_of(part); i < first_of(part + 1); ++i) ++next[part][digit(items[i])];
    });
    // skip a digit that all have in common
    std::size_t like_first = 0;
    for (const auto& counts : next) like_first += counts[digit(items[0])];
    if (like_first == items.size()) continue;
    // exclusive scan, by digit, then by part; move
    std::size_t sum = 0;
    for (std::size_t d = 0; d < kDigits; ++d)
      for (auto& starts : next) {
        const std::size_t count = starts[d];
        starts[d] = sum;
        sum += count;
      }
    for_parts([&](std::size_t part) {
      for (std::size_t i = first_of(part); i < first_of(part + 1); ++i) other[next[part][digit(items[i])]++] = items[i];
    });
    items.swap(other);
  }
}

/// Sorts stably by key(item), integers below 2^bits, items that fit in the processor's cache, with few digits. `other`:
/// room for the items, kept between calls.
template <class Item, class Key>
void sort_in_cache(std::vector<Item>& items, std::vector<Item>& other, unsigned bits, const Key& key) {
  constexpr unsigned kDigitBits = 9;
  constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
  constexpr std::size_t kMostPasses = (64 + kDigitBits - 1) / kDigitBits;
  std::array<std::array<std::uint32_t, kDigits>, kMostPasses> next;  // by pass and digit: counts, then places
  const std::size_t passes = (bits + kDigitBits - 1) / kDigitBits;
  const auto digit = [&](const Item& item, std::size_t pass) {
    return static_cast<std::size_t>(key(item) >> (pass * kDigitBits)) & (kDigits - 1);
  };
  std::fill_n(next.begin(), passes, std::array<std::uint32_t, kDigits>{});
  for (const Item& item : items)
    for (std::size_t pass = 0; pass < passes; ++pass) ++next[pass][digit(item, pass)];
  other.resize(items.size());
  for (std::size_t pass = 0; pass < passes; ++pass) {
    auto& places = next[pass];
    if (!items.empty() && places[digit(items[0], pass)] == items.size()) continue;  // all have this digit
    std::exclusive_scan(places.begin(), places.end(), places.begin(), std::uint32_t{0});
    for (const Item& item : items) other[places[digit(item, pass)]++] = item;
    items.swap(other);
  }
}

}  // namespace tegl::detail
