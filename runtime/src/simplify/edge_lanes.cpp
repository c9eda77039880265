// SPDX-License-Identifier: BSD-3-Clause
//
// Normals, shapes and targets of contractions. Highway's foreach_target compiles this file once per instruction set.
// Multiplications and additions are not fused, and come in the order of simplex_shapes.hpp and quadric.hpp, so that all
// instruction sets give identical bytes.
#include "simplify/edge_lanes.hpp"

#include <array>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "simplify/edge_lanes.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kEdgeLanes>;
using V = hn::Vec<D>;

/// The values at several addresses, transposed: result[i][k] = from[k][i].
template <std::size_t Count>
HWY_INLINE void transpose(const std::array<const double*, kEdgeLanes>& from, std::array<EdgeLanes, Count>& result) {
#if HWY_MAX_BYTES >= 32
  // blocks of 4 x 4
  constexpr std::size_t kInBlocks = Count / 4 * 4;
  const hn::FixedTag<double, 4> four;
  for (std::size_t i = 0; i < kInBlocks; i += 4)
    for (std::size_t k = 0; k < kEdgeLanes; k += 4) {
      const auto a = hn::LoadU(four, from[k] + i), b = hn::LoadU(four, from[k + 1] + i),
                 c = hn::LoadU(four, from[k + 2] + i), d = hn::LoadU(four, from[k + 3] + i);
      const auto even_ab = hn::InterleaveLower(four, a, b), odd_ab = hn::InterleaveUpper(four, a, b),
                 even_cd = hn::InterleaveLower(four, c, d), odd_cd = hn::InterleaveUpper(four, c, d);
      hn::StoreU(hn::ConcatLowerLower(four, even_cd, even_ab), four, &result[i][k]);
      hn::StoreU(hn::ConcatLowerLower(four, odd_cd, odd_ab), four, &result[i + 1][k]);
      hn::StoreU(hn::ConcatUpperUpper(four, even_cd, even_ab), four, &result[i + 2][k]);
      hn::StoreU(hn::ConcatUpperUpper(four, odd_cd, odd_ab), four, &result[i + 3][k]);
    }
#else
  constexpr std::size_t kInBlocks = 0;
#endif
  for (std::size_t i = kInBlocks; i < Count; ++i)
    for (std::size_t k = 0; k < kEdgeLanes; ++k) result[i][k] = from[k][i];
}

template <int N>
struct PointV {
  V x[N];
};

template <int N>
HWY_INLINE PointV<N> minus(const PointV<N>& a, const PointV<N>& b) {
  PointV<N> result;
  for (int i = 0; i < N; ++i) result.x[i] = hn::Sub(a.x[i], b.x[i]);
  return result;
}

template <int N>
HWY_INLINE V dot(const PointV<N>& a, const PointV<N>& b) {
  V sum = hn::Mul(a.x[0], b.x[0]);
  for (int i = 1; i < N; ++i) sum = hn::Add(sum, hn::Mul(a.x[i], b.x[i]));
  return sum;
}

/// p a - q b
HWY_INLINE V minor(V p, V a, V q, V b) { return hn::Sub(hn::Mul(p, a), hn::Mul(q, b)); }

template <int N>
HWY_INLINE PointV<N> normal_of(const PointV<N> (&corners)[N]) {
  PointV<N> e[N];
  for (int i = 1; i < N; ++i) e[i] = minus(corners[i], corners[0]);
  if constexpr (N == 2) {
    return {{e[1].x[1], hn::Neg(e[1].x[0])}};
  } else if constexpr (N == 3) {
    const V *a = e[1].x, *b = e[2].x;
    return {{minor(a[1], b[2], a[2], b[1]), minor(a[2], b[0], a[0], b[2]), minor(a[0], b[1], a[1], b[0])}};
  } else {
    static_assert(N == 4);
    const V *f = e[1].x, *g = e[2].x, *h = e[3].x;
    const V xy = minor(g[0], h[1], g[1], h[0]), xz = minor(g[0], h[2], g[2], h[0]), xt = minor(g[0], h[3], g[3], h[0]);
    const V yz = minor(g[1], h[2], g[2], h[1]), yt = minor(g[1], h[3], g[3], h[1]), zt = minor(g[2], h[3], g[3], h[2]);
    return {{hn::Add(minor(f[1], zt, f[2], yt), hn::Mul(f[3], yz)),
             hn::Neg(hn::Add(minor(f[0], zt, f[2], xt), hn::Mul(f[3], xz))),
             hn::Add(minor(f[0], yt, f[1], xt), hn::Mul(f[3], xy)),
             hn::Neg(hn::Add(minor(f[0], yz, f[1], xz), hn::Mul(f[2], xy)))}};
  }
}

