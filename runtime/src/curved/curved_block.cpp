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
using BlockVector = hn::Vec<BlockTag>;

/// Vectors of coordinates as doubles.
HWY_INLINE BlockVector widened(BlockTag d, hn::Vec<hn::Rebind<float, BlockTag>> v) { return hn::PromoteTo(d, v); }
HWY_INLINE BlockVector widened(BlockTag /*d*/, BlockVector v) { return v; }

/// The coordinates of as many points as fit into a vector, by axis.
template <std::size_t Dim, class Real>
HWY_INLINE void load_columns(const Real* points, BlockVector (&columns)[Dim]) {
  const BlockTag d;
  const hn::Rebind<Real, BlockTag> of_points;
  hn::Vec<decltype(of_points)> x, y, z, t;
  if constexpr (Dim == 2) hn::LoadInterleaved2(of_points, points, x, y);
  if constexpr (Dim == 3) hn::LoadInterleaved3(of_points, points, x, y, z);
  if constexpr (Dim == 4) hn::LoadInterleaved4(of_points, points, x, y, z, t);
  columns[0] = widened(d, x);
  columns[1] = widened(d, y);
  if constexpr (Dim > 2) columns[2] = widened(d, z);
  if constexpr (Dim > 3) columns[3] = widened(d, t);
}

/// The ends of edges in arrays: the numbers of their samples, and the weights of the second ends. `share` has an
/// element other than 0 at most, `share_of_edge`. Numbers are exact as arrays have fewer than 2^53 samples.
template <std::size_t Dim>
HWY_INLINE void ends_in(const CurvedArrays& arrays, const BlockVector (&base)[Dim], const BlockVector (&share)[Dim],
                        BlockVector share_of_edge, std::size_t i, CurvedBlock::Ends& ends) {
  const BlockTag d;
  const hn::RebindToSigned<BlockTag> di;
  auto at = hn::Zero(d), step = hn::Zero(d);
  for (std::size_t a = 0; a < Dim; ++a) {
    const auto stride = hn::Set(d, static_cast<double>(arrays.strides[a]));
    at = hn::MulAdd(base[a], stride, at);
    step = hn::Add(step, hn::IfThenElseZero(hn::Ne(share[a], hn::Zero(d)), stride));
  }
  hn::StoreU(hn::ConvertTo(di, at), di, ends.first.data() + i);
  hn::StoreU(hn::ConvertTo(di, hn::Add(at, step)), di, ends.second.data() + i);
  // the weights 1 and 0 for a coordinate that does not differ along the edge
  hn::StoreU(hn::IfThenElseZero(hn::Ne(step, hn::Zero(d)), share_of_edge), d, ends.weight.data() + i);
}

template <std::size_t Dim, class Real>
void all_ends(const Real* points, const IndexSteps& steps, std::span<const CurvedArrays> arrays, CurvedBlock& block) {
  const BlockTag d;
  const auto zero = hn::Zero(d);
  block.inside = 0;
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(d)) {
    BlockVector base[Dim], share[Dim];
    load_columns<Dim>(points + Dim * i, base);
    auto sum = zero, axes = zero;
    for (std::size_t a = 0; a < Dim; ++a) {
      const auto index = hn::Max(hn::Mul(base[a], hn::Set(d, steps[a])), zero);
      base[a] = hn::Floor(index);
      share[a] = hn::Sub(index, base[a]);
      sum = hn::Add(sum, share[a]);
      axes = hn::Add(axes, hn::IfThenElseZero(hn::Ne(share[a], zero), hn::Set(d, 1.0)));
    }
    for (std::size_t k = 0; k < arrays.size(); ++k) ends_in<Dim>(arrays[k], base, share, sum, i, block.ends[k]);
    const auto inside = hn::Gt(axes, hn::Set(d, 1.0));
    if (hn::AllFalse(d, inside)) continue;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, inside, bits);
    block.inside |= std::uint64_t{bits[0]} << i;
  }
}

void ends_of_floats(const float* points, std::size_t dim, const IndexSteps& steps, std::span<const CurvedArrays> arrays,
                    CurvedBlock& block) {
  dim == 2   ? all_ends<2>(points, steps, arrays, block)
  : dim == 3 ? all_ends<3>(points, steps, arrays, block)
             : all_ends<4>(points, steps, arrays, block);
}
void ends_of_doubles(const double* points, std::size_t dim, const IndexSteps& steps,
                     std::span<const CurvedArrays> arrays, CurvedBlock& block) {
  dim == 2   ? all_ends<2>(points, steps, arrays, block)
  : dim == 3 ? all_ends<3>(points, steps, arrays, block)
             : all_ends<4>(points, steps, arrays, block);
}

