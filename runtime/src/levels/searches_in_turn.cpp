// SPDX-License-Identifier: BSD-3-Clause
#include "levels/searches_in_turn.hpp"

#include <algorithm>

namespace tegl::detail {

void SearchesInTurn::restart(std::size_t most_tiles) {
  std::fill(found_.begin(), found_.end(), 0);
  first_ = 1;
  count_ = 0;
  tiles_left_ = most_tiles;
}

bool SearchesInTurn::run(std::span<const Tile> starts, TileEvents::Position now) {
  start(starts);
  std::size_t sets = count_;
  for (std::size_t i = 0; sets > 1; i = i + 1 < count_ ? i + 1 : 0) {
    if (searches_[i].done == searches_[i].tiles.size()) continue;
    if (tiles_left_-- == 0) return false;
    sets = advance(i, now, sets);
  }
  return true;
}

std::size_t SearchesInTurn::rest() const noexcept {
  std::size_t set = 0;
  while (searches_[set].set != set || searches_[set].open == 0) ++set;
  return set;
}

void SearchesInTurn::start(std::span<const Tile> starts) {
  first_ += static_cast<std::uint32_t>(count_);
  count_ = starts.size();
  if (searches_.size() < count_) searches_.resize(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    searches_[i].tiles.assign(1, starts[i]);
    searches_[i].done = 0;
    searches_[i].set = i;
    searches_[i].open = 1;
    found_[starts[i]] = static_cast<std::uint32_t>(first_ + i);
  }
}

std::size_t SearchesInTurn::advance(std::size_t number, TileEvents::Position now, std::size_t sets) {
  Search& search = searches_[number];
  const Tile from = search.tiles[search.done++];
  std::size_t set = set_of(number);
  for (const std::ptrdiff_t distance : distances_) {
    const auto other = static_cast<Tile>(from + distance);
    if (!events_.is_active(other, now)) continue;
    if (found_[other] < first_) {
      found_[other] = static_cast<std::uint32_t>(first_ + number);
      search.tiles.push_back(other);
      continue;
    }
    const std::size_t met = set_of(found_[other] - first_);
    if (met == set) continue;
    searches_[met].open += searches_[set].open;
    searches_[set].set = met;
    set = met;
    if (--sets == 1) return sets;  // this one is the rest, even if its searches end here
  }
  if (search.done == search.tiles.size() && --searches_[set].open == 0) --sets;
  return sets;
}

}  // namespace tegl::detail
