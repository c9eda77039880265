// SPDX-License-Identifier: BSD-3-Clause
//
// The sweep over the events of a block.
#include "levels/block_components.hpp"

#include <algorithm>
#include <bit>

namespace tegl::detail {

namespace {

constexpr std::size_t kSearchedPerTile = 8;  ///< tiles that searches may visit for each tile of a block, on average

}  // namespace

BlockComponents::BlockComponents(std::size_t room, std::span<const std::size_t> steps, Neighbourhood neighbourhood,
                                 std::span<const std::ptrdiff_t> distances)
    : neighbourhood_(steps.size() == 2 && neighbourhood != Neighbourhood::all ? Neighbourhood::faces : neighbourhood),
      distances_(distances.begin(), distances.end()),
      events_(room + kEventsBeyond),
      searches_(events_, room, distances_),
      around_enter_(room + kEventsBeyond),
      around_leave_(room + kEventsBeyond),
      first_arc_(room),
      last_arc_(room),
      last_change_(room),
      is_root_(room) {
  const auto is_neighbour = [&](std::ptrdiff_t distance) {
    return std::find(distances.begin(), distances.end(), distance) != distances.end();
  };
  const int depth = steps.size() > 2 ? 1 : 0;
  for (int z = -depth; z <= depth; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        std::ptrdiff_t distance = 0;
        for (std::size_t a = 0; a < steps.size(); ++a)
          distance += std::array{x, y, z}[a] * static_cast<std::ptrdiff_t>(steps[a]);
        const auto bit = static_cast<std::uint32_t>(bit_of_step(x, y, z));
        around_.push_back({distance, bit});
        distance_of_bit_[bit] = distance;
        if (is_neighbour(distance)) neighbours_ |= std::uint32_t{1} << bit;
      }
  for (const TileAround& a : around_)
    for (const TileAround& b : around_)
      if (is_neighbour(b.distance - a.distance)) beside_bit_[a.bit] |= std::uint32_t{1} << b.bit;
}

bool BlockComponents::sweep(std::span<const Tile> tiles, std::span<const Row> rows) {
  tiles_ = tiles;
  for (const auto& [tile, count] : rows)
    find_tiles_around({&events_.enter()[tile], &events_.leave()[tile], &around_enter_[tile], &around_leave_[tile]},
                      count, around_, neighbours_, neighbourhood_);
  std::fill(is_root_.begin(), is_root_.end(), false);
  searches_.restart(kSearchedPerTile * tiles.size());
  arcs_.clear();
  changes_.clear();
  const auto count = static_cast<Position>(events_.size());
  for (Position now = 0; now < count; ++now) {
    const auto [tile, leaves] = events_[now];
    if (!leaves)
      enter(tile, now);
    else if (!leave(tile, now))
      return false;
  }
  collect_roots();
  return true;
}

void BlockComponents::enter(Tile tile, Position now) {
  const std::uint32_t bits = around_enter_[tile];
  ArcNumber arc = kNone;
  if (bits == 0) {
    arc = add_arc(tile, tile, now);
  } else {
    arc = arc_of(around(tile, bits));
    if ((bits & kApart) != 0)
      for (std::uint32_t rest = bits & ~kApart; (rest &= rest - 1) != 0;)
        arc = join(arc, arc_of(around(tile, rest)), now);
    Arc& own = arcs_[arc];
    if (events_.leave()[tile] > events_.leave()[own.last]) {
      own.last = tile;
      if (events_.are_at_one_level(own.begin, now)) set_root(own, tile);
    }
  }
  first_arc_[tile] = last_arc_[tile] = arc;
}

/// False if it takes too long.
bool BlockComponents::leave(Tile tile, Position now) {
  const std::uint32_t bits = around_leave_[tile];
  if ((bits & kApart) != 0) {
    if (!search_around(tile, now)) return false;
    divide(arc_of(tile), tile, now);
  } else if (is_root_[tile]) {
    const ArcNumber arc = arc_of(tile);
    if (arcs_[arc].root != tile) return true;
    const Tile last = arcs_[arc].last;
    if (bits == 0)
      end_arc(arc, now, arc);
    else
      end_arc(arc, now, add_arc(last, last, now));
  }
  return true;
}

/// Searches from one tile of each part around.
bool BlockComponents::search_around(Tile tile, Position now) {
  starts_.clear();
  for (std::uint32_t bits = around_leave_[tile] & ~kApart; bits != 0;) {
    starts_.push_back(around(tile, bits));
    for (std::uint32_t open = bits & -bits; open != 0;) {
      bits &= ~open;
      const auto next = static_cast<std::size_t>(std::countr_zero(open));
      open = (open & (open - 1)) | (beside_bit_[next] & bits);
    }
  }
  return searches_.run(starts_, now);
}

/// Gives the finished parts new arcs. The rest keeps its arc if its root is one of its tiles and stays.
void BlockComponents::divide(ArcNumber arc, Tile tile, Position now) {
  const Tile root = arcs_[arc].root;
  const std::size_t rest = searches_.rest();
  const bool keeps_root = root != tile && searches_.set_with(root) == rest;
  const bool keeps_last = searches_.set_with(arcs_[arc].last) == rest;
  searches_.for_finished([&](std::size_t set) {
    Tile last = 0;
    bool has_root = false;
    searches_.for_tiles(set, [&](Tile of) {
      last = events_.later_to_leave(last, of);
      has_root = has_root || of == root;
    });
    const ArcNumber own = add_arc(has_root ? root : last, last, now);
    searches_.for_tiles(set, [&](Tile of) { change(of, own); });
  });
  Tile last = keeps_last ? arcs_[arc].last : 0;
  if (!keeps_last)
    for (const Tile of : tiles_)
      if (events_.is_active(of, now) && arc_of(of) == arc) last = events_.later_to_leave(last, of);
  arcs_[arc].last = last;
  if (!keeps_root) end_arc(arc, now, add_arc(last, last, now));
}

/// Leaves out arcs without a level.
void BlockComponents::collect_roots() {
  std::fill(is_root_.begin(), is_root_.end(), false);
  roots_.clear();
  for (const Arc& arc : arcs_) {
    if (events_.are_at_one_level(arc.begin, arc.end) || is_root_[arc.root]) continue;
    is_root_[arc.root] = true;
    roots_.push_back(arc.root);
  }
  std::sort(roots_.begin(), roots_.end());
}

BlockComponents::ArcNumber BlockComponents::add_arc(Tile root, Tile last, Position begin) {
  const auto number = static_cast<ArcNumber>(arcs_.size());
  arcs_.push_back({.root = root, .last = last, .begin = begin, .newest = number});
  is_root_[root] = true;
  return number;
}

void BlockComponents::set_root(Arc& arc, Tile root) {
  arc.root = root;
  is_root_[root] = true;
}

void BlockComponents::end_arc(ArcNumber arc, Position end, ArcNumber next) {
  arcs_[arc].end = end;
  arcs_[arc].next = arcs_[arc].newest = next;
}

BlockComponents::ArcNumber BlockComponents::newest(ArcNumber arc) noexcept {
  while (arcs_[arc].newest != arc) {
    arcs_[arc].newest = arcs_[arcs_[arc].newest].newest;
    arc = arcs_[arc].newest;
  }
  return arc;
}

/// Of two components, the one whose root leaves later goes on.
BlockComponents::ArcNumber BlockComponents::join(ArcNumber a, ArcNumber b, Position now) {
  if (a == b) return a;
  if (events_.later_to_leave(arcs_[a].root, arcs_[b].root) != arcs_[a].root) std::swap(a, b);
  arcs_[a].last = events_.later_to_leave(arcs_[a].last, arcs_[b].last);
  end_arc(b, now, a);
  return a;
}

void BlockComponents::change(Tile tile, ArcNumber arc) {
  const std::uint32_t before = first_arc_[tile] == last_arc_[tile] ? kNone : last_change_[tile];
  last_change_[tile] = static_cast<std::uint32_t>(changes_.size());
  changes_.push_back({arc, before});
  last_arc_[tile] = arc;
}

/// The tile around that the lowest bit stands for.
BlockComponents::Tile BlockComponents::around(Tile tile, std::uint32_t bits) const noexcept {
  return static_cast<Tile>(tile + distance_of_bit_[static_cast<std::size_t>(std::countr_zero(bits))]);
}

}  // namespace tegl::detail
