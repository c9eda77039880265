// SPDX-License-Identifier: BSD-3-Clause
//
// Bounds by the corners of tetrahedra in 4-space. Highway's foreach_target compiles this file once per instruction set.
// Multiplications and additions are not fused, and come in the order of the functions for one corner, so that all
// instruction sets give identical bytes. Coordinates are finite: comparisons of lanes take no account of NaN.
#include "simplify/corner_lanes.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simplify/corner_lanes.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr int N = 4;

#if HWY_MAX_BYTES >= 32

using D = hn::FixedTag<double, N>;
using V = hn::Vec<D>;

/// Bit k: whether a is b in lane k.
HWY_INLINE unsigned equal_lanes(D d, V a, V b) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, hn::Eq(a, b), bits);
  return bits[0];
}

HWY_INLINE V square_apart(D d, const CornerLanes<N>& corners, const PointN<N>& centre) {
  V sum = hn::Zero(d);
  for (int a = 0; a < N; ++a) {
    const V way = hn::Sub(hn::Load(d, corners.axes[a].data()), hn::Set(d, centre[a]));
    sum = hn::Add(sum, hn::Mul(way, way));
  }
  return sum;
}

LongestEdge<N> longest_edge(const CornerLanes<N>& corners) {
  const D d;
  // corners 0 to 3 without 1 0 3 2, 2 3 0 1 and 3 2 1 0
  V beside = hn::Zero(d), across = beside, around = beside;
  for (int a = 0; a < N; ++a) {
    const V x = hn::Load(d, corners.axes[a].data());
    const V way_beside = hn::Sub(x, hn::Shuffle01(x)), way_across = hn::Sub(x, hn::SwapAdjacentBlocks(x)),
            way_around = hn::Sub(x, hn::Reverse(d, x));
    beside = hn::Add(beside, hn::Mul(way_beside, way_beside));
    across = hn::Add(across, hn::Mul(way_across, way_across));
    around = hn::Add(around, hn::Mul(way_around, way_around));
  }
  const V most = hn::MaxOfLanes(d, hn::Max(hn::Max(beside, across), around));
  // the first longest one of the edges 1 0, 2 0, 2 1, 3 0, 3 1, 3 2
  const unsigned in_beside = equal_lanes(d, beside, most), in_across = equal_lanes(d, across, most),
                 in_around = equal_lanes(d, around, most);
  const unsigned longest = (in_beside & 1u) | (in_across & 1u) << 1 | (in_around & 2u) << 1 | (in_around & 1u) << 3 |
                           (in_across & 2u) << 3 | (in_beside & 4u) << 3;
  constexpr std::array<std::uint8_t, 6> kFirst = {0, 0, 1, 0, 1, 2}, kSecond = {1, 2, 2, 3, 3, 3};
  const int number = std::countr_zero(longest | 1u << 5);
  LongestEdge<N> edge;
  edge.first = kFirst[number];
  edge.second = kSecond[number];
  edge.square = hn::GetLane(most);
  for (int a = 0; a < N; ++a) {
    const double from = corners.axes[a][edge.first];
    edge.middle[a] = from + 0.5 * (corners.axes[a][edge.second] - from);
  }
  hn::StoreU(square_apart(d, corners, edge.middle), d, edge.squares.data());
  return edge;
}

bool distances(std::span<const float, 16> row, const CornersN<N>& simplex, const PointN<N>& origin,
               const CornerLanes<N>& corners, std::array<double, N>& result) {
  const D d;
  const hn::FixedTag<float, N> in_single;
  using Single = hn::Vec<decltype(in_single)>;
  // barycentric coordinates
  Single weights[N] = {hn::Set(in_single, 1.0f), hn::Zero(in_single), hn::Zero(in_single), hn::Zero(in_single)};
  V rest[N];
  for (int a = 0; a < N; ++a) {
    const V x = hn::Load(d, corners.axes[a].data());
    rest[a] = hn::Sub(x, hn::Set(d, simplex[0][a]));
    const Single local = hn::DemoteTo(in_single, hn::Sub(x, hn::Set(d, origin[a])));
    const Single way = hn::Sub(local, hn::Set(in_single, row[12 + a]));
    for (int i = 1; i < N; ++i) weights[i] = hn::Add(weights[i], hn::Mul(way, hn::Set(in_single, row[3 * a + i - 1])));
  }
  for (int i = 1; i < N; ++i) weights[0] = hn::Sub(weights[0], weights[i]);
  const Single largest = hn::Set(in_single, 1e30f);
  auto is_usual = hn::Le(hn::Abs(weights[0]), largest);
  for (int i = 1; i < N; ++i) is_usual = hn::And(is_usual, hn::Le(hn::Abs(weights[i]), largest));
  if (!hn::AllTrue(in_single, is_usual)) return false;
  // the positive ones, with the sum 1
  V positive = hn::Zero(d), shares[N];
  for (int i = 0; i < N; ++i) {
    shares[i] = hn::PromoteTo(d, hn::Max(hn::Zero(in_single), weights[i]));
    positive = hn::Add(positive, shares[i]);
  }
  const V factor = hn::Div(hn::Set(d, 1.0), positive);
  for (int i = 1; i < N; ++i) {
    const V share = hn::Mul(factor, shares[i]);
    for (int a = 0; a < N; ++a) rest[a] = hn::Sub(rest[a], hn::Mul(share, hn::Set(d, simplex[i][a] - simplex[0][a])));
  }
  V square = hn::Zero(d);
  for (int a = 0; a < N; ++a) square = hn::Add(square, hn::Mul(rest[a], rest[a]));
  hn::StoreU(hn::Sqrt(square), d, result.data());
  return true;
}

#else

LongestEdge<N> longest_edge(const CornerLanes<N>& corners) { return longest_edge_by_corners(corners); }
bool distances(std::span<const float, 16>, const CornersN<N>&, const PointN<N>&, const CornerLanes<N>&,
               std::array<double, N>&) {
  return false;
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(longest_edge);
HWY_EXPORT(distances);

template <>
LongestEdge<4> longest_edge_of(const CornerLanes<4>& corners) {
  return HWY_DYNAMIC_DISPATCH(longest_edge)(corners);
}
bool distances_by_gradients(std::span<const float, 16> row, const CornersN<4>& simplex, const PointN<4>& origin,
                            const CornerLanes<4>& corners, std::array<double, 4>& distances_of_corners) {
  return HWY_DYNAMIC_DISPATCH(distances)(row, simplex, origin, corners, distances_of_corners);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
