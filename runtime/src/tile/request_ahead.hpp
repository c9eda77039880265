// SPDX-License-Identifier: BSD-3-Clause
//
// Requests parts of a 4D table before they are read: 3.5 MB of simplices and 256 kB of entries, seldom in a cache.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "hwy/cache_control.h"
#include "tile/row_table.hpp"

namespace tegl::detail {

/// Call while tile i of a 4D row of `count` active tiles is written. Requests the entry of a later tile and, from the
/// entry of one before that, which was requested earlier, its simplices. `signatures`: of the tiles; 2 * kAhead more
/// follow.
[[gnu::always_inline]] inline void request_ahead(const RowTable& table, const std::uint16_t* signatures, std::size_t i,
                                                 std::size_t count) noexcept {
  constexpr std::size_t kAhead = 3;  // tiles
  hwy::Prefetch(table.entries + signatures[i + 2 * kAhead]);
  const std::uint32_t entry = table.entries[signatures[std::min(i + kAhead, count - 1)]];
  // Tiles with own vertices, and those resolved from the data, are not written from the table.
  const std::size_t bytes = (entry & RowTable::kOwnFlag) == 0 ? 4 : 0;
  const std::uint8_t* const simplices = table.simplices + bytes * (entry >> RowTable::kFirstShift);
  hwy::Prefetch(simplices);
  hwy::Prefetch(simplices + bytes * (entry & RowTable::kCountMask));
}

}  // namespace tegl::detail
