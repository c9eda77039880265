// SPDX-License-Identifier: BSD-3-Clause
//
// Collection of links between trees of tiles, by keys, and their conversion to levels.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "base/radix_sort.hpp"
#include "search/padded_ranges.hpp"
#include "search/seed_trees.hpp"

namespace tegl::detail {

/// A link whose bounds are keys.
template <class Key>
struct KeyLink {
  std::uint32_t a, b;
  Key least, greatest;
};

/// Collects links. Links arrive in runs along the borders between trees; a cache merges overlapping ones before they
/// are stored.
template <class Key>
class LinkCollector {
 public:
  /// `at_hand`: wanted size of the cache of recent links, at most 8192 so that it fits in the processor's cache.
  explicit LinkCollector(std::size_t at_hand = kMostAtHand)
      : recent_(std::bit_ceil(std::clamp<std::size_t>(at_hand, 64, kMostAtHand)), Link{0, 0, 0, 0}),
        shift_(static_cast<unsigned>(32 - std::countr_zero(recent_.size()))) {}

  void add(const KeyLink<Key>& link) {
    Link& recent = recent_[(link.a * 0x9e3779b1u ^ link.b * 0x85ebca6bu) >> shift_];
    const bool one = recent.a == link.a && recent.b == link.b && recent.least <= link.greatest &&
                     link.least <= recent.greatest && recent.least != recent.greatest;
    if (one) {
      recent.least = std::min(recent.least, link.least);
      recent.greatest = std::max(recent.greatest, link.greatest);
    } else {
      keep(recent);
      recent = link;
    }
  }
  std::vector<KeyLink<Key>> take() {
    for (const Link& link : recent_) keep(link);
    return std::move(links_);
  }

 private:
  using Link = KeyLink<Key>;
  static constexpr std::size_t kMostAtHand = std::size_t{1} << 13;

  void keep(const Link& link) {
    if (link.least == link.greatest) return;
    if (links_.size() == links_.capacity() && links_.size() >= wanted_) compress();
    links_.push_back(link);
  }
  /// Merges overlapping links, so that memory stays proportional to the number of distinct links.
  void compress() {
    std::sort(links_.begin(), links_.end(), [](const Link& p, const Link& q) {
      return std::tie(p.a, p.b, p.least, p.greatest) < std::tie(q.a, q.b, q.least, q.greatest);
    });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      if (kept > 0 && links_[kept - 1].a == links_[i].a && links_[kept - 1].b == links_[i].b &&
          links_[i].least <= links_[kept - 1].greatest)
        links_[kept - 1].greatest = std::max(links_[kept - 1].greatest, links_[i].greatest);
      else
        links_[kept++] = links_[i];
    }
    links_.resize(kept);
    wanted_ = std::max<std::size_t>(kMostUnsorted, 2 * kept);
  }

  static constexpr std::size_t kMostUnsorted = std::size_t{1} << 22;
  std::vector<Link> recent_;
  unsigned shift_;
  std::vector<Link> links_;
  std::size_t wanted_ = kMostUnsorted;
};

/// Maps keys to levels: their ranks among the keys that occur.
template <class Key>
class Levels {
 public:
  Levels(std::vector<Key> keys) : keys_(std::move(keys)) {
    sort_by_bits(keys_, 8 * sizeof(Key), [](Key key) { return key; });
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    if (keys_.empty()) return;
    const auto all = static_cast<std::uint64_t>(keys_.back() - keys_.front());
    const auto wanted = static_cast<int>(std::bit_width(keys_.size()));
    shift_ = std::max(0, static_cast<int>(std::bit_width(all)) - wanted);
    first_.resize((all >> shift_) + 2, static_cast<std::uint32_t>(keys_.size()));
    for (std::size_t i = keys_.size(); i-- > 0;) first_[bucket(keys_[i])] = static_cast<std::uint32_t>(i);
    for (std::size_t i = first_.size() - 1; i-- > 0;) first_[i] = std::min(first_[i], first_[i + 1]);
  }
  /// Level of a key that occurs.
  [[nodiscard]] std::uint32_t operator[](Key key) const noexcept {
    const std::size_t at = bucket(key);
    return static_cast<std::uint32_t>(
        std::lower_bound(keys_.begin() + first_[at], keys_.begin() + first_[at + 1], key) - keys_.begin());
  }
  [[nodiscard]] std::uint32_t count() const noexcept {
    return keys_.empty() ? 0 : static_cast<std::uint32_t>(keys_.size() - 1);
  }

 private:
  [[nodiscard]] std::size_t bucket(Key key) const noexcept {
    return static_cast<std::size_t>(static_cast<std::uint64_t>(key - keys_.front()) >> shift_);
  }

  std::vector<Key> keys_;
  int shift_ = 0;
  std::vector<std::uint32_t> first_;  ///< by bucket: its first key; about as many buckets as keys
};

/// Sets the levels and links of a graph that has roots. The ends of `others` become levels too.
template <class Key>
Levels<Key> put_in_levels(const RangeMap<Key>& map, const std::vector<KeyLink<Key>>& links,
                          const std::vector<KeyLink<Key>>& others, SeedGraph& graph) {
  std::vector<Key> keys;
  keys.reserve(2 * (graph.roots.size() + links.size() + others.size()));
  for (const Place root : graph.roots) {
    keys.push_back(map.least[root]);
    keys.push_back(map.greatest[root]);
  }
  for (const auto* some : {&links, &others})
    for (const auto& link : *some) {
      keys.push_back(link.least);
      keys.push_back(link.greatest);
    }
  Levels<Key> levels(std::move(keys));
  graph.levels = levels.count();
  for (const Place root : graph.roots) {
    graph.first.push_back(levels[map.least[root]]);
    graph.end.push_back(levels[map.greatest[root]]);
  }
  graph.links.reserve(links.size());
  for (const auto& link : links) graph.links.push_back({link.a, link.b, levels[link.least], levels[link.greatest]});
  merge_links(graph.links);
  return levels;
}

}  // namespace tegl::detail
