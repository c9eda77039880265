// SPDX-License-Identifier: BSD-3-Clause
//
// Highway's foreach_target compiles this file once per instruction set. Multiplications and additions are not fused,
// and comparisons select as std::clamp does, so that all instruction sets give identical bytes.
#include "lattice/lattice_points.hpp"

#include <algorithm>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lattice/lattice_points.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<double, LatticePoints<3, double>::kMargin>;
using Numbers = hn::Vec<Lanes>;

/// As point_on_edge has it.
HWY_INLINE Numbers between(Lanes d, Numbers from, Numbers to, Numbers alpha) {
  const auto point = hn::Add(from, hn::Mul(alpha, hn::Sub(to, from)));
  const auto low = hn::Min(from, to), high = hn::Max(from, to);
  const auto clamped = hn::IfThenElse(hn::Lt(point, low), low, hn::IfThenElse(hn::Lt(high, point), high, point));
  return hn::IfThenElse(hn::Ge(alpha, hn::Set(d, 1.0)), to, clamped);
}

/// Places in the world of the samples `at` + places.ahead.
template <int N, class Real>
HWY_INLINE void find_places(Lanes d, const LatticePoints<N, Real>& edges, const PlacesInRow<N>& places,
                            const std::uint32_t* at, std::array<Numbers, N>& x) {
  if (edges.along == nullptr) {
    const hn::Rebind<std::int32_t, Lanes> integers;
    const auto index = hn::PromoteTo(d, hn::LoadU(integers, reinterpret_cast<const std::int32_t*>(at)));
    const auto moved = hn::Add(index, hn::Set(d, static_cast<double>(places.ahead)));
    x[0] = hn::Add(hn::Set(d, edges.origin), hn::Mul(moved, hn::Set(d, edges.step)));
  } else {
    alignas(64) std::array<double, hn::MaxLanes(Lanes())> coordinates;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      coordinates[i] = edges.along[static_cast<std::ptrdiff_t>(at[i]) + places.ahead];
    x[0] = hn::Load(d, coordinates.data());
  }
  x[0] = hn::Add(x[0], hn::Set(d, places.shift));
  for (int a = 1; a < N; ++a) x[a] = hn::Set(d, places.others[a]);
  if (edges.mapped == nullptr) return;
  const std::array<Numbers, N> on_grid = x;
  for (int row = 0; row < N; ++row) {
    x[row] = hn::Set(d, edges.mapped->offset[row]);
    for (int a = 0; a < N; ++a) x[row] = hn::Add(x[row], hn::Mul(hn::Set(d, edges.mapped->linear[row][a]), on_grid[a]));
  }
}

template <class Real>
HWY_INLINE auto narrowed(Numbers value) {
  if constexpr (std::is_same_v<Real, double>)
    return value;
  else
    return hn::DemoteTo(hn::Rebind<Real, Lanes>(), value);
}

template <int N, class Real>
HWY_INLINE void points(const LatticePoints<N, Real>& edges) {
  const Lanes d;
  const hn::Rebind<Real, Lanes> of_points;
  constexpr std::size_t kLanes = hn::MaxLanes(Lanes());
  for (std::size_t i = 0; i < edges.count; i += kLanes) {
    std::array<Numbers, N> from, to;
    find_places<N>(d, edges, edges.from, edges.at + i, from);
    find_places<N>(d, edges, edges.to, edges.at + i, to);
    const auto alpha = hn::LoadU(d, edges.alphas + i);
    std::array<hn::Vec<decltype(of_points)>, N> x;
    for (int a = 0; a < N; ++a) x[a] = narrowed<Real>(between(d, from[a], to[a], alpha));
    const auto store = [&](Real* out) HWY_ATTR {
      if constexpr (N == 2)
        hn::StoreInterleaved2(x[0], x[1], of_points, out);
      else if constexpr (N == 3)
        hn::StoreInterleaved3(x[0], x[1], x[2], of_points, out);
      else
        hn::StoreInterleaved4(x[0], x[1], x[2], x[3], of_points, out);
    };
    auto* const out = edges.out + i;
    if (edges.end - out >= static_cast<std::ptrdiff_t>(kLanes)) {
      store(out->data());
      continue;
    }
    std::array<std::array<Real, N>, kLanes> last;
    store(last[0].data());
    std::copy_n(last.begin(), std::min(edges.count - i, kLanes), out);
  }
}

// Highway's dispatch tables cannot hold templates.
void points2f(const LatticePoints<2, float>& edges) { points(edges); }
void points3f(const LatticePoints<3, float>& edges) { points(edges); }
void points4f(const LatticePoints<4, float>& edges) { points(edges); }
void points2d(const LatticePoints<2, double>& edges) { points(edges); }
void points3d(const LatticePoints<3, double>& edges) { points(edges); }
void points4d(const LatticePoints<4, double>& edges) { points(edges); }

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

#define TEGL_DISPATCH(N, Real, name)                                         \
  HWY_EXPORT(name);                                                          \
  template <>                                                                \
  void write_points<N, Real>(const LatticePoints<N, Real>& edges) noexcept { \
    HWY_DYNAMIC_DISPATCH(name)(edges);                                       \
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
