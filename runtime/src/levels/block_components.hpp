// SPDX-License-Identifier: BSD-3-Clause
//
// The components of the active tiles of a block, at all levels at once.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "levels/searches_in_turn.hpp"
#include "levels/tile_events.hpp"
#include "levels/tiles_around.hpp"

namespace tegl::detail {

/// Sweeps the levels of a block upwards. Each component has a root at each level, one of its active tiles. When the
/// root leaves, the tile that stays active longest takes its place, and of those that leave at the same level, the
/// widest one. So few tiles are roots.
///
/// Nearly all tiles enter beside one component and leave without dividing it, which the active tiles around show (see
/// tiles_around.hpp). At other events, components are joined, or searches decide whether they are divided.
///
/// Arrays have the tiles of a box: a block and a margin. 2D and 3D.
class BlockComponents {
 public:
  using Tile = TileEvents::Tile;
  using Position = TileEvents::Position;
  /// A row of tiles: the first one, and their number.
  using Row = std::pair<Tile, std::uint32_t>;

  /// `room`: tiles of a box. `steps`: distance to the next tile along each axis. `distances`: to the neighbours, those
  /// of `neighbourhood`.
  BlockComponents(std::size_t room, std::span<const std::size_t> steps, Neighbourhood neighbourhood,
                  std::span<const std::ptrdiff_t> distances);
  BlockComponents(const BlockComponents&) = delete;
  BlockComponents& operator=(const BlockComponents&) = delete;
  ~BlockComponents() = default;

  /// Finds all components. `tiles`: the tiles of the block whose minimum and maximum differ, in `rows`. False if it
  /// takes too long, as in noise.
  template <class Key>
  [[nodiscard]] bool find(const Key* least, const Key* greatest, std::span<const Tile> tiles,
                          std::span<const Row> rows) {
    events_.order(least, greatest, tiles);
    return sweep(tiles, rows);
  }
  /// The roots, ascending.
  [[nodiscard]] std::span<const Tile> roots() const noexcept { return roots_; }
  /// Calls visit(root, event) for the roots of a tile's component in ascending order of levels, each until an event:
  /// the last one is that the tile leaves. There may be no level between two events.
  template <class Visit>
  void for_roots(Tile tile, const Visit& visit);

 private:
  using ArcNumber = std::uint32_t;
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr Position kNever = TileEvents::kNever;

  /// A component with one root.
  struct Arc {
    Tile root;
    Tile last;  ///< the tile of the component that leaves last; known while the component exists
    Position begin;
    Position end = kNever;   ///< the root leaves, or the component becomes part of another
    ArcNumber next = kNone;  ///< that follows at `end`
    ArcNumber newest;        ///< towards the arc that follows last
  };
  /// A tile belongs to another component from the begin of an arc on, because its own was divided.
  struct Change {
    ArcNumber arc;
    std::uint32_t before;  ///< change of the same tile, or kNone
  };

  [[nodiscard]] bool sweep(std::span<const Tile> tiles, std::span<const Row> rows);
  void enter(Tile tile, Position now);
  [[nodiscard]] bool leave(Tile tile, Position now);
  [[nodiscard]] bool search_around(Tile tile, Position now);
  void divide(ArcNumber arc, Tile tile, Position now);
  void collect_roots();
  ArcNumber add_arc(Tile root, Tile last, Position begin);
  void set_root(Arc& arc, Tile root);
  void end_arc(ArcNumber arc, Position end, ArcNumber next);
  [[nodiscard]] ArcNumber newest(ArcNumber arc) noexcept;
  [[nodiscard]] ArcNumber arc_of(Tile tile) noexcept { return newest(last_arc_[tile]); }
  [[nodiscard]] ArcNumber join(ArcNumber a, ArcNumber b, Position now);
  void change(Tile tile, ArcNumber arc);
  [[nodiscard]] Tile around(Tile tile, std::uint32_t bits) const noexcept;

  Neighbourhood neighbourhood_;
  std::vector<std::ptrdiff_t> distances_;  ///< of the neighbours
  std::uint32_t neighbours_ = 0;           ///< their bits
  std::vector<TileAround> around_;
  std::array<std::ptrdiff_t, 27> distance_of_bit_{};
  std::array<std::uint32_t, 27> beside_bit_{};  ///< the neighbours of a tile around that are tiles around, too
  TileEvents events_;
  SearchesInTurn searches_;
  std::span<const Tile> tiles_;  ///< of the block
  std::vector<std::uint32_t> around_enter_, around_leave_;
  std::vector<ArcNumber> first_arc_, last_arc_;  ///< by tile: they differ if it has changes
  std::vector<std::uint32_t> last_change_;       ///< by tile that has any
  std::vector<bool> is_root_;
  std::vector<Tile> roots_;
  std::vector<Arc> arcs_;
  std::vector<Change> changes_;
  std::vector<Tile> starts_;
  std::vector<ArcNumber> path_;  ///< see for_roots
};

template <class Visit>
void BlockComponents::for_roots(Tile tile, const Visit& visit) {
  path_.clear();  // changes, the earliest last
  if (first_arc_[tile] != last_arc_[tile])
    for (std::uint32_t change = last_change_[tile]; change != kNone; change = changes_[change].before)
      path_.push_back(changes_[change].arc);
  const Position end = events_.leave()[tile];
  for (ArcNumber arc = first_arc_[tile];;) {
    const Position change = path_.empty() ? kNever : arcs_[path_.back()].begin;
    const Position to = std::min({change, arcs_[arc].end, end});
    visit(arcs_[arc].root, events_[to]);
    if (to == end) return;
    if (to == change) {
      arc = path_.back();
      path_.pop_back();
    } else {
      arc = arcs_[arc].next;
    }
  }
}

}  // namespace tegl::detail