template <int N>
HWY_INLINE void measure(D d, const PointV<N> (&corners)[N], std::size_t k, ShapeLanes<N>& result) {
  const PointV<N> normal = normal_of<N>(corners);
  const V length = hn::Sqrt(dot(normal, normal));
  V square = hn::Zero(d);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < i; ++j) {
      const PointV<N> edge = minus(corners[i], corners[j]);
      square = hn::Max(square, dot(edge, edge));
    }
  const V edge = hn::Sqrt(square);
  V cube = edge;
  for (int i = 2; i < N; ++i) cube = hn::Mul(cube, edge);
  for (int a = 0; a < N; ++a) hn::Store(normal.x[a], d, &result.normal[a][k]);
  hn::Store(length, d, &result.length[k]);
  hn::Store(hn::IfThenElseZero(hn::Gt(edge, hn::Zero(d)), hn::Div(length, cube)), d, &result.shape[k]);
}

template <int N>
HWY_INLINE void load_corners(D d, const SimplexLanes<N>& simplices, std::size_t k, PointV<N> (&corners)[N]) {
  for (int i = 0; i < N; ++i)
    for (int a = 0; a < N; ++a) corners[i].x[a] = hn::Load(d, &simplices.corners[i][a][k]);
}

template <int N>
HWY_INLINE void measure_all(SimplexLanes<N>& simplices) {
  const D d;
  for (int i = 0; i < N; ++i) transpose<N>(simplices.places[i], simplices.corners[i]);
  for (std::size_t k = 0; k < kEdgeLanes; k += hn::Lanes(d)) {
    PointV<N> corners[N];
    load_corners(d, simplices, k, corners);
    measure<N>(d, corners, k, simplices.before);
  }
}

template <int N>
HWY_INLINE void move_all(const SimplexLanes<N>& simplices, const PointN<N>& place, ShapeLanes<N>& after) {
  const D d;
  for (std::size_t k = 0; k < kEdgeLanes; k += hn::Lanes(d)) {
    PointV<N> corners[N];
    load_corners(d, simplices, k, corners);
    const V moving = hn::Load(d, &simplices.moving[k]);
    for (int i = 0; i < N; ++i) {
      const auto moves = hn::Eq(moving, hn::Set(d, static_cast<double>(i)));
      for (int a = 0; a < N; ++a) corners[i].x[a] = hn::IfThenElse(moves, hn::Set(d, place[a]), corners[i].x[a]);
    }
    measure<N>(d, corners, k, after);
  }
}

/// As Quadric.
template <int N>
struct QuadricV {
  V matrix[N * (N + 1) / 2];
  V vector[N];
  V constant;

  HWY_INLINE PointV<N> least_near(D d, const PointV<N>& near) const {
    V trace = matrix[0];
    for (int i = 1; i < N; ++i) trace = hn::Add(trace, matrix[i * (i + 3) / 2]);
    const V pull = hn::Mul(hn::Set(d, Quadric<N>::kPull), trace);
    V a[N * (N + 1) / 2];
    for (int k = 0; k < N * (N + 1) / 2; ++k) a[k] = matrix[k];
    PointV<N> b;
    for (int i = 0; i < N; ++i) {
      b.x[i] = hn::Add(vector[i], hn::Mul(pull, near.x[i]));
      a[i * (i + 3) / 2] = hn::Add(a[i * (i + 3) / 2], pull);
    }
    solve(d, a, b);
    const auto is_unique = hn::Gt(pull, hn::Zero(d));
    for (int i = 0; i < N; ++i) b.x[i] = hn::IfThenElse(is_unique, b.x[i], near.x[i]);
    return b;
  }

  HWY_INLINE V operator()(D d, const PointV<N>& x) const {
    V sum = constant;
    for (int i = 0, k = 0; i < N; ++i) {
      V row = hn::Mul(hn::Set(d, -2.0), vector[i]);
      for (int j = 0; j < i; ++j) row = hn::Add(row, hn::Mul(hn::Mul(hn::Set(d, 2.0), matrix[k++]), x.x[j]));
      row = hn::Add(row, hn::Mul(matrix[k++], x.x[i]));
      sum = hn::Add(sum, hn::Mul(row, x.x[i]));
    }
    return hn::Max(hn::Zero(d), sum);
  }

 private:
  /// As solve_positive.
  static HWY_INLINE void solve(D d, V* a, PointV<N>& b) {
    const auto at = [](int i, int j) { return i * (i + 1) / 2 + j; };
    V inverse[N];
    for (int j = 0; j < N; ++j) {
      inverse[j] = hn::Div(hn::Set(d, 1.0), a[at(j, j)]);
      for (int i = j + 1; i < N; ++i) {
        const V factor = hn::Mul(a[at(i, j)], inverse[j]);
        for (int k = j + 1; k <= i; ++k) a[at(i, k)] = hn::Sub(a[at(i, k)], hn::Mul(factor, a[at(k, j)]));
        b.x[i] = hn::Sub(b.x[i], hn::Mul(factor, b.x[j]));
      }
    }
    for (int j = N - 1; j >= 0; --j) {
      for (int i = j + 1; i < N; ++i) b.x[j] = hn::Sub(b.x[j], hn::Mul(a[at(i, j)], b.x[i]));
      b.x[j] = hn::Mul(b.x[j], inverse[j]);
    }
  }
};

