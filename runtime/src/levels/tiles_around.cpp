// SPDX-License-Identifier: BSD-3-Clause
//
// Floods the tiles around a tile, which are bits of a word, in many words at once. Highway's foreach_target compiles
// this file once per instruction set.
#include "levels/tiles_around.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "levels/tiles_around.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<std::uint32_t, kEventsBeyond>;
using Word = hn::Vec<Words>;
using Around = std::span<const TileAround>;

/// The bits of all steps whose coordinate along an axis is not -1, or not 1.
constexpr std::uint32_t bits_except(int axis, int coordinate) {
  std::uint32_t bits = 0;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x)
        if ((axis == 0 ? x : axis == 1 ? y : z) != coordinate) bits |= std::uint32_t{1} << bit_of_step(x, y, z);
  return bits;
}

/// The bits and those one step farther along an axis, in both directions.
template <int kAxis>
HWY_INLINE Word spread(Word bits) {
  constexpr int kShift = kAxis == 0 ? 1 : kAxis == 1 ? 3 : 9;
  const Words d;
  const Word up = hn::ShiftLeft<kShift>(hn::And(bits, hn::Set(d, bits_except(kAxis, 1))));
  const Word down = hn::ShiftRight<kShift>(hn::And(bits, hn::Set(d, bits_except(kAxis, -1))));
  return hn::Or(bits, hn::Or(up, down));
}

template <Neighbourhood kNeighbourhood>
HWY_INLINE Word spread_to_neighbours(Word bits) {
  if constexpr (kNeighbourhood == Neighbourhood::all) {
    return spread<2>(spread<1>(spread<0>(bits)));
  } else if constexpr (kNeighbourhood == Neighbourhood::faces) {
    return hn::Or(spread<0>(bits), hn::Or(spread<1>(bits), spread<2>(bits)));
  } else {
    const Word along = spread<0>(bits);
    return hn::Or(hn::Or(spread<1>(along), spread<2>(along)), spread<2>(spread<1>(bits)));
  }
}

/// The neighbours among the active tiles, and kApart if the active tiles do not connect them.
template <Neighbourhood kNeighbourhood>
HWY_INLINE Word connect(Word active, Word neighbours) {
  const Words d;
  const Word ends = hn::And(active, neighbours);
  Word reached = hn::And(ends, hn::Sub(hn::Zero(d), ends));  // the lowest bit
  for (;;) {
    const Word next = hn::And(spread_to_neighbours<kNeighbourhood>(reached), active);
    if (hn::AllTrue(d, hn::Eq(next, reached))) break;
    reached = next;
  }
  const auto apart = hn::Ne(hn::AndNot(reached, ends), hn::Zero(d));
  return hn::Or(ends, hn::IfThenElseZero(apart, hn::Set(d, kApart)));
}

template <Neighbourhood kNeighbourhood>
HWY_INLINE void find_in_row(const RowOfEvents& row, std::size_t count, Around around, std::uint32_t neighbours) {
  const Words d;
  const hn::RebindToSigned<Words> events;
  const auto as_events = [&](auto mask) { return hn::RebindMask(d, mask); };
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto enter = hn::LoadU(events, row.enter + i);
    const auto leave = hn::LoadU(events, row.leave + i);
    Word at_enter = hn::Zero(d), at_leave = hn::Zero(d);
    for (const TileAround& other : around) {
      const auto from = hn::LoadU(events, row.enter + i + other.distance);
      const auto to = hn::LoadU(events, row.leave + i + other.distance);
      const Word bit = hn::Set(d, std::uint32_t{1} << other.bit);
      const auto entering = as_events(hn::And(hn::Lt(from, enter), hn::Lt(enter, to)));
      const auto leaving = as_events(hn::And(hn::Lt(from, leave), hn::Lt(leave, to)));
      at_enter = hn::Or(at_enter, hn::IfThenElseZero(entering, bit));
      at_leave = hn::Or(at_leave, hn::IfThenElseZero(leaving, bit));
    }
    const Word wanted = hn::Set(d, neighbours);
    hn::StoreU(connect<kNeighbourhood>(at_enter, wanted), d, row.around_enter + i);
    hn::StoreU(connect<kNeighbourhood>(at_leave, wanted), d, row.around_leave + i);
  }
}

void tiles_around(const RowOfEvents& row, std::size_t count, Around around, std::uint32_t neighbours,
                  Neighbourhood neighbourhood) {
  switch (neighbourhood) {
    case Neighbourhood::faces:
      return find_in_row<Neighbourhood::faces>(row, count, around, neighbours);
    case Neighbourhood::faces_and_edges:
      return find_in_row<Neighbourhood::faces_and_edges>(row, count, around, neighbours);
    case Neighbourhood::all:
      return find_in_row<Neighbourhood::all>(row, count, around, neighbours);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(tiles_around);
void find_tiles_around(const RowOfEvents& row, std::size_t count, std::span<const TileAround> around,
                       std::uint32_t neighbours, Neighbourhood neighbourhood) {
  HWY_DYNAMIC_DISPATCH(tiles_around)(row, count, around, neighbours, neighbourhood);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
