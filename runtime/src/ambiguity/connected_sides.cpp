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

  /// Adds the corners at the other ends of edges along an axis.
  template <int Axis>
  HWY_INLINE Sides along(Sides reached) const {
    constexpr int kStep = 1 << Axis;
    const auto lower = bits_in_all(lower_ends(Axis));
    const auto up = hn::ShiftLeft<kStep>(hn::And(reached, lower));
    const auto down = hn::And(hn::ShiftRight<kStep>(reached), lower);
    return hn::And(hn::Or(reached, hn::Or(up, down)), corners);
  }
  /// Adds the opposite corners of squares that connect.
  template <unsigned Pair>
  HWY_INLINE Sides across(Sides reached) const {
    constexpr unsigned kAxes = kTesseractSquares[4 * Pair].axes;
    constexpr int kFirst = static_cast<int>(kAxes & (0u - kAxes)), kSecond = static_cast<int>(kAxes) - kFirst;
    const auto base = bases[Pair], beside = hn::ShiftLeft<kFirst>(base);
    const auto up = hn::Or(hn::ShiftLeft<kFirst + kSecond>(hn::And(reached, base)),
                           hn::ShiftLeft<kSecond - kFirst>(hn::And(reached, beside)));
    const auto down = hn::Or(hn::And(hn::ShiftRight<kFirst + kSecond>(reached), base),
                             hn::And(hn::ShiftRight<kSecond - kFirst>(reached), beside));
    return hn::And(hn::Or(reached, hn::Or(up, down)), corners);
  }
  HWY_INLINE Sides grown(Sides reached) const {
    const SideTag d;
    reached = along<3>(along<2>(along<1>(along<0>(reached))));
    reached = across<2>(across<1>(across<0>(reached)));
    reached = across<5>(across<4>(across<3>(reached)));
    for (const auto& cube : cubes) {
      const auto meets = hn::Ne(hn::And(reached, cube), hn::Zero(d));
      reached = hn::Or(reached, hn::IfThenElseZero(meets, cube));
    }
    return reached;
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
    // from the lowest corner
    auto reached = hn::And(connections.corners, hn::Sub(hn::Zero(d), connections.corners));
    auto is_final = hn::Eq(reached, connections.corners);
    while (!hn::AllTrue(d, is_final)) {
      const auto before = reached;
      reached = connections.grown(reached);
      is_final = hn::Or(hn::Eq(reached, before), hn::Eq(reached, connections.corners));
    }
    const auto connected = hn::Eq(reached, connections.corners);
    hn::Store(hn::IfThenElseZero(connected, hn::Set(d, std::uint16_t{1})), d, sides.connected.data() + i);
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
