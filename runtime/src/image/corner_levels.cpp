// SPDX-License-Identifier: BSD-3-Clause
//
// Roots of the multilinear interpolant on the rays to a tile's corners (see corner_levels.hpp). Highway's
// foreach_target compiles this file once per instruction set. The operations are those of tile_heights.cpp and
// ray_level.hpp, in the same order, so that the levels are equal bit by bit.
#include "image/corner_levels.hpp"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <utility>

#include "image/ray_level.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/corner_levels.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using RayTag = hn::CappedTag<double, 8>;
using RayLanes = hn::Vec<RayTag>;
using RayMask = hn::Mask<RayTag>;

/// A polynomial of degree 4 in each lane, the constant coefficient first.
struct RayPolynomials {
  std::array<RayLanes, 5> of;

  /// On the rays to the corners from `first` on.
  HWY_INLINE RayPolynomials(const std::array<double, 16>& products, std::size_t first) {
    // By set of axes and corner: the product of u = 2 x - 1 over the axes.
    alignas(64) static constexpr auto kProducts = [] {
      std::array<std::array<double, 16>, 16> result{};
      for (unsigned set = 0; set < 16; ++set)
        for (unsigned corner = 0; corner < 16; ++corner)
          result[set][corner] = std::popcount(set & ~corner) % 2 == 0 ? 1.0 : -1.0;
      return result;
    }();
    // Unrolled, so that the coefficients stay in registers.
    [&]<std::size_t... Set>(std::index_sequence<Set...>) HWY_ATTR {
      const RayTag d;
      RayLanes sums[5] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
      ((sums[std::popcount(Set)] = hn::Add(
            sums[std::popcount(Set)], hn::Mul(hn::Set(d, products[Set]), hn::LoadU(d, kProducts[Set].data() + first)))),
       ...);
      std::copy(std::begin(sums), std::end(sums), of.begin());
    }
    (std::make_index_sequence<16>());
  }
  HWY_INLINE RayLanes value(RayLanes x) const {
    const auto cubic = hn::Add(of[3], hn::Mul(x, of[4]));
    const auto square = hn::Add(of[2], hn::Mul(x, cubic));
    return hn::Add(of[0], hn::Mul(x, hn::Add(of[1], hn::Mul(x, square))));
  }
  HWY_INLINE RayLanes slope(RayLanes x) const {
    const RayTag d;
    const auto times = [d](double k, RayLanes coefficient) HWY_ATTR { return hn::Mul(hn::Set(d, k), coefficient); };
    const auto linear = hn::Add(times(3.0, of[3]), hn::Mul(x, times(4.0, of[4])));
    return hn::Add(times(1.0, of[1]), hn::Mul(x, hn::Add(times(2.0, of[2]), hn::Mul(x, linear))));
  }
};

/// last_root in the lanes `wanted`.
HWY_INLINE RayLanes last_roots(const RayPolynomials& polynomials, RayMask wanted) {
  const RayTag d;
  const auto zero = hn::Zero(d);
  auto above = hn::Set(d, 1.0), at_above = polynomials.value(above);
  const auto is_high = hn::Ge(at_above, zero);
  const auto is_beyond = [&](RayLanes at) HWY_ATTR { return hn::Xor(hn::Ge(at, zero), is_high); };
  // the last fourth at whose ends the signs differ
  auto below = above, at_below = at_above, last = above, at_last = at_above;
  auto found = hn::And(is_high, hn::Not(is_high));
  for (double start = 0.75; start >= 0.0; start -= 0.25) {
    const auto x = hn::Set(d, start), at = polynomials.value(x);
    const auto here = hn::AndNot(found, is_beyond(at));
    below = hn::IfThenElse(here, x, below), at_below = hn::IfThenElse(here, at, at_below);
    above = hn::IfThenElse(here, last, above), at_above = hn::IfThenElse(here, at_last, at_above);
    found = hn::Or(found, here);
    last = x, at_last = at;
  }
  // Newton's method in the lanes that have not ended
  auto x = hn::Add(below, hn::Mul(hn::Sub(above, below), hn::Div(at_below, hn::Sub(at_below, at_above))));
  auto active = hn::And(found, wanted);
  for (int step = 0; step < 8 && !hn::AllFalse(d, active); ++step) {
    const auto at = polynomials.value(x);
    const auto beyond = is_beyond(at);
    above = hn::IfThenElse(beyond, above, x);
    below = hn::IfThenElse(beyond, x, below);
    auto next = hn::Sub(x, hn::Div(at, polynomials.slope(x)));
    const auto is_between = hn::And(hn::Ge(next, below), hn::Le(next, above));
    next = hn::IfThenElse(is_between, next, hn::Mul(hn::Set(d, 0.5), hn::Add(below, above)));
    const auto moved = hn::Abs(hn::Sub(next, x));
    x = hn::IfThenElse(active, next, x);
    active = hn::AndNot(hn::Lt(moved, hn::Set(d, kEnoughOfRay<5>)), active);
  }
  return hn::IfThenElse(found, x, hn::Set(d, -1.0));
}

void levels_of_corners(const std::array<double, 16>& products, double epsilon, std::uint32_t corners,
                       std::array<double, 16>& out) {
  const RayTag d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const double least_level = std::max(kLeastRayLevel, epsilon);
  const auto one = hn::Set(d, 1.0), zero = hn::Zero(d), step = hn::Set(d, kRayLevelStep);
  const auto least = hn::Set(d, least_level), most = hn::Set(d, 1.0 - least_level);
  for (std::size_t first = 0; first < 16; first += kLanes) {
    const std::uint8_t bits[8] = {static_cast<std::uint8_t>(corners >> first & ((1u << kLanes) - 1))};
    if (bits[0] == 0) continue;
    const RayPolynomials polynomials(products, first);
    auto level = last_roots(polynomials, hn::LoadMaskBits(d, bits));
    const auto is_nearer = hn::Lt(hn::Abs(polynomials.value(one)), hn::Abs(polynomials.of[0]));
    level = hn::IfThenElse(hn::Lt(level, zero), hn::IfThenElseZero(is_nearer, one), level);
    // level_inside
    level = hn::IfThenElse(hn::Lt(level, least), least, hn::IfThenElse(hn::Lt(most, level), most, level));
    hn::StoreU(hn::Sub(hn::Add(level, step), step), d, out.data() + first);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(levels_of_corners);

void corner_levels(const std::array<double, 16>& products, double epsilon, std::uint32_t corners,
                   std::array<double, 16>& out) noexcept {
  if (is_finite_enough(products[0]))
    HWY_DYNAMIC_DISPATCH(levels_of_corners)(products, epsilon, corners, out);
  else
    out.fill(0.5);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
