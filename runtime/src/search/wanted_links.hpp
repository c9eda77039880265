// SPDX-License-Identifier: BSD-3-Clause
//
// The links that connect neighbouring tiles of a block (see seed_regions.cpp), without superfluous ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>

#include "search/tile_blocks.hpp"

namespace tegl::detail {

/// find_wanted_links reads up to this many ranges beyond the last tile of a row and its neighbours.
inline constexpr std::size_t kReadBeyond = 16;
/// Maximum number of tiles of a row.
inline constexpr std::size_t kMostOfRow = 64;

/// The tiles of a row, in arrays of the box, and the levels of their links.
template <class Key>
struct RowOfLinks {
  const Key* least;  ///< of the first tile
  const Key* greatest;
  /// By neighbour ahead, kMostOfRow entries each: tile i needs a link to the neighbour from level `low` to `high`.
  Key* low;
  Key* high;
};
using AnyRowOfLinks = std::variant<RowOfLinks<std::uint8_t>, RowOfLinks<std::uint16_t>, RowOfLinks<std::uint32_t>,
                                   RowOfLinks<std::uint64_t>>;

/// For `count` tiles of a row and each neighbour ahead: sets bit i of `wanted` if tile i needs a link to the neighbour,
/// and then the levels of the link. Both are active there. At their other common levels a detour connects them (see
/// BlockGrid::Ahead), so that the link is superfluous; gaps between the levels of detours are not used.
void find_wanted_links(const AnyRowOfLinks& row, std::size_t count, std::span<const BlockGrid::Ahead> ahead,
                       std::uint64_t* wanted);

}  // namespace tegl::detail
