// SPDX-License-Identifier: BSD-3-Clause
//
// The order in which the tiles of a block become active and inactive, from low levels to high ones.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/radix_sort.hpp"

namespace tegl::detail {

/// Tiles enter at their minimum and leave at their maximum: two events of each tile, numbered by position. At equal
/// levels, tiles enter first, then leave, the widest one last; between these events there is no level.
class TileEvents {
 public:
  using Tile = std::uint32_t;
  using Position = std::int32_t;
  static constexpr Position kNever = std::numeric_limits<Position>::max();
  struct Event {
    Tile tile;
    bool leaves;
  };

  /// `room`: tiles of the arrays, including some that have no events.
  explicit TileEvents(std::size_t room) : enter_(room), leave_(room) {}

  /// Orders the events of `tiles`, whose minimum and maximum differ. Arrays by tile.
  template <class Key>
  void order(const Key* least, const Key* greatest, std::span<const Tile> tiles) {
    Key lowest = std::numeric_limits<Key>::max(), highest = 0;
    for (const Tile tile : tiles) {
      lowest = std::min(lowest, least[tile]);
      highest = std::max(highest, greatest[tile]);
    }
    const auto bits = static_cast<unsigned>(tiles.empty() ? 0 : std::bit_width(static_cast<Key>(highest - lowest)));
    Items<Key> entering(tiles.size()), leaving(tiles.size()), other;
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      entering[i].key = static_cast<Key>(least[tiles[i]] - lowest);
      entering[i].tile = tiles[i];
    }
    sort_in_cache(entering, other, bits, KeyOf());
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      const Tile tile = entering[tiles.size() - 1 - i].tile;
      leaving[i].key = static_cast<Key>(greatest[tile] - lowest);
      leaving[i].tile = tile;
    }
    sort_in_cache(leaving, other, bits, KeyOf());
    merge(entering, leaving);
  }

  [[nodiscard]] std::size_t size() const noexcept { return events_.size(); }
  [[nodiscard]] Event operator[](Position position) const noexcept {
    const std::uint32_t event = events_[static_cast<std::size_t>(position)];
    return {event >> 1, (event & 1u) != 0};
  }
  /// By tile: kNever if it has no events.
  [[nodiscard]] const std::vector<Position>& enter() const noexcept { return enter_; }
  /// By tile: -1 if it has no events.
  [[nodiscard]] const std::vector<Position>& leave() const noexcept { return leave_; }
  [[nodiscard]] bool is_active(Tile tile, Position now) const noexcept {
    return enter_[tile] < now && now < leave_[tile];
  }
  [[nodiscard]] Tile later_to_leave(Tile a, Tile b) const noexcept { return leave_[b] > leave_[a] ? b : a; }
  /// Whether there is no level between two events.
  [[nodiscard]] bool are_at_one_level(Position a, Position b) const noexcept {
    return level_[static_cast<std::size_t>(a)] == level_[static_cast<std::size_t>(b)];
  }

 private:
  template <class Key>
  struct Item {
    Key key;
    Tile tile;
  };
  template <class Key>
  using Items = std::vector<Item<Key>>;
  struct KeyOf {
    template <class Key>
    Key operator()(const Item<Key>& item) const noexcept {
      return item.key;
    }
  };

  template <class Key>
  void merge(const Items<Key>& entering, const Items<Key>& leaving) {
    std::fill(enter_.begin(), enter_.end(), kNever);
    std::fill(leave_.begin(), leave_.end(), Position{-1});
    events_.resize(2 * entering.size());
    level_.resize(events_.size());
    std::uint32_t level = 0;
    Key before = 0;
    std::size_t count = 0;
    const auto add = [&](const Item<Key>& item, std::uint32_t leaves) {
      level += item.key != before ? 1 : 0;
      before = item.key;
      events_[count] = item.tile << 1 | leaves;
      level_[count] = level;
      (leaves != 0 ? leave_ : enter_)[item.tile] = static_cast<Position>(count++);
    };
    auto next = entering.begin();
    for (const Item<Key>& item : leaving) {
      for (; next != entering.end() && next->key <= item.key; ++next) add(*next, 0);
      add(item, 1);
    }
  }

  std::vector<std::uint32_t> events_;  ///< by position: twice the tile, plus 1 if it leaves
  std::vector<std::uint32_t> level_;   ///< by position: equal for events at the same level
  std::vector<Position> enter_, leave_;
};

}  // namespace tegl::detail