template <int N>
HWY_INLINE void find_targets(const TargetInput<N>& input, TargetLanes<N>& edges) {
  const D d;
  const hn::Rebind<float, D> in_single;
  const auto& common = input.quadric.values();
  alignas(64) std::array<EdgeLanes, Quadric<N>::kValues> quadrics;
  alignas(64) std::array<EdgeLanes, N> places;
  transpose<Quadric<N>::kValues>(edges.quadrics, quadrics);
  transpose<N>(edges.places, places);
  for (std::size_t k = 0; k < kEdgeLanes; k += hn::Lanes(d)) {
    // the quadrics of both ends together
    constexpr int kMatrix = N * (N + 1) / 2;
    const auto value = [&](int i) { return hn::Add(hn::Set(d, common[i]), hn::Load(d, &quadrics[i][k])); };
    QuadricV<N> sum;
    for (int i = 0; i < kMatrix; ++i) sum.matrix[i] = value(i);
    for (int i = 0; i < N; ++i) sum.vector[i] = value(kMatrix + i);
    sum.constant = value(kMatrix + N);
    // the edge, from the end with the smaller number
    const auto other_first = hn::Gt(hn::Load(d, &edges.is_first[k]), hn::Zero(d));
    PointV<N> edge, middle;
    for (int a = 0; a < N; ++a) {
      const V mine = hn::Set(d, input.place[a]), other = hn::Load(d, &places[a][k]);
      const V first = hn::IfThenElse(other_first, other, mine), second = hn::IfThenElse(other_first, mine, other);
      edge.x[a] = hn::Sub(second, first);
      middle.x[a] = hn::Add(first, hn::Mul(hn::Set(d, 0.5), edge.x[a]));
    }
    const V square = dot(edge, edge);
    PointV<N> best = sum.least_near(d, middle);
    const PointV<N> away = minus(best, middle);
    const auto is_near =
        hn::And(hn::Le(dot(away, away), hn::Mul(hn::Set(d, input.most_square), square)), hn::Gt(square, hn::Zero(d)));
    // the cost at the place as it is stored
    for (int a = 0; a < N; ++a) {
      const V scale = hn::Set(d, input.scale[a]), centre = hn::Set(d, input.centre[a]);
      V place = hn::Add(input.scale[a] == 1.0 ? best.x[a] : hn::Div(best.x[a], scale), centre);
      if (input.single_precision) place = hn::PromoteTo(d, hn::DemoteTo(in_single, place));
      best.x[a] = hn::Mul(hn::Sub(place, centre), scale);
    }
    hn::Store(sum(d, best), d, &edges.cost[k]);
    hn::Store(square, d, &edges.square[k]);
    hn::Store(hn::IfThenElse(is_near, hn::Zero(d), hn::Set(d, 1.0)), d, &edges.is_far[k]);
  }
}

#define TEGL_LANES(N)                                                                             \
  void measure_##N(SimplexLanes<N>& simplices) { measure_all<N>(simplices); }                     \
  void move_##N(const SimplexLanes<N>& simplices, const PointN<N>& place, ShapeLanes<N>& after) { \
    move_all<N>(simplices, place, after);                                                         \
  }                                                                                               \
  void find_##N(const TargetInput<N>& input, TargetLanes<N>& edges) { find_targets<N>(input, edges); }
TEGL_LANES(2)
TEGL_LANES(3)
TEGL_LANES(4)
#undef TEGL_LANES

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

#define TEGL_DISPATCH(N)                                                                               \
  HWY_EXPORT(measure_##N);                                                                             \
  HWY_EXPORT(move_##N);                                                                                \
  HWY_EXPORT(find_##N);                                                                                \
  template <>                                                                                          \
  void measure_lanes<N>(SimplexLanes<N> & simplices) {                                                 \
    HWY_DYNAMIC_DISPATCH(measure_##N)(simplices);                                                      \
  }                                                                                                    \
  template <>                                                                                          \
  void move_lanes<N>(const SimplexLanes<N>& simplices, const PointN<N>& place, ShapeLanes<N>& after) { \
    HWY_DYNAMIC_DISPATCH(move_##N)(simplices, place, after);                                           \
  }                                                                                                    \
  template <>                                                                                          \
  void find_target_lanes<N>(const TargetInput<N>& input, TargetLanes<N>& edges) {                      \
    HWY_DYNAMIC_DISPATCH(find_##N)(input, edges);                                                      \
  }
TEGL_DISPATCH(2)
TEGL_DISPATCH(3)
TEGL_DISPATCH(4)
#undef TEGL_DISPATCH

}  // namespace tegl::detail

#endif  // HWY_ONCE
