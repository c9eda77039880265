// SPDX-License-Identifier: BSD-3-Clause
//
// Vertices on critical edges (see extract_points.hpp). Highway's foreach_target compiles this file once per instruction
// set. Multiplications and additions are not fused, and comparisons select as std::clamp does, so that all instruction
// sets give identical bytes.
#include "kernel/extract_points.hpp"

#include <bit>
#include <cmath>
#include <type_traits>

#include "base/request_memory.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernel/extract_points.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"
#include "image/vectors.hpp"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using AllLanes = hn::ScalableTag<double>;
using OneLane = hn::CappedTag<double, 1>;

/// Writes four positions at a time, even if fewer bits are left in a word: the number of bits is hard to predict, and a
/// mispredicted branch costs more than the superfluous stores.
std::size_t bits_to_list(const Word* bits, std::size_t words, std::uint32_t* at) {
  const std::uint32_t* const first = at;
  for (std::size_t w = 0; w < words; ++w) {
    Word rest = bits[w];
    if (rest == 0) continue;
    const auto base = static_cast<std::uint32_t>(w * kWordBits);
    const int count = std::popcount(rest);
    for (int done = 0; done < count; done += 4)
      for (int i = 0; i < 4; ++i, rest &= rest - 1)
        at[done + i] = base + static_cast<std::uint32_t>(std::countr_zero(rest));
    at += count;
  }
  return static_cast<std::size_t>(at - first);
}

template <class D, class V>
HWY_INLINE V clamped(D, V value, V low, V high) {
  return hn::IfThenElse(hn::Lt(value, low), low, hn::IfThenElse(hn::Lt(high, value), high, value));
}

/// Same arithmetic as Placement::between.
template <class D, class V>
HWY_INLINE V between(D d, V a, V b, V x) {
  const auto point = hn::Add(a, hn::Mul(x, hn::Sub(b, a)));
  return hn::IfThenElse(hn::Ge(x, hn::Set(d, 1.0)), b, clamped(d, point, hn::Min(a, b), hn::Max(a, b)));
}

template <class Real, class D>
HWY_INLINE auto to_real(D /*d*/, hn::Vec<D> value) {
  if constexpr (std::is_same_v<Real, double>)
    return value;
  else
    return hn::DemoteTo(hn::Rebind<float, D>(), value);
}

/// Coordinates along the row of samples `at` + `ahead`.
template <class D, int N, class Real>
HWY_INLINE hn::Vec<D> along_row(D d, const EdgePoints<N, Real>& edges, const std::uint32_t* at, unsigned ahead) {
  if (edges.along == nullptr) {
    const hn::Rebind<std::int32_t, D> integers;
    const auto index = hn::PromoteTo(d, hn::LoadU(integers, reinterpret_cast<const std::int32_t*>(at)));
    const auto moved = ahead == 0 ? index : hn::Add(index, hn::Set(d, 1.0));
    return hn::Add(hn::Set(d, edges.origin), hn::Mul(moved, hn::Set(d, edges.step)));
  }
  constexpr std::size_t kLanes = hn::MaxLanes(D());
  alignas(64) double coordinates[kLanes];
  for (std::size_t i = 0; i < kLanes; ++i) coordinates[i] = edges.along[at[i] + ahead];
  return hn::Load(d, coordinates);
}

