// SPDX-License-Identifier: BSD-3-Clause
//
// The active tiles around each tile of a row, and whether they are connected without the tile.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "tegl/seed_set.hpp"

namespace tegl::detail {

/// The tiles around a tile are bits of a word. The step x, y, z (each -1, 0 or 1) has this bit.
[[nodiscard]] constexpr int bit_of_step(int x, int y, int z) noexcept { return x + 1 + 3 * (y + 1) + 9 * (z + 1); }
/// Set if the neighbours in a word are not connected by tiles around.
inline constexpr std::uint32_t kApart = std::uint32_t{1} << 31;

/// A tile around another one: its distance in the arrays, and its bit.
struct TileAround {
  std::ptrdiff_t distance;
  std::uint32_t bit;
};

/// find_tiles_around reads and writes up to this many entries beyond the last tile of a row and its neighbours.
inline constexpr std::size_t kEventsBeyond = 16;

/// Arrays from the first tile of a row on. A tile is active between two events: it enters and it leaves.
struct RowOfEvents {
  const std::int32_t* enter;  ///< the number of the event
  const std::int32_t* leave;
  std::uint32_t* around_enter;  ///< result: the neighbours that are active when the tile enters, and kApart
  std::uint32_t* around_leave;  ///< when it leaves
};

/// For `count` tiles of a row: finds the active neighbours, of those in `neighbours` (bits), when the tile enters and
/// when it leaves, and whether all of these are connected by active tiles in `around`, without the tile.
void find_tiles_around(const RowOfEvents& row, std::size_t count, std::span<const TileAround> around,
                       std::uint32_t neighbours, Neighbourhood neighbourhood);

}  // namespace tegl::detail
