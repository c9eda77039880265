// SPDX-License-Identifier: BSD-3-Clause
//
// Highway's foreach_target compiles this file once per instruction set. Which axis an edge is along is hard to predict,
// so no branch depends on it.
#include "curved/curved_block.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "curved/curved_block.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/cache_control.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using BlockTag = hn::CappedTag<double, 8>;

void places(CurvedBlock& block, std::size_t axis, double step) {
  const BlockTag d;
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(d)) {
    const auto index = hn::Max(hn::Mul(hn::LoadU(d, block.point[axis].data() + i), hn::Set(d, step)), hn::Zero(d));
    const auto base = hn::Floor(index);
    hn::StoreU(base, d, block.base[axis].data() + i);
    hn::StoreU(hn::Sub(index, base), d, block.share[axis].data() + i);
  }
}

void edges(CurvedBlock& block, unsigned along) {
  const BlockTag d;
  const auto one = hn::Set(d, 1.0);
  block.inside = 0;
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(d)) {
    auto sum = hn::Zero(d), axes = hn::Zero(d);
    for (std::size_t a = 0; a < CurvedBlock::kMostAxes; ++a) {
      if ((along >> a & 1u) == 0) continue;
      const auto share = hn::LoadU(d, block.share[a].data() + i);
      sum = hn::Add(sum, share);
      axes = hn::Add(axes, hn::IfThenElseZero(hn::Ne(share, hn::Zero(d)), one));
    }
    hn::StoreU(sum, d, block.edge_share.data() + i);
    const auto inside = hn::Or(hn::Gt(axes, one), hn::Eq(sum, one));
    if (hn::AllFalse(d, inside)) continue;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, inside, bits);
    block.inside |= std::uint64_t{bits[0]} << i;
  }
}

/// The ends of edges in arrays: the numbers of their samples, and the weights of the second ends.
void ends(const CurvedBlock& block, const CurvedArrays& arrays, CurvedBlock::Ends& of) {
  const BlockTag d;
  const hn::RebindToSigned<BlockTag> di;
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(d)) {
    auto at = hn::Zero(d), step = hn::Zero(d);
    for (std::size_t a = 0; a < CurvedBlock::kMostAxes; ++a) {
      if (arrays.strides[a] == 0) continue;
      const auto stride = hn::Set(d, static_cast<double>(arrays.strides[a]));
      at = hn::MulAdd(hn::LoadU(d, block.base[a].data() + i), stride, at);
      const auto share = hn::LoadU(d, block.share[a].data() + i);
      step = hn::Add(step, hn::IfThenElseZero(hn::Ne(share, hn::Zero(d)), stride));
    }
    hn::StoreU(hn::ConvertTo(di, at), di, of.first.data() + i);
    hn::StoreU(hn::ConvertTo(di, hn::Add(at, step)), di, of.second.data() + i);
    // the weights 1 and 0 for a coordinate that does not differ along the edge
    hn::StoreU(hn::IfThenElseZero(hn::Ne(step, hn::Zero(d)), hn::LoadU(d, block.edge_share.data() + i)), d,
               of.weight.data() + i);
  }
}

void all_places(CurvedBlock& block, const IndexSteps& steps) {
  for (std::size_t a = 0; a < CurvedBlock::kMostAxes; ++a)
    if (steps[a] != 0.0) places(block, a, steps[a]);
}

void all_ends(CurvedBlock& block, unsigned along, std::span<const CurvedArrays> arrays) {
  edges(block, along);
  for (std::size_t k = 0; k < arrays.size(); ++k) ends(block, arrays[k], block.ends[k]);
}

/// The coordinates between the values at the ends.
void between(CurvedBlock& block, const CurvedBlock::Ends& ends, std::size_t k, std::size_t axis) {
  const BlockTag d;
  const auto one = hn::Set(d, 1.0);
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(d)) {
    const auto share = hn::LoadU(d, ends.weight.data() + i);
    const auto here = hn::LoadU(d, block.here[k].data() + i), next = hn::LoadU(d, block.next[k].data() + i);
    hn::StoreU(hn::Add(hn::Mul(hn::Sub(one, share), here), hn::Mul(share, next)), d, block.point[axis].data() + i);
  }
}

void all_between(CurvedBlock& block, const CurvedArrays& arrays, const CurvedBlock::Ends& ends) {
  for (std::size_t k = 0; k < arrays.count; ++k) between(block, ends, k, arrays.axis[k]);
}