/// Writes as many vertices as D has lanes, starting at edge `i`. The edges are along `Axis`, which is a constant so
/// that coordinates stay in registers.
template <int Axis, bool kInOneRow, class D, int N, class Real>
HWY_INLINE void write_some(D d, const EdgePoints<N, Real>& edges, std::size_t i) {
  const hn::Rebind<Real, D> real;
  // axis coordinates
  const std::uint32_t* const at = edges.at + i;
  std::array<hn::Vec<D>, N> point;
  point[0] = along_row(d, edges, at, 0);
  const auto by_edge = [&](const double* of) HWY_ATTR { return kInOneRow ? hn::Set(d, *of) : hn::LoadU(d, of + i); };
  for (int a = 1; a + 1 < N; ++a) point[a] = by_edge(edges.start[a]);
  point[N - 1] = hn::Set(d, edges.layer);
  const auto end = Axis == 0       ? along_row(d, edges, at, 1)
                   : Axis == N - 1 ? hn::Set(d, edges.next_layer)
                                   : by_edge(edges.end);
  point[Axis] = between(d, point[Axis], end, hn::LoadU(d, edges.alphas + i));
  // world coordinates
  std::array<hn::Vec<decltype(real)>, N> vertex;
  for (int a = 0; a < N; ++a) {
    if (edges.linear == nullptr) {
      vertex[a] = to_real<Real>(d, point[a]);
      continue;
    }
    auto sum = hn::Zero(d);
    for (int b = 0; b < N; ++b) sum = hn::Add(sum, hn::Mul(hn::Set(d, edges.linear[a * N + b]), point[b]));
    vertex[a] = to_real<Real>(d, hn::Add(sum, hn::Set(d, edges.offset[a])));
  }
  if (!std::isnan(edges.inside[0]))
    vertex[N - 1] = clamped(real, vertex[N - 1], hn::Set(real, edges.inside[0]), hn::Set(real, edges.inside[1]));
  if constexpr (kInOneRow && N == 3) request_ahead(edges.out + i, hn::MaxLanes(d) * sizeof(edges.out[0]));
  store_points(real, vertex, edges.out[i].data());
}

template <int Axis, bool kInOneRow, int N, class Real>
HWY_INLINE void points_along(const EdgePoints<N, Real>& all) {
  constexpr std::size_t kLanes = hn::MaxLanes(AllLanes());
  // Of a row, which has many edges, local, because stores of vectors may change any memory.
  const std::conditional_t<kInOneRow, EdgePoints<N, Real>, const EdgePoints<N, Real>&> edges = all;
  std::size_t i = 0;
  for (; i + kLanes <= edges.count; i += kLanes) write_some<Axis, kInOneRow>(AllLanes(), edges, i);
  if (i == edges.count) return;
  if (edges.count >= kLanes)  // some twice
    return write_some<Axis, kInOneRow>(AllLanes(), edges, edges.count - kLanes);
  for (; i < edges.count; ++i) write_some<Axis, kInOneRow>(OneLane(), edges, i);
}

template <bool kInOneRow, int N, class Real>
HWY_INLINE void points(const EdgePoints<N, Real>& edges) {
  if (edges.axis == 0) return points_along<0, kInOneRow>(edges);
  if (edges.axis == 1) return points_along<1, kInOneRow>(edges);
  if constexpr (N > 2)
    if (edges.axis == 2) return points_along<2, kInOneRow>(edges);
  if constexpr (N > 3)
    if (edges.axis == 3) return points_along<3, kInOneRow>(edges);
}
template <int N, class Real>
HWY_INLINE void points(const EdgePoints<N, Real>& edges) {
  return edges.in_one_row ? points<true>(edges) : points<false>(edges);
}

// Highway's dispatch tables cannot hold templates.
void points2f(const EdgePoints<2, float>& edges) { points(edges); }
void points3f(const EdgePoints<3, float>& edges) { points(edges); }
void points4f(const EdgePoints<4, float>& edges) { points(edges); }
void points2d(const EdgePoints<2, double>& edges) { points(edges); }
void points3d(const EdgePoints<3, double>& edges) { points(edges); }
void points4d(const EdgePoints<4, double>& edges) { points(edges); }

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(bits_to_list);
std::size_t list_bits(const Word* bits, std::size_t words, std::uint32_t* at) noexcept {
  return HWY_DYNAMIC_DISPATCH(bits_to_list)(bits, words, at);
}

#define TEGL_DISPATCH(N, Real, name)                                      \
  HWY_EXPORT(name);                                                       \
  template <>                                                             \
  void write_points<N, Real>(const EdgePoints<N, Real>& edges) noexcept { \
    HWY_DYNAMIC_DISPATCH(name)(edges);                                    \
  }
TEGL_DISPATCH(2, float, points2f)
TEGL_DISPATCH(3, float, points3f)
TEGL_DISPATCH(4, float, points4f)
TEGL_DISPATCH(2, double, points2d)
TEGL_DISPATCH(3, double, points3d)
TEGL_DISPATCH(4, double, points4d)
#undef TEGL_DISPATCH

}  // namespace tegl::detail

#endif  // HWY_ONCE
