// SPDX-License-Identifier: BSD-3-Clause
//
// The trees that own the parts of ranges, while tiles or trees are given up (see seed_regions.cpp).
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "search/seed_links.hpp"

namespace tegl::detail {

/// Owners of tiles or trees, by part of their ranges. Owners are trees that stay. `Index` counts all parts.
template <class Key, class Index = std::uint64_t>
class Ownership {
 public:
  explicit Ownership(std::size_t count) : parts_of_(count, kNone) {}

  /// Forgets all owners.
  void clear() {
    std::fill(parts_of_.begin(), parts_of_.end(), kNone);
    parts_.clear();
  }

  [[nodiscard]] bool has(std::uint32_t i) const noexcept { return parts_of_[i] != kNone; }

  /// Offers i as a cover of the next tile between `least` and `greatest`; i has at least this range.
  void offer(std::uint32_t i, Key least, Key greatest) {
    lowest_ = std::min(lowest_, least);
    highest_ = std::max(highest_, greatest);
    const Index first = parts_of_[i];
    offers_.push_back({least, greatest, std::min(parts_[first].end, greatest), parts_[first].owner, first});
  }
  /// If the offers cover i, i passes to their owners; otherwise i owns itself. Clears the offers. Returns whether i was
  /// given up.
  bool give_up(std::uint32_t i, Key least, Key greatest) {
    if (give_up_to_offers(i, least, greatest)) return true;
    set_one(i, i, greatest);
    forget_offers();
    return false;
  }
  /// If the offers cover i, i passes to their owners, and the offers are cleared. Returns whether i was given up.
  bool give_up_to_offers(std::uint32_t i, Key least, Key greatest) {
    // Most uncovered ranges are uncovered at an end.
    if (lowest_ > least || highest_ < greatest) return false;
    const auto first = static_cast<Index>(parts_.size());
    if (!divide(least, greatest, first)) {
      parts_.resize(first);
      return false;
    }
    parts_of_[i] = first;
    forget_offers();
    return true;
  }
  /// Sets one owner of the whole range of i: i itself if it is not given up.
  void set_one(std::uint32_t i, std::uint32_t owner, Key greatest) {
    parts_of_[i] = static_cast<Index>(parts_.size());
    parts_.push_back({greatest, owner});
  }
  /// Gives i up to a single owner if one owner of `other`, whose range contains the range of i, has all of it; then
  /// clears the offers. Returns false otherwise.
  bool give_up_to_one(std::uint32_t i, std::uint32_t other, Key least, Key greatest) {
    const Part* part = &parts_[parts_of_[other]];
    while (part->end <= least) ++part;
    if (part->end < greatest) return false;
    set_one(i, std::uint32_t{part->owner}, greatest);
    forget_offers();
    return true;
  }
  /// Calls visit(owner, end) for the owners of i between `level` and `end`, in ascending order of levels.
  template <class Visit>
  void for_owners(std::uint32_t i, Key level, Key end, const Visit& visit) const {
    for (const Part* part = &parts_[parts_of_[i]]; level < end;) {
      while (part->end <= level) ++part;
      level = std::min(part->end, end);
      visit(part->owner, level);
    }
  }
  /// Adds links between the owners of a and b, by their new numbers, from `level` to `end`.
  template <class Number>
  void add_links(std::uint32_t a, std::uint32_t b, Key level, Key end, const Number& number,
                 LinkCollector<Key>& collector) const {
    const Part* of_a = &parts_[parts_of_[a]];
    const Part* of_b = &parts_[parts_of_[b]];
    while (of_a->end <= level) ++of_a;
    while (of_b->end <= level) ++of_b;
    while (level < end) {
      const Key both = std::min(std::min(of_a->end, of_b->end), end);
      if (of_a->owner != of_b->owner) {
        const std::uint32_t p = number(of_a->owner);
        const std::uint32_t q = number(of_b->owner);
        collector.add({std::min(p, q), std::max(p, q), level, both});
      }
      level = both;
      // without branches, which would be hard to predict
      of_a += of_a->end <= level ? 1 : 0;
      of_b += of_b->end <= level ? 1 : 0;
    }
  }

  /// Replaces owners of i that were given up, if is_gone(owner), by their own owners, which are not gone. The parts of
  /// i then follow the ranges of the tile resolved before. `level`, `end`: the range of i.
  template <class IsGone>
  void resolve(std::uint32_t i, Key level, Key end, const IsGone& is_gone) {
    const auto first = static_cast<Index>(parts_.size());
    for (Index p = parts_of_[i]; level < end; ++p) {
      const Part part = parts_[p];
      if (!is_gone(part.owner)) {
        append(part, first);
        level = part.end;
        continue;
      }
      Index q = parts_of_[part.owner];
      while (parts_[q].end <= level) ++q;
      for (; level < part.end; ++q) {
        level = std::min(parts_[q].end, part.end);
        append({level, parts_[q].owner}, first);
      }
    }
    parts_of_[i] = first;
  }

  /// Sets the parts of i, as owner and end, in ascending order.
  void set(std::uint32_t i, std::span<const std::pair<std::uint32_t, Key>> parts) {
    parts_of_[i] = static_cast<Index>(parts_.size());
    for (const auto& [owner, end] : parts) parts_.push_back({end, owner});
  }

 private:
  /// From the end of the part before (or the minimum of the range) up to `end`.
  struct Part {
    Key end;
    std::uint32_t owner;
  };
  struct Offer {
    Key least, greatest;
    Key end;              ///< of the first part that may still matter; at most `greatest`
    std::uint32_t owner;  ///< of that part
    Index part;
  };
  static constexpr Index kNone = std::numeric_limits<Index>::max();

  void forget_offers() noexcept {
    offers_.clear();
    lowest_ = std::numeric_limits<Key>::max();
    highest_ = 0;
  }
  /// Appends parts in ascending order, each as long as possible. Returns false at a gap.
  bool divide(Key level, Key end, Index first) {
    while (level < end) {
      Part best{level, 0};
      for (Offer& offer : offers_) {
        while (offer.end <= level && offer.end < offer.greatest) go_on(offer);
        // without branches: which offer reaches farthest is hard to predict
        const Key to = offer.least <= level ? offer.end : Key{0};
        best.owner = to > best.end ? offer.owner : best.owner;
        best.end = std::max(best.end, to);
      }
      if (best.end == level) return false;
      level = best.end;
      best.end = std::min(best.end, end);
      append(best, first);
    }
    return true;
  }
  /// Adds a part to those from `first` on; equal owners in a row have one part.
  void append(const Part& part, Index first) {
    if (parts_.size() > first && parts_.back().owner == part.owner)
      parts_.back().end = part.end;
    else
      parts_.push_back(part);
  }
  /// To the next part of an offer.
  void go_on(Offer& offer) const {
    const Part& part = parts_[++offer.part];
    offer.end = std::min(part.end, offer.greatest);
    offer.owner = part.owner;
  }

  std::vector<Index> parts_of_;  ///< first part of each tile; the last part ends with the range
  std::vector<Part> parts_;
  std::vector<Offer> offers_;
  Key lowest_ = std::numeric_limits<Key>::max();  ///< of the offers
  Key highest_ = 0;
};

}  // namespace tegl::detail
