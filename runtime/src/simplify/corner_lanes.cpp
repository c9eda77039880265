// SPDX-License-Identifier: BSD-3-Clause
//
// Bounds by the corners of tetrahedra in 4-space. Highway's foreach_target compiles this file once per instruction set.
// Multiplications and additions are not fused, and come in the order of the functions for one corner, so that all
// instruction sets give identical bytes. Coordinates are finite: comparisons of lanes take no account of NaN.
#include "simplify/corner_lanes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
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

/// The squares of the lengths of the edges from each corner, to the corners in the order 1 0 3 2, 2 3 0 1 and 3 2 1 0.
struct Edges {
  V beside, across, around;
};
HWY_INLINE Edges squares_of_edges(D d, const CornerLanes<N>& corners) {
  Edges edges{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (int a = 0; a < N; ++a) {
    const V x = hn::Load(d, corners.axes[a].data());
    const V way_beside = hn::Sub(x, hn::Shuffle01(x)), way_across = hn::Sub(x, hn::SwapAdjacentBlocks(x)),
            way_around = hn::Sub(x, hn::Reverse(d, x));
    edges.beside = hn::Add(edges.beside, hn::Mul(way_beside, way_beside));
    edges.across = hn::Add(edges.across, hn::Mul(way_across, way_across));
    edges.around = hn::Add(edges.around, hn::Mul(way_around, way_around));
  }
  return edges;
}
HWY_INLINE V largest_of(D d, const Edges& edges) {
  return hn::MaxOfLanes(d, hn::Max(hn::Max(edges.beside, edges.across), edges.around));
}

double square_of_edge(const CornerLanes<N>& corners) {
  const D d;
  return hn::GetLane(largest_of(d, squares_of_edges(d, corners)));
}

/// Sets `edge` without the squares, which it returns.
HWY_INLINE V longest_edge(D d, const CornerLanes<N>& corners, LongestEdge<N>& edge) {
  const auto [beside, across, around] = squares_of_edges(d, corners);
  const V most = largest_of(d, {beside, across, around});
  // the first longest one of the edges 1 0, 2 0, 2 1, 3 0, 3 1, 3 2
  const unsigned in_beside = equal_lanes(d, beside, most), in_across = equal_lanes(d, across, most),
                 in_around = equal_lanes(d, around, most);
  const unsigned longest = (in_beside & 1u) | (in_across & 1u) << 1 | (in_around & 2u) << 1 | (in_around & 1u) << 3 |
                           (in_across & 2u) << 3 | (in_beside & 4u) << 3;
  constexpr std::array<std::uint8_t, 6> kFirst = {0, 0, 1, 0, 1, 2}, kSecond = {1, 2, 2, 3, 3, 3};
  const int number = std::countr_zero(longest | 1u << 5);
  edge.first = kFirst[number];
  edge.second = kSecond[number];
  edge.square = hn::GetLane(most);
  for (int a = 0; a < N; ++a) {
    const double from = corners.axes[a][edge.first];
    edge.middle[a] = from + 0.5 * (corners.axes[a][edge.second] - from);
  }
  return square_apart(d, corners, edge.middle);
}

/// As bound_by_common_point.
HWY_INLINE double common_point(D d, const CornerLanes<N>& corners, const std::array<double, N>& distances,
                               const LongestEdge<N>& edge, double limit) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double length = std::sqrt(edge.square);
  const double first = distances[edge.first], second = distances[edge.second];
  if (!(length + first + second <= 2.0 * limit)) return kNone;
  const double share = length > 0.0 ? std::clamp(0.5 + 0.5 * (second - first) / length, 0.0, 1.0) : 0.5;
  PointN<N> q = between(corners[edge.first], corners[edge.second], share);
  const V of_corners = hn::LoadU(d, distances.data());
  for (int step = 0;; ++step) {
    const V ways = hn::Sqrt(square_apart(d, corners, q)), sums = hn::Add(ways, of_corners);
    const V most = hn::MaxOfLanes(d, sums);
    const double bound = hn::GetLane(most);
    if (bound <= limit) return bound;
    if (step == kMostStepsToCommonPoint) return kNone;
    const int farthest = std::countr_zero(equal_lanes(d, sums, most) | 1u << (N - 1));
    alignas(32) double way[N];
    hn::Store(ways, d, way);
    const double stride = kStrideToCommonPoint * (bound - limit);
    if (!(stride < way[farthest])) return kNone;
    q = between(q, corners[farthest], stride / way[farthest]);
  }
}

void balls(const CornerLanes<N>& corners, const std::array<double, N>& distances, double limit,
           CornerBalls<N>& result) {
  const D d;
  const V squares = longest_edge(d, corners, result.edge);
  hn::StoreU(squares, d, result.edge.squares.data());
  const V least = hn::MinOfLanes(d, squares);
  result.nearest = std::countr_zero(equal_lanes(d, squares, least) | 1u << (N - 1));
  result.square_of_middle = hn::GetLane(hn::MaxOfLanes(d, squares));
  const double square = std::min(result.square_of_middle, result.edge.square * (N - 1) / (2 * N));
  const double farthest = hn::GetLane(hn::MaxOfLanes(d, hn::LoadU(d, distances.data()))), room = limit - farthest;
  result.bound = room >= 0.0 && square <= room * room ? std::min(limit, farthest + std::sqrt(square))
                                                      : common_point(d, corners, distances, result.edge, limit);
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

double square_of_edge(const CornerLanes<N>& corners) { return longest_edge_by_corners(corners).square; }
void balls(const CornerLanes<N>& corners, const std::array<double, N>& distances, double limit,
           CornerBalls<N>& result) {
  result = balls_by_corners<N>(corners, distances, limit);
}
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

HWY_EXPORT(square_of_edge);
HWY_EXPORT(balls);
HWY_EXPORT(distances);

template <>
double square_of_longest_edge<4>(const CornerLanes<4>& corners) {
  return HWY_DYNAMIC_DISPATCH(square_of_edge)(corners);
}
template <>
CornerBalls<4> balls_around<4>(const CornerLanes<4>& corners, const std::array<double, 4>& distances, double limit) {
  CornerBalls<4> result;
  HWY_DYNAMIC_DISPATCH(balls)(corners, distances, limit, result);
  return result;
}
bool distances_by_gradients(std::span<const float, 16> row, const CornersN<4>& simplex, const PointN<4>& origin,
                            const CornerLanes<4>& corners, std::array<double, 4>& distances_of_corners) {
  return HWY_DYNAMIC_DISPATCH(distances)(row, simplex, origin, corners, distances_of_corners);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
