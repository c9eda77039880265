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

/// The bits of one vector of tiles.
template <class Key>
HWY_INLINE std::uint64_t bits_of(const Key* least, const Key* greatest, const BlockGrid::Ahead& ahead) {
  const hn::CappedTag<Key, kReadBeyond> d;
  const auto from = hn::Max(hn::LoadU(d, least), hn::LoadU(d, least + ahead.distance));
  const auto to = hn::Min(hn::LoadU(d, greatest), hn::LoadU(d, greatest + ahead.distance));
  if (hn::AllFalse(d, hn::Lt(from, to))) return 0;
  // levels that are not covered yet
  auto low = from, high = to;
  for (const std::ptrdiff_t distance : ahead.between) {
    const auto first = hn::LoadU(d, least + distance);
    const auto end = hn::LoadU(d, greatest + distance);
    low = hn::IfThenElse(hn::AndNot(hn::Lt(from, first), hn::Lt(low, end)), end, low);
    high = hn::IfThenElse(hn::AndNot(hn::Lt(end, to), hn::Lt(first, high)), first, high);
  }
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(d, hn::Lt(low, high), bytes.data());
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes.data(), sizeof bits);
  return bits;
}

template <class Key>
HWY_INLINE void find_in_row(const Key* least, const Key* greatest, std::size_t count, Ahead ahead,
                            std::uint64_t* wanted) {
  const std::size_t lanes = hn::Lanes(hn::CappedTag<Key, kReadBeyond>());
  static_assert(64 % kReadBeyond == 0, "the bits of the last vector of 64 tiles are shifted into one word");
  const std::uint64_t all = ~std::uint64_t{0} >> (64 - count);
  for (std::size_t a = 0; a < ahead.size(); ++a) {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < count; i += lanes) bits |= bits_of(least + i, greatest + i, ahead[a]) << i;
    wanted[a] = bits & all;
  }
}

void wanted_in_row(const RowRanges& row, std::size_t count, Ahead ahead, std::uint64_t* wanted) {
  std::visit([&](const auto& ranges) { find_in_row(ranges.first, ranges.second, count, ahead, wanted); }, row);
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(wanted_in_row);
void find_wanted_links(const RowRanges& row, std::size_t count, std::span<const BlockGrid::Ahead> ahead,
                       std::uint64_t* wanted) {
  HWY_DYNAMIC_DISPATCH(wanted_in_row)(row, count, ahead, wanted);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
