// SPDX-License-Identifier: BSD-3-Clause
//
// Decides whether a component is divided when a tile leaves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "levels/tile_events.hpp"

namespace tegl::detail {

/// Searches for connected active tiles, a tile of each search in turn, until all of them but one are finished: the time
/// depends on the smaller parts. Searches that meet go on as a set, which is known by one of them.
class SearchesInTurn {
 public:
  using Tile = TileEvents::Tile;

  /// `distances`: to the neighbours. Both outlive this.
  SearchesInTurn(const TileEvents& events, std::size_t room, std::span<const std::ptrdiff_t> distances)
      : events_(events), distances_(distances), found_(room) {}

  /// Forgets all tiles, and sets how many the next calls of `run` may visit in all.
  void restart(std::size_t most_tiles);
  /// Searches from each of `starts` the tiles active at `now`. False if it takes too long.
  [[nodiscard]] bool run(std::span<const Tile> starts, TileEvents::Position now);

  /// The only set that is not finished. It has the tiles that were not found, too.
  [[nodiscard]] std::size_t rest() const noexcept;
  /// The set that has a tile.
  [[nodiscard]] std::size_t set_with(Tile tile) const noexcept {
    return found_[tile] < first_ ? rest() : set_of(found_[tile] - first_);
  }
  /// Calls visit(set) for the finished sets.
  template <class Visit>
  void for_finished(const Visit& visit) const {
    for (std::size_t set = 0; set < count_; ++set)
      if (searches_[set].set == set && searches_[set].open == 0) visit(set);
  }
  /// Calls visit(tile) for the tiles of a finished set.
  template <class Visit>
  void for_tiles(std::size_t set, const Visit& visit) const {
    for (std::size_t i = 0; i < count_; ++i)
      if (set_of(i) == set)
        for (const Tile tile : searches_[i].tiles) visit(tile);
  }

 private:
  struct Search {
    std::vector<Tile> tiles;
    std::size_t done = 0;  ///< tiles whose neighbours are found
    std::size_t set = 0;   ///< towards the search that stands for the set
    std::size_t open = 0;  ///< by set: number of its searches that go on
  };

  [[nodiscard]] std::size_t set_of(std::size_t search) const noexcept {
    while (searches_[search].set != search) search = searches_[search].set;
    return search;
  }
  void start(std::span<const Tile> starts);
  /// Finds the neighbours of the next tile of a search. Returns the number of sets that are not finished.
  [[nodiscard]] std::size_t advance(std::size_t number, TileEvents::Position now, std::size_t sets);

  const TileEvents& events_;
  std::span<const std::ptrdiff_t> distances_;
  std::vector<Search> searches_;
  std::size_t count_ = 0;
  std::vector<std::uint32_t> found_;  ///< by tile: `first_` plus the search that found it; less: not found
  std::uint32_t first_ = 1;
  std::size_t tiles_left_ = 0;
};

}  // namespace tegl::detail