template <class Real>
bool finite(const CurvedBlock::Points<Real>& points) {
  const hn::CappedTag<Real, 16> d;
  auto sum = hn::Zero(d);  // 0 times infinity or NaN is NaN
  for (std::size_t i = 0; i < points.size(); i += hn::Lanes(d))
    sum = hn::MulAdd(hn::Zero(d), hn::LoadU(d, points.data() + i), sum);
  return hn::AllTrue(d, hn::Eq(sum, sum));
}
bool finite_floats(const CurvedBlock::Points<float>& points) { return finite(points); }
bool finite_doubles(const CurvedBlock::Points<double>& points) { return finite(points); }

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(ends_of_floats);
HWY_EXPORT(ends_of_doubles);
HWY_EXPORT(finite_floats);
HWY_EXPORT(finite_doubles);

void find_ends(const float* points, std::size_t dim, const IndexSteps& steps, std::span<const CurvedArrays> arrays,
               CurvedBlock& block) noexcept {
  HWY_DYNAMIC_DISPATCH(ends_of_floats)(points, dim, steps, arrays, block);
}
void find_ends(const double* points, std::size_t dim, const IndexSteps& steps, std::span<const CurvedArrays> arrays,
               CurvedBlock& block) noexcept {
  HWY_DYNAMIC_DISPATCH(ends_of_doubles)(points, dim, steps, arrays, block);
}

bool are_finite(const CurvedBlock::Points<float>& points) noexcept {
  return HWY_DYNAMIC_DISPATCH(finite_floats)(points);
}
bool are_finite(const CurvedBlock::Points<double>& points) noexcept {
  return HWY_DYNAMIC_DISPATCH(finite_doubles)(points);
}

void request(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count) noexcept {
  for (std::size_t i = 0; arrays.is_large && i < count; ++i)
    for (std::size_t k = 0; k < arrays.count; ++k) {
      hwy::Prefetch(arrays.values[k] + ends.first[i]);
      hwy::Prefetch(arrays.values[k] + ends.second[i]);
    }
}

/// Sets the coordinates of `Count` arrays. Here, for the baseline: many processors load one by one faster than they
/// gather, and results that go to memory once need no vectors.
template <std::size_t Count, class Real>
static void set_between(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count,
                        const CurvedBlock::Ends& next, std::size_t requested, std::size_t dim, Real* points) noexcept {
  std::array<const double*, Count> values;
  std::array<Real*, Count> out;
  for (std::size_t k = 0; k < Count; ++k) {
    values[k] = arrays.values[k];
    out[k] = points + arrays.axis[k];
  }
  const auto set = [&](std::size_t i) {
    const std::int64_t first = ends.first[i], second = ends.second[i];
    const double share = ends.weight[i], rest = 1.0 - share;
    for (std::size_t k = 0; k < Count; ++k)
      out[k][dim * i] = static_cast<Real>(rest * values[k][first] + share * values[k][second]);
  };
  std::size_t i = 0;
  for (; i < std::min(count, requested); ++i) {
    const std::int64_t first = next.first[i], second = next.second[i];
    for (std::size_t k = 0; k < Count; ++k) {
      hwy::Prefetch(values[k] + first);
      hwy::Prefetch(values[k] + second);
    }
    set(i);
  }
  for (; i < count; ++i) set(i);
}

template <class Real>
static void set_coordinates(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count,
                            const CurvedBlock::Ends& next, std::size_t requested, std::size_t dim,
                            Real* points) noexcept {
  constexpr std::array kSet = {&set_between<1, Real>, &set_between<2, Real>, &set_between<3, Real>,
                               &set_between<4, Real>};
  kSet[arrays.count - 1](arrays, ends, count, next, arrays.is_large ? requested : 0, dim, points);
}

void interpolate(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count,
                 const CurvedBlock::Ends& next, std::size_t requested, std::size_t dim, float* points) noexcept {
  set_coordinates(arrays, ends, count, next, requested, dim, points);
}
void interpolate(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count,
                 const CurvedBlock::Ends& next, std::size_t requested, std::size_t dim, double* points) noexcept {
  set_coordinates(arrays, ends, count, next, requested, dim, points);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
