// SPDX-License-Identifier: BSD-3-Clause
//
// Compares the ranges of tiles, many at once. Highway's foreach_target compiles this file once per instruction set.
#include "search/wanted_links.hpp"

#include <array>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "search/wanted_links.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Ahead = std::span<const BlockGrid::Ahead>;

/// The bits of one vector of tiles, from tile i on; stores their levels.
template <class Key>
HWY_INLINE std::uint64_t bits_of(const RowOfLinks<Key>& row, std::size_t i, const BlockGrid::Ahead& ahead,
                                 std::size_t first_level) {
  const hn::CappedTag<Key, kReadBeyond> d;
  const Key* least = row.least + i;
  const Key* greatest = row.greatest + i;
  auto low = hn::Max(hn::LoadU(d, least), hn::LoadU(d, least + ahead.distance));
  auto high = hn::Min(hn::LoadU(d, greatest), hn::LoadU(d, greatest + ahead.distance));
  if (hn::AllFalse(d, hn::Lt(low, high))) return 0;
  for (const BlockGrid::Detour& detour : ahead.detours) {
    const auto first = hn::Max(hn::LoadU(d, least + detour.by), hn::LoadU(d, least + detour.and_by));
    const auto end = hn::Min(hn::LoadU(d, greatest + detour.by), hn::LoadU(d, greatest + detour.and_by));
    const auto any = hn::Lt(first, end);
    const auto below = hn::AndNot(hn::Lt(low, first), hn::And(any, hn::Lt(low, end)));
    const auto above = hn::AndNot(hn::Lt(end, high), hn::And(any, hn::Lt(first, high)));
    low = hn::IfThenElse(below, end, low);
    high = hn::IfThenElse(above, first, high);
  }
  hn::StoreU(low, d, row.low + first_level + i);
  hn::StoreU(high, d, row.high + first_level + i);
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(d, hn::Lt(low, high), bytes.data());
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes.data(), sizeof bits);
  return bits;
}

template <class Key>
HWY_INLINE void find_in_row(const RowOfLinks<Key>& row, std::size_t count, Ahead ahead, std::uint64_t* wanted) {
  const std::size_t lanes = hn::Lanes(hn::CappedTag<Key, kReadBeyond>());
  static_assert(kMostOfRow % kReadBeyond == 0, "the last vector of a row stays in its word and its levels");
  const std::uint64_t all = ~std::uint64_t{0} >> (kMostOfRow - count);
  for (std::size_t a = 0; a < ahead.size(); ++a) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < count; i += lanes) bits |= bits_of(row, i, ahead[a], a * kMostOfRow) << i;
    wanted[a] = bits & all;
  }
}

void wanted_in_row(const AnyRowOfLinks& any_row, std::size_t count, Ahead ahead, std::uint64_t* wanted) {
  std::visit([&](const auto& row) { find_in_row(row, count, ahead, wanted); }, any_row);
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(wanted_in_row);
void find_wanted_links(const AnyRowOfLinks& row, std::size_t count, std::span<const BlockGrid::Ahead> ahead,
                       std::uint64_t* wanted) {
  HWY_DYNAMIC_DISPATCH(wanted_in_row)(row, count, ahead, wanted);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
