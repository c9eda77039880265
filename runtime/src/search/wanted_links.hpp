// SPDX-License-Identifier: BSD-3-Clause
//
// The links that connect neighbouring tiles of a block (see seed_regions.cpp), without superfluous ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <variant>

#include "search/tile_blocks.hpp"

namespace tegl::detail {

/// find_wanted_links reads up to this many ranges beyond the last tile of a row and its neighbours.
inline constexpr std::size_t kReadBeyond = 16;

/// The first minimum and maximum of the tiles of a row, in arrays of the box.
template <class Key>
using RangesOf = std::pair<const Key*, const Key*>;
using RowRanges =
    std::variant<RangesOf<std::uint8_t>, RangesOf<std::uint16_t>, RangesOf<std::uint32_t>, RangesOf<std::uint64_t>>;

/// For `count` tiles of a row, at most 64, and each neighbour ahead: sets bit i of `wanted` if tile i and the neighbour
/// are active at a common level at which no tile between them is (as tested with one or two of these). At other levels
/// the tile between is linked to both, or connected to them by tiles between, so that a link is superfluous.
void find_wanted_links(const RowRanges& row, std::size_t count, std::span<const BlockGrid::Ahead> ahead,
                       std::uint64_t* wanted);

}  // namespace tegl::detail
