// SPDX-License-Identifier: BSD-3-Clause
//
// Grows regions of corners of many tesseracts in the lanes of registers (see connected_sides.hpp). Highway's
// foreach_target compiles this file once per instruction set.
#include "ambiguity/connected_sides.hpp"

#include <algorithm>

#include "tile/tesseract_fill.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ambiguity/connected_sides.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using SideTag = hn::CappedTag<std::uint16_t, 32>;
using Sides = hn::Vec<SideTag>;

HWY_INLINE Sides bits_in_all(unsigned bits) { return hn::Set(SideTag(), static_cast<std::uint16_t>(bits)); }

/// Corners at the lower ends of an axis.
constexpr unsigned lower_ends(int axis) {
  unsigned corners = 0;
  for (unsigned v = 0; v < 16; ++v) corners |= (v >> axis & 1u) == 0 ? 1u << v : 0u;
  return corners;
}

/// Some sides, and the faces that connect their corners.
struct Connections {
  Sides corners;
  std::array<Sides, 6> bases;  ///< by pair of axes: base corners of the squares that span it and connect
  std::array<Sides, 8> cubes;  ///< the corners in each cube that connects

  HWY_INLINE Connections(const BoundarySides& sides, std::size_t i) {
    const SideTag d;
    corners = hn::Load(d, sides.corners.data() + i);
    take_squares<0>(hn::Load(d, sides.squares.data() + i));
    take_squares<1>(hn::ShiftRight<4>(hn::Load(d, sides.squares.data() + i)));
    take_squares<2>(hn::ShiftRight<8>(hn::Load(d, sides.squares.data() + i)));
    take_squares<3>(hn::ShiftRight<12>(hn::Load(d, sides.squares.data() + i)));
    take_squares<4>(hn::Load(d, sides.more_squares.data() + i));
    take_squares<5>(hn::ShiftRight<4>(hn::Load(d, sides.more_squares.data() + i)));
    const auto of_cubes = hn::Load(d, sides.cubes.data() + i);
    for (unsigned f = 0; f < 8; ++f) {
      const unsigned lower = lower_ends(static_cast<int>(f / 2));
      const auto connects = hn::Ne(hn::And(of_cubes, bits_in_all(1u << f)), hn::Zero(d));
      cubes[f] = hn::IfThenElseZero(connects, hn::And(corners, bits_in_all(f % 2 == 0 ? lower : ~lower)));
    }
  }

  /// `squares`: those of the pair in the lowest four bits.
  template <unsigned Pair>
  HWY_INLINE void take_squares(Sides squares) {
    const SideTag d;
    bases[Pair] = hn::Zero(d);
    for (unsigned i = 0; i < 4; ++i) {
      const auto connects = hn::Ne(hn::And(squares, bits_in_all(1u << i)), hn::Zero(d));
      const unsigned base = 1u << kTesseractSquares[4 * Pair + i].base;
      bases[Pair] = hn::Or(bases[Pair], hn::IfThenElseZero(connects, bits_in_all(base)));
    }
  }

