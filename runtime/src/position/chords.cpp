// SPDX-License-Identifier: BSD-3-Clause
//
// Moves points towards the chords of their curves (see chords.hpp), as many at a time as a register has lanes.
// Highway's foreach_target compiles this file once per instruction set. Multiplications and additions are not fused.
#include "position/chords.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "position/chords.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Neighbours in a curve, by lane: position along the point's edge and distance across it.
template <class D>
struct Neighbours {
  hn::Vec<D> along, across;
  hn::Mask<D> exist;
};

template <class D>
HWY_INLINE Neighbours<D> neighbours(D d, hn::Vec<hn::RebindToUnsigned<D>> links, bool before, const float* places) {
  const hn::RebindToUnsigned<D> du;
  const hn::RebindToSigned<D> di;
  // Sides as in ContourNet: on the edge across the square, or at the lower or the upper end of the point's own edge.
  const auto side = hn::ShiftRight<30>(links);
  const auto exist = hn::RebindMask(d, hn::Ne(side, hn::Set(du, 3)));
  const auto point = hn::And(links, hn::Set(du, (1u << 30) - 1));
  const auto number = hn::IfThenElseZero(hn::RebindMask(du, exist), point);
  const auto place = hn::GatherIndex(d, places, hn::BitCast(di, number));
  const auto one = hn::Set(d, 1.0f);
  const auto is_across = hn::RebindMask(d, hn::Eq(side, hn::Zero(du)));
  const auto at_end = hn::IfThenElseZero(hn::RebindMask(d, hn::Eq(side, hn::Set(du, 2))), one);
  return {hn::IfThenElse(is_across, place, at_end),
          hn::IfThenElse(is_across, one, before ? hn::Sub(one, place) : place), exist};
}

template <class D>
HWY_INLINE void move_some(D d, const ChordMoves& moves, const float* places, std::size_t p, float* next) {
  const hn::RebindToUnsigned<D> du;
  const auto here = hn::LoadU(d, places + p);
  auto sum = hn::Zero(d), all = sum;
  for (int c = 0; c < moves.curves; ++c) {
    hn::Vec<decltype(du)> links_before, links_after;
    hn::LoadInterleaved2(du, moves.links + 2 * (static_cast<std::size_t>(c) * moves.points + p), links_before,
                         links_after);
    const auto before = neighbours(d, links_before, true, places), after = neighbours(d, links_after, false, places);
    const auto both = hn::And(before.exist, after.exist);
    const auto weight = hn::IfThenElseZero(both, hn::Set(d, moves.weights[c]));
    // the distance from the chord, along the edge
    const auto on_chord = hn::Div(hn::Add(hn::Mul(before.along, after.across), hn::Mul(after.along, before.across)),
                                  hn::Add(before.across, after.across));
    const auto above = hn::IfThenElseZero(both, hn::Sub(here, on_chord));
    sum = hn::Add(sum, hn::Mul(above, weight));
    all = hn::Add(all, weight);
  }
  const auto moved = hn::Sub(here, hn::Div(hn::Mul(hn::Set(d, moves.factor), sum), all));
  const auto inside = hn::Min(hn::Max(moved, hn::Set(d, moves.low)), hn::Set(d, moves.high));
  hn::StoreU(hn::IfThenElse(hn::Gt(all, hn::Zero(d)), inside, here), d, next + p);
}

void move_points(const ChordMoves& moves, const float* places, std::size_t from, std::size_t end, float* next) {
  const hn::ScalableTag<float> d;
  std::size_t p = from;
  for (; p + hn::Lanes(d) <= end; p += hn::Lanes(d)) move_some(d, moves, places, p, next);
  for (; p < end; ++p) move_some(hn::CappedTag<float, 1>(), moves, places, p, next);
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(move_points);

void move_to_chords(const ChordMoves& moves, const float* places, std::size_t from, std::size_t end,
                    float* next) noexcept {
  HWY_DYNAMIC_DISPATCH(move_points)(moves, places, from, end, next);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