/// Vectors of coordinates as doubles, and back.
HWY_INLINE hn::Vec<BlockTag> widened(BlockTag d, hn::Vec<hn::Rebind<float, BlockTag>> v) { return hn::PromoteTo(d, v); }
HWY_INLINE hn::Vec<BlockTag> widened(BlockTag /*d*/, hn::Vec<BlockTag> v) { return v; }
template <class Real>
HWY_INLINE auto narrowed(hn::Vec<BlockTag> v) {
  if constexpr (sizeof(Real) == sizeof(double))
    return v;
  else
    return hn::DemoteTo(hn::Rebind<Real, BlockTag>(), v);
}

/// The coordinates of as many points as fit into a vector.
template <std::size_t Dim, class D, class V>
HWY_INLINE void load_columns(D d, const hn::TFromD<D>* points, V& x, V& y, V& z, V& t) {
  if constexpr (Dim == 2) hn::LoadInterleaved2(d, points, x, y);
  if constexpr (Dim == 3) hn::LoadInterleaved3(d, points, x, y, z);
  if constexpr (Dim == 4) hn::LoadInterleaved4(d, points, x, y, z, t);
}

/// Loads points of `Dim` coordinates; of the last ones, which fill no vector, one by one.
template <std::size_t Dim, class Real>
void load(const Real* points, unsigned axes, CurvedBlock& block) {
  const BlockTag d;
  const hn::Rebind<Real, BlockTag> of_points;
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= block.count; i += hn::Lanes(d)) {
    hn::Vec<decltype(of_points)> x, y, z, t;
    const auto keep = [&](std::size_t a, auto v) {
      if ((axes >> a & 1u) != 0) hn::StoreU(widened(d, v), d, block.point[a].data() + i);
    };
    load_columns<Dim>(of_points, points + Dim * i, x, y, z, t);
    keep(0, x);
    keep(1, y);
    if constexpr (Dim > 2) keep(2, z);
    if constexpr (Dim > 3) keep(3, t);
  }
  for (std::size_t a = 0; a < Dim; ++a) {
    if ((axes >> a & 1u) == 0) continue;
    for (std::size_t j = i; j < block.count; ++j) block.point[a][j] = static_cast<double>(points[Dim * j + a]);
    std::fill(block.point[a].begin() + block.count, block.point[a].end(), 0.0);
  }
}

template <std::size_t Dim, class Real>
void store(const CurvedBlock& block, unsigned axes, Real* points) {
  const BlockTag d;
  const hn::Rebind<Real, BlockTag> of_points;
  std::size_t i = 0;
  for (; i + hn::Lanes(d) <= block.count; i += hn::Lanes(d)) {
    hn::Vec<decltype(of_points)> x, y, z, t;
    const auto take = [&](std::size_t a, auto& v) {
      if ((axes >> a & 1u) != 0) v = narrowed<Real>(hn::LoadU(d, block.point[a].data() + i));
    };
    load_columns<Dim>(of_points, points + Dim * i, x, y, z, t);
    take(0, x);
    take(1, y);
    if constexpr (Dim > 2) take(2, z);
    if constexpr (Dim > 3) take(3, t);
    if constexpr (Dim == 2) hn::StoreInterleaved2(x, y, of_points, points + Dim * i);
    if constexpr (Dim == 3) hn::StoreInterleaved3(x, y, z, of_points, points + Dim * i);
    if constexpr (Dim == 4) hn::StoreInterleaved4(x, y, z, t, of_points, points + Dim * i);
  }
  for (std::size_t a = 0; a < Dim; ++a)
    for (std::size_t j = i; j < block.count && (axes >> a & 1u) != 0; ++j)
      points[Dim * j + a] = static_cast<Real>(block.point[a][j]);
}

void load_float(const float* points, std::size_t dim, unsigned axes, CurvedBlock& block) {
  dim == 2 ? load<2>(points, axes, block) : dim == 3 ? load<3>(points, axes, block) : load<4>(points, axes, block);
}
void load_double(const double* points, std::size_t dim, unsigned axes, CurvedBlock& block) {
  dim == 2 ? load<2>(points, axes, block) : dim == 3 ? load<3>(points, axes, block) : load<4>(points, axes, block);
}
void store_float(const CurvedBlock& block, std::size_t dim, unsigned axes, float* points) {
  dim == 2 ? store<2>(block, axes, points) : dim == 3 ? store<3>(block, axes, points) : store<4>(block, axes, points);
}
void store_double(const CurvedBlock& block, std::size_t dim, unsigned axes, double* points) {
  dim == 2 ? store<2>(block, axes, points) : dim == 3 ? store<3>(block, axes, points) : store<4>(block, axes, points);
}

