// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers the points of a part by a hash table, the points of all parts by a counting sort.
#include "cut/point_numbers.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace tegl::detail {
namespace {

constexpr std::size_t kFirstSize = 1024;

/// A key, and its place in the list of all parts.
struct KeyOfPart {
  PointKey key;
  std::size_t at;
};

/// The keys of all parts, sorted. Stable.
Buffer<KeyOfPart> sorted_keys(std::span<const std::span<const PointKey>> parts) {
  Index least = std::numeric_limits<Index>::max();
  Index most = 0;
  std::size_t count = 0;
  for (const auto& keys : parts) {
    for (const PointKey key : keys) {
      least = std::min(least, lower_end(key));
      most = std::max(most, lower_end(key));
    }
    count += keys.size();
  }
  Buffer<KeyOfPart> sorted(count);
  if (count == 0) return sorted;
  // A counting sort by lower end, or by its upper bits if the ends are far apart: about as many buckets as keys.
  unsigned shift = 0;
  while ((most - least) >> shift > 2 * count) ++shift;
  std::vector<std::size_t> places((std::size_t{most - least} >> shift) + 1);
  const auto bucket_of = [&](PointKey key) { return (lower_end(key) - least) >> shift; };
  for (const auto& keys : parts)
    for (const PointKey key : keys) ++places[bucket_of(key)];
  std::size_t sum = 0;
  for (std::size_t& place : places) sum += std::exchange(place, sum);
  std::size_t number = 0;
  for (const auto& keys : parts)
    for (const PointKey key : keys) sorted[places[bucket_of(key)]++] = {key, number++};
  // Places are now the ends of the buckets, which have few keys each.
  constexpr std::size_t kFew = 32;
  std::size_t from = 0;
  for (const std::size_t to : places) {
    const std::span<KeyOfPart> bucket = std::span<KeyOfPart>(sorted).subspan(from, to - from);
    from = to;
    if (bucket.size() > kFew) {
      std::stable_sort(bucket.begin(), bucket.end(),
                       [](const KeyOfPart& a, const KeyOfPart& b) { return a.key < b.key; });
      continue;
    }
    for (std::size_t i = 1; i < bucket.size(); ++i) {
      const KeyOfPart moved = bucket[i];
      std::size_t at = i;
      for (; at > 0 && bucket[at - 1].key > moved.key; --at) bucket[at] = bucket[at - 1];
      bucket[at] = moved;
    }
  }
  return sorted;
}

}  // namespace

PartPoints::PartPoints() { resize(kFirstSize); }

Index PartPoints::add(PointKey key, std::size_t at) {
  const auto number = static_cast<Index>(keys_.size());
  keys_.push_back(key);
  slots_[at] = {key, number, round_};
  if (4 * keys_.size() > slots_.size()) resize(2 * slots_.size());
  return number;
}

void PartPoints::resize(std::size_t size) {
  slots_.assign(size, Slot{});
  shift_ = 64 - std::countr_zero(size);
  round_ = 1;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    std::size_t at = place_of(keys_[i]);
    while (slots_[at].round == round_) at = (at + 1) & (size - 1);
    slots_[at] = {keys_[i], static_cast<Index>(i), round_};
  }
}

std::vector<PointKey> PartPoints::take_keys() {
  std::vector<PointKey> keys = std::exchange(keys_, {});
  keys_.reserve(keys.size());  // parts are alike
  if (++round_ == 0) resize(slots_.size());
  return keys;
}

std::vector<PointKey> number_points_of_parts(std::span<const std::span<const PointKey>> parts,
                                             std::vector<Index>& numbers) {
  const Buffer<KeyOfPart> sorted = sorted_keys(parts);
  numbers.resize(sorted.size());
  std::vector<PointKey> keys;
  keys.reserve(sorted.size());
  for (const KeyOfPart& one : sorted) {
    if (keys.empty() || keys.back() != one.key) keys.push_back(one.key);
    numbers[one.at] = static_cast<Index>(keys.size() - 1);
  }
  return keys;
}

}  // namespace tegl::detail