  /// The corners at the other ends of edges along an axis.
  template <int Axis>
  static HWY_INLINE Sides ends_along(Sides from) {
    constexpr int kStep = 1 << Axis;
    const auto lower = bits_in_all(lower_ends(Axis));
    const auto up = hn::ShiftLeft<kStep>(hn::And(from, lower));
    const auto down = hn::And(hn::ShiftRight<kStep>(from), lower);
    return hn::Or(up, down);
  }
  /// The opposite corners of squares that connect.
  template <unsigned Pair>
  HWY_INLINE Sides opposite(Sides from) const {
    constexpr unsigned kAxes = kTesseractSquares[4 * Pair].axes;
    constexpr int kFirst = static_cast<int>(kAxes & (0u - kAxes)), kSecond = static_cast<int>(kAxes) - kFirst;
    const auto base = bases[Pair], beside = hn::ShiftLeft<kFirst>(base);
    const auto up = hn::Or(hn::ShiftLeft<kFirst + kSecond>(hn::And(from, base)),
                           hn::ShiftLeft<kSecond - kFirst>(hn::And(from, beside)));
    const auto down = hn::Or(hn::And(hn::ShiftRight<kFirst + kSecond>(from), base),
                             hn::And(hn::ShiftRight<kSecond - kFirst>(from), beside));
    return hn::Or(up, down);
  }
  template <int Axis>
  HWY_INLINE Sides along(Sides reached) const {
    return hn::And(hn::Or(reached, ends_along<Axis>(reached)), corners);
  }
  /// Adds corners that are connected with those reached: along each axis after the other, then across all squares at
  /// once, and in all cubes at once.
  HWY_INLINE Sides grown(Sides reached) const {
    const SideTag d;
    reached = along<3>(along<2>(along<1>(along<0>(reached))));
    const auto lower = hn::Or(opposite<0>(reached), hn::Or(opposite<1>(reached), opposite<2>(reached)));
    const auto upper = hn::Or(opposite<3>(reached), hn::Or(opposite<4>(reached), opposite<5>(reached)));
    reached = hn::And(hn::Or(reached, hn::Or(lower, upper)), corners);
    std::array<Sides, 8> joined;
    for (std::size_t f = 0; f < 8; ++f)
      joined[f] = hn::IfThenElseZero(hn::Ne(hn::And(reached, cubes[f]), hn::Zero(d)), cubes[f]);
    const auto along_01 = hn::Or(hn::Or(joined[0], joined[1]), hn::Or(joined[2], joined[3]));
    const auto along_23 = hn::Or(hn::Or(joined[4], joined[5]), hn::Or(joined[6], joined[7]));
    return hn::Or(reached, hn::Or(along_01, along_23));
  }
  /// The corners that are connected with no other.
  HWY_INLINE Sides isolated() const {
    const SideTag d;
    auto beside = hn::Or(hn::Or(ends_along<0>(corners), ends_along<1>(corners)),
                         hn::Or(ends_along<2>(corners), ends_along<3>(corners)));
    beside = hn::Or(beside, hn::Or(opposite<0>(corners), hn::Or(opposite<1>(corners), opposite<2>(corners))));
    beside = hn::Or(beside, hn::Or(opposite<3>(corners), hn::Or(opposite<4>(corners), opposite<5>(corners))));
    for (const auto& cube : cubes) {
      const auto has_several = hn::Ne(hn::And(cube, hn::Sub(cube, bits_in_all(1))), hn::Zero(d));
      beside = hn::Or(beside, hn::IfThenElseZero(has_several, cube));
    }
    return hn::AndNot(beside, corners);
  }
};

void connected_sides(BoundarySides& sides) {
  const SideTag d;
  const std::size_t lanes = hn::Lanes(d);
  const std::size_t end = (sides.count + lanes - 1) / lanes * lanes;
  for (auto* entries : {&sides.corners, &sides.squares, &sides.more_squares, &sides.cubes})
    std::fill(entries->begin() + sides.count, entries->begin() + end, std::uint16_t{0});
  for (std::size_t i = 0; i < end; i += lanes) {
    const Connections connections(sides, i);
    const auto isolated = connections.isolated();
    const auto lowest = hn::And(connections.corners, hn::Sub(hn::Zero(d), connections.corners));
    const auto apart = hn::IfThenElse(hn::Eq(isolated, connections.corners), hn::AndNot(lowest, isolated), isolated);
    // from the lowest of the others
    const auto others = hn::AndNot(apart, connections.corners);
    auto reached = hn::And(others, hn::Sub(hn::Zero(d), others));
    auto is_final = hn::Eq(reached, others);
    while (!hn::AllTrue(d, is_final)) {
      const auto before = reached;
      reached = connections.grown(reached);
      is_final = hn::Or(hn::Eq(reached, before), hn::Eq(reached, others));
    }
    const auto scattered = bits_in_all(BoundarySides::kScattered);
    hn::Store(hn::IfThenElse(hn::Eq(reached, others), apart, scattered), d, sides.apart.data() + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(connected_sides);

void find_connected(BoundarySides& sides) noexcept { HWY_DYNAMIC_DISPATCH(connected_sides)(sides); }

}  // namespace tegl::detail

#endif  // HWY_ONCE