bool finite(const CurvedBlock& block, unsigned axes) {
  const BlockTag d;
  auto sum = hn::Zero(d);  // 0 times infinity or NaN is NaN
  for (std::size_t a = 0; a < CurvedBlock::kMostAxes; ++a)
    for (std::size_t i = 0; (axes >> a & 1u) != 0 && i < block.count; i += hn::Lanes(d))
      sum = hn::MulAdd(hn::Zero(d), hn::LoadU(d, block.point[a].data() + i), sum);
  return hn::AllTrue(d, hn::Eq(sum, sum));
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(all_places);
HWY_EXPORT(all_ends);
HWY_EXPORT(all_between);
HWY_EXPORT(finite);
HWY_EXPORT(load_float);
HWY_EXPORT(load_double);
HWY_EXPORT(store_float);
HWY_EXPORT(store_double);

void find_places(CurvedBlock& block, const IndexSteps& steps) noexcept {
  HWY_DYNAMIC_DISPATCH(all_places)(block, steps);
}

void find_edges(CurvedBlock& block, unsigned along, std::span<const CurvedArrays> arrays) noexcept {
  HWY_DYNAMIC_DISPATCH(all_ends)(block, along, arrays);
}

void load_points(const float* points, std::size_t dim, unsigned axes, CurvedBlock& block) noexcept {
  HWY_DYNAMIC_DISPATCH(load_float)(points, dim, axes, block);
}
void load_points(const double* points, std::size_t dim, unsigned axes, CurvedBlock& block) noexcept {
  HWY_DYNAMIC_DISPATCH(load_double)(points, dim, axes, block);
}
void store_points(const CurvedBlock& block, std::size_t dim, unsigned axes, float* points) noexcept {
  HWY_DYNAMIC_DISPATCH(store_float)(block, dim, axes, points);
}
void store_points(const CurvedBlock& block, std::size_t dim, unsigned axes, double* points) noexcept {
  HWY_DYNAMIC_DISPATCH(store_double)(block, dim, axes, points);
}

bool are_finite(const CurvedBlock& block, unsigned axes) noexcept { return HWY_DYNAMIC_DISPATCH(finite)(block, axes); }

void request(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count) noexcept {
  for (std::size_t i = 0; arrays.is_large && i < count; ++i)
    for (std::size_t k = 0; k < arrays.count; ++k) {
      hwy::Prefetch(arrays.values[k] + ends.first[i]);
      hwy::Prefetch(arrays.values[k] + ends.second[i]);
    }
}

/// Reads the values of `Count` arrays at ends.
template <std::size_t Count>
static void read_ends(CurvedBlock& block, const CurvedArrays& arrays, const CurvedBlock::Ends& ends,
                      const CurvedBlock::Ends& next, std::size_t count) noexcept {
  for (std::size_t i = 0; i < block.count; ++i) {
    const std::int64_t first = ends.first[i], second = ends.second[i];
    for (std::size_t k = 0; k < Count; ++k) {
      block.here[k][i] = arrays.values[k][first];
      block.next[k][i] = arrays.values[k][second];
    }
    if (i >= count) continue;
    for (std::size_t k = 0; k < Count; ++k) {
      hwy::Prefetch(arrays.values[k] + next.first[i]);
      hwy::Prefetch(arrays.values[k] + next.second[i]);
    }
  }
}

void interpolate(CurvedBlock& block, const CurvedArrays& arrays, const CurvedBlock::Ends& ends,
                 const CurvedBlock::Ends& next, std::size_t count) noexcept {
  // here, for the baseline: many processors load one by one faster than they gather
  constexpr std::array kRead = {&read_ends<1>, &read_ends<2>, &read_ends<3>, &read_ends<4>};
  kRead[arrays.count - 1](block, arrays, ends, next, arrays.is_large ? count : 0);
  HWY_DYNAMIC_DISPATCH(all_between)(block, arrays, ends);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
