// SPDX-License-Identifier: BSD-3-Clause
//
// Highway's foreach_target compiles this file once per instruction set. Which axis an edge is along is hard to predict,
// so no branch depends on it.
#include "curved/curved_block.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "curved/curved_block.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "image/vectors.hpp"

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

using FloatTag = hn::CappedTag<float, 16>;
using FloatVector = hn::Vec<FloatTag>;
using NumberTag = hn::RebindToSigned<FloatTag>;
using NumberVector = hn::Vec<NumberTag>;

HWY_INLINE void store_longer(NumberVector v, std::int64_t* out) {
#if HWY_TARGET == HWY_SCALAR
  *out = hn::GetLane(v);
#else
  const hn::RepartitionToWide<NumberTag> d;
  const hn::Half<NumberTag> half;
  hn::StoreU(hn::PromoteTo(d, hn::LowerHalf(half, v)), d, out);
  hn::StoreU(hn::PromoteTo(d, hn::UpperHalf(half, v)), d, out + hn::Lanes(d));
#endif
}
HWY_INLINE void store_longer(FloatVector v, double* out) {
#if HWY_TARGET == HWY_SCALAR
  *out = static_cast<double>(hn::GetLane(v));
#else
  const hn::RepartitionToWide<FloatTag> d;
  const hn::Half<FloatTag> half;
  hn::StoreU(hn::PromoteTo(d, hn::LowerHalf(half, v)), d, out);
  hn::StoreU(hn::PromoteTo(d, hn::UpperHalf(half, v)), d, out + hn::Lanes(d));
#endif
}

/// As all_ends, for twice as many points at a time. All arrays must be counted by 32 bits.
template <std::size_t Dim>
void all_ends_of_floats(const float* points, const IndexSteps& steps, std::span<const CurvedArrays> arrays,
                        CurvedBlock& block) {
  const FloatTag d;
  const NumberTag di;
  const auto zero = hn::Zero(d);
  block.inside = 0;
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(d)) {
    std::array<FloatVector, Dim> index;
    load_points(d, points + Dim * i, index);
    NumberVector base[Dim];
    hn::Mask<NumberTag> is_between[Dim];
    auto share_of_edge = zero;
    for (std::size_t a = 0; a < Dim; ++a) {
      index[a] = hn::Max(hn::Mul(index[a], hn::Set(d, static_cast<float>(steps[a]))), zero);
      const auto floor = hn::Floor(index[a]);
      const auto share = hn::Sub(index[a], floor);
      base[a] = hn::ConvertTo(di, floor);
      is_between[a] = hn::RebindMask(di, hn::Ne(share, zero));
      share_of_edge = hn::Add(share_of_edge, share);
    }
    auto any = is_between[0], several = hn::And(any, is_between[1]);
    for (std::size_t a = 1; a < Dim; ++a) {
      if (a > 1) several = hn::Or(several, hn::And(any, is_between[a]));
      any = hn::Or(any, is_between[a]);
    }
    for (std::size_t k = 0; k < arrays.size(); ++k) {
      auto at = hn::Zero(di), step = hn::Zero(di);
      for (std::size_t a = 0; a < Dim; ++a) {
        const auto stride = hn::Set(di, static_cast<std::int32_t>(arrays[k].strides[a]));
        at = hn::Add(at, hn::Mul(base[a], stride));
        step = hn::Add(step, hn::IfThenElseZero(is_between[a], stride));
      }
      store_longer(at, block.ends[k].first.data() + i);
      store_longer(hn::Add(at, step), block.ends[k].second.data() + i);
      const auto differs = hn::RebindMask(d, hn::Ne(step, hn::Zero(di)));
      store_longer(hn::IfThenElseZero(differs, share_of_edge), block.ends[k].weight.data() + i);
    }
    if (hn::AllFalse(di, several)) continue;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(di, several, bits);
    block.inside |= (std::uint64_t{bits[0]} | std::uint64_t{bits[1]} << 8) << i;
  }
}

void ends_of_floats(const float* points, std::size_t dim, const IndexSteps& steps, std::span<const CurvedArrays> arrays,
                    CurvedBlock& block) {
  if (std::all_of(arrays.begin(), arrays.end(), [](const CurvedArrays& each) { return each.fits_32_bits; }))
    return dim == 2   ? all_ends_of_floats<2>(points, steps, arrays, block)
           : dim == 3 ? all_ends_of_floats<3>(points, steps, arrays, block)
                      : all_ends_of_floats<4>(points, steps, arrays, block);
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

/// Reads the coordinates of samples, side by side, in the order of their axes. Reads no other numbers, as the memory
/// may end behind them, and what is between samples may be NaN. Three that are `Aligned` as four are in one cache line.
template <std::size_t Columns, bool Descends, bool Aligned, class T>
struct ColumnReader {
  static constexpr std::size_t kWidth = Columns == 2 ? 2 : 4;
  using Tag = hn::CappedTag<double, kWidth>;
  using StoredTag = hn::Rebind<T, Tag>;
  static constexpr bool kIsOneVector = hn::MaxLanes(Tag()) == kWidth;

  /// Coordinates `c` and following of the sample at `from`.
  HWY_INLINE hn::Vec<Tag> operator()(const T* from, std::size_t c) const {
    const StoredTag stored;
    if constexpr (Columns == 3 && kIsOneVector) {
      if constexpr (Aligned && !Descends) return longer(all(from));
      constexpr LaneIndex kLast = Aligned ? 2 : 3;
      alignas(32) constexpr std::array<LaneIndex, kWidth> kOrder = {Descends ? kLast : 0, 1, Descends ? 0 : kLast, 1};
      return longer(hn::TableLookupLanes(all(from), hn::SetTableIndices(stored, kOrder.data())));
    } else if constexpr (Descends && kIsOneVector) {
      return longer(hn::Reverse(stored, hn::LoadU(stored, from)));
    } else if constexpr (Descends) {
      std::array<T, kWidth> turned{};
      for (std::size_t i = c; i < std::min(c + hn::Lanes(stored), Columns); ++i) turned[i - c] = from[Columns - 1 - i];
      return longer(hn::LoadU(stored, turned.data()));
    } else {
      if (Columns == 3 && c == 2) return longer(hn::Set(stored, from[c]));
      return longer(hn::LoadU(stored, from + c));
    }
  }

 private:
  /// As doubles.
  static HWY_INLINE hn::Vec<Tag> longer(hn::Vec<StoredTag> v) {
    if constexpr (std::is_same_v<T, double>)
      return v;
    else
      return hn::PromoteTo(Tag(), v);
  }
  /// Three coordinates: the last one is the last lane, unless they are aligned: then that lane is 0.
  static HWY_INLINE hn::Vec<StoredTag> all(const T* from) {
    const StoredTag stored;
#if HWY_TARGET != HWY_SCALAR
    const hn::Half<StoredTag> half;
    if constexpr (!Aligned) return hn::Combine(stored, hn::LoadU(half, from + 1), hn::LoadU(half, from));
#endif
    return hn::MaskedLoad(hn::FirstN(stored, Columns), stored, from);
  }
  using LaneIndex = std::conditional_t<sizeof(T) == 4, std::int32_t, std::int64_t>;
};

/// Starts to load a sample. Always inlined: GCC removes calls of functions that do nothing else.
template <std::size_t Columns, bool Aligned, class T>
HWY_INLINE void request_sample(const T* first) {
  hwy::Prefetch(first);
  if constexpr (!Aligned) hwy::Prefetch(first + Columns - 1);
}

/// Sets all coordinates of points whose columns are side by side, of consecutive axes, from `out` on. The same
/// arithmetic as set_between.
template <std::size_t Columns, bool Descends, bool Aligned, class T, class Real>
HWY_INLINE bool columns_between(const T* numbers, const CurvedBlock::Ends& ends, std::size_t count,
                                const CurvedBlock::Ends& next, std::size_t requested, std::size_t dim, Real* out) {
  using Reader = ColumnReader<Columns, Descends, Aligned, T>;
  constexpr Reader kRead;
  const typename Reader::Tag d;
  const hn::Rebind<Real, decltype(d)> real;
  auto sum = hn::Zero(d);  // 0 times infinity or NaN is NaN
  const auto set = [&](std::size_t i, Real* to) HWY_ATTR {
    const T *const first = numbers + ends.first[i], *const second = numbers + ends.second[i];
    const auto share = hn::Set(d, ends.weight[i]), rest = hn::Sub(hn::Set(d, 1.0), share);
    for (std::size_t c = 0; c < Columns; c += hn::Lanes(d)) {
      const auto point = hn::Add(hn::Mul(rest, kRead(first, c)), hn::Mul(share, kRead(second, c)));
      sum = hn::MulAdd(hn::Zero(d), point, sum);
      if constexpr (std::is_same_v<Real, double>)
        hn::StoreU(point, real, to + c);
      else
        hn::StoreU(hn::DemoteTo(real, point), real, to + c);
    }
  };
  if (count == 0) return true;
  // Three columns are stored as four: this changes the next point, which is set afterwards, except for the last one.
  std::size_t i = 0;
  for (const std::size_t end = std::min(count - 1, requested); i < end; ++i) {
    request_sample<Columns, Aligned>(numbers + next.first[i]);
    request_sample<Columns, Aligned>(numbers + next.second[i]);
    set(i, out + dim * i);
  }
  for (; i < count - 1; ++i) set(i, out + dim * i);
  Real last[Reader::kWidth];
  set(i, last);
  std::copy_n(last, Columns, out + dim * i);
  for (; i < requested; ++i) {
    request_sample<Columns, Aligned>(numbers + next.first[i]);
    request_sample<Columns, Aligned>(numbers + next.second[i]);
  }
  return hn::AllTrue(d, hn::Eq(sum, sum));
}

template <bool Descends, bool Aligned, class T, class Real>
bool points_between(const T* numbers, std::size_t columns, const CurvedBlock::Ends& ends, std::size_t count,
                    const CurvedBlock::Ends& next, std::size_t requested, std::size_t dim, Real* out) {
  return columns == 2   ? columns_between<2, Descends, Aligned>(numbers, ends, count, next, requested, dim, out)
         : columns == 3 ? columns_between<3, Descends, Aligned>(numbers, ends, count, next, requested, dim, out)
                        : columns_between<4, Descends, Aligned>(numbers, ends, count, next, requested, dim, out);
}
#define TEGL_POINTS_BETWEEN(name, T, Real)                                                                            \
  bool name(const T* first, const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count,             \
            const CurvedBlock::Ends& next, std::size_t requested, std::size_t dim, Real* out) {                       \
    const bool descends = arrays.columns == CurvedColumns::descending;                                                \
    const auto& set = arrays.may_be_in_two_lines                                                                      \
                          ? (descends ? points_between<true, false, T, Real> : points_between<false, false, T, Real>) \
                          : (descends ? points_between<true, true, T, Real> : points_between<false, true, T, Real>);  \
    return set(first, arrays.count, ends, count, next, requested, dim, out);                                          \
  }
TEGL_POINTS_BETWEEN(floats_between_floats, float, float)
TEGL_POINTS_BETWEEN(doubles_between_floats, float, double)
TEGL_POINTS_BETWEEN(floats_between_doubles, double, float)
TEGL_POINTS_BETWEEN(doubles_between_doubles, double, double)
#undef TEGL_POINTS_BETWEEN

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(ends_of_floats);
HWY_EXPORT(ends_of_doubles);
HWY_EXPORT(floats_between_floats);
HWY_EXPORT(doubles_between_floats);
HWY_EXPORT(floats_between_doubles);
HWY_EXPORT(doubles_between_doubles);

void find_ends(const float* points, std::size_t dim, const IndexSteps& steps, std::span<const CurvedArrays> arrays,
               CurvedBlock& block) noexcept {
  HWY_DYNAMIC_DISPATCH(ends_of_floats)(points, dim, steps, arrays, block);
}
void find_ends(const double* points, std::size_t dim, const IndexSteps& steps, std::span<const CurvedArrays> arrays,
               CurvedBlock& block) noexcept {
  HWY_DYNAMIC_DISPATCH(ends_of_doubles)(points, dim, steps, arrays, block);
}

void CurvedArrays::find_columns(std::size_t dim) noexcept {
  columns = CurvedColumns::separate;
  if (count < 2 || (count == 3 && dim != 3)) return;  // three columns are stored as four
  const auto address = [&](std::size_t k) {
    return are_floats ? reinterpret_cast<std::uintptr_t>(floats[k]) : reinterpret_cast<std::uintptr_t>(doubles[k]);
  };
  const std::size_t bytes = are_floats ? sizeof(float) : sizeof(double);
  const auto first = axis.begin(), end = first + static_cast<std::ptrdiff_t>(count);
  const auto lowest = std::min_element(first, end), highest = std::max_element(first, end);
  const auto is_first = [&](std::size_t k, const auto& distance) {
    for (std::size_t other = 0; other < count; ++other)
      if (address(other) != address(k) + bytes * distance(axis[other])) return false;
    first_column = k;
    return true;
  };
  if (is_first(static_cast<std::size_t>(lowest - first), [&](std::size_t a) { return a - *lowest; }))
    columns = CurvedColumns::ascending;
  else if (is_first(static_cast<std::size_t>(highest - first), [&](std::size_t a) { return *highest - a; }))
    columns = CurvedColumns::descending;
  // Axes between others are missing, or have another group's coordinates.
  if (*highest - *lowest != count - 1) columns = CurvedColumns::separate;
  lowest_axis = *lowest;
  const std::size_t width = bytes * std::bit_ceil(count);  // at most half a line
  may_be_in_two_lines = address(first_column) % width != 0 || bytes * pitch % width != 0;
}

/// Starts to load numbers at the ends of edges. Always inlined, as request_sample.
template <class T>
static HWY_INLINE void request_ends(const T* numbers, const CurvedBlock::Ends& ends, std::size_t count) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    hwy::Prefetch(numbers + ends.first[i]);
    hwy::Prefetch(numbers + ends.second[i]);
  }
}

template <class T>
static HWY_INLINE void request_all(const CurvedArrays::Numbers<T>& numbers, const CurvedArrays& arrays,
                                   const CurvedBlock::Ends& ends, std::size_t count) noexcept {
  if (arrays.columns == CurvedColumns::separate) {
    for (std::size_t k = 0; k < arrays.count; ++k) request_ends(numbers[k], ends, count);
    return;
  }
  request_ends(numbers[arrays.first_column], ends, count);
  if (arrays.may_be_in_two_lines) request_ends(numbers[arrays.first_column] + arrays.count - 1, ends, count);
}

void request(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count) noexcept {
  if (!arrays.is_large) return;
  arrays.are_floats ? request_all(arrays.floats, arrays, ends, count)
                    : request_all(arrays.doubles, arrays, ends, count);
}

/// Sets `Count` coordinates from numbers of their own or columns of points. Here, for the baseline: many processors
/// load one by one faster than they gather, and results that go to memory once need no vectors.
template <std::size_t Count, class T, class Real>
static bool set_between(const CurvedArrays& arrays, const CurvedArrays::Numbers<T>& numbers,
                        const CurvedBlock::Ends& ends, std::size_t count, const CurvedBlock::Ends& next,
                        std::size_t requested, std::size_t dim, Real* points) noexcept {
  std::array<const T*, Count> values;
  std::array<Real*, Count> out;
  for (std::size_t k = 0; k < Count; ++k) {
    values[k] = numbers[k];
    out[k] = points + arrays.axis[k];
  }
  std::array<double, Count> sums{};  // 0 times infinity or NaN is NaN
  const auto set = [&](std::size_t i) {
    const std::int64_t first = ends.first[i], second = ends.second[i];
    const double share = ends.weight[i], rest = 1.0 - share;
    for (std::size_t k = 0; k < Count; ++k) {
      const double x = rest * static_cast<double>(values[k][first]) + share * static_cast<double>(values[k][second]);
      sums[k] += 0.0 * x;
      out[k][dim * i] = static_cast<Real>(x);
    }
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
  return std::accumulate(sums.begin(), sums.end(), 0.0) == 0.0;
}

template <class T, class Real>
static bool set_coordinates(const CurvedArrays& arrays, const CurvedArrays::Numbers<T>& numbers,
                            const CurvedBlock::Ends& ends, std::size_t count, const CurvedBlock::Ends& next,
                            std::size_t requested, std::size_t dim, Real* points) noexcept {
  constexpr std::array kSet = {&set_between<1, T, Real>, &set_between<2, T, Real>, &set_between<3, T, Real>,
                               &set_between<4, T, Real>};
  return kSet[arrays.count - 1](arrays, numbers, ends, count, next, requested, dim, points);
}

template <class Real, class T, class Vectors>
static bool set_of(const CurvedArrays::Numbers<T>& numbers, const Vectors& by_vectors, const CurvedArrays& arrays,
                   const CurvedBlock::Ends& ends, std::size_t count, const CurvedBlock::Ends& next,
                   std::size_t requested, std::size_t dim, Real* points) noexcept {
  if (arrays.columns == CurvedColumns::separate)
    return set_coordinates(arrays, numbers, ends, count, next, requested, dim, points);
  return by_vectors(numbers[arrays.first_column], arrays, ends, count, next, requested, dim,
                    points + arrays.lowest_axis);
}

template <class Real, class FromFloats, class FromDoubles>
static bool set_all(const FromFloats& from_floats, const FromDoubles& from_doubles, const CurvedArrays& arrays,
                    const CurvedBlock::Ends& ends, std::size_t count, const CurvedBlock::Ends& next,
                    std::size_t requested, std::size_t dim, Real* points) noexcept {
  if (!arrays.is_large) requested = 0;
  if (arrays.are_floats) return set_of(arrays.floats, from_floats, arrays, ends, count, next, requested, dim, points);
  return set_of(arrays.doubles, from_doubles, arrays, ends, count, next, requested, dim, points);
}

bool interpolate(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count,
                 const CurvedBlock::Ends& next, std::size_t requested, std::size_t dim, float* points) noexcept {
  return set_all([](auto&&... all) { return HWY_DYNAMIC_DISPATCH(floats_between_floats)(all...); },
                 [](auto&&... all) { return HWY_DYNAMIC_DISPATCH(floats_between_doubles)(all...); }, arrays, ends,
                 count, next, requested, dim, points);
}
bool interpolate(const CurvedArrays& arrays, const CurvedBlock::Ends& ends, std::size_t count,
                 const CurvedBlock::Ends& next, std::size_t requested, std::size_t dim, double* points) noexcept {
  return set_all([](auto&&... all) { return HWY_DYNAMIC_DISPATCH(doubles_between_floats)(all...); },
                 [](auto&&... all) { return HWY_DYNAMIC_DISPATCH(doubles_between_doubles)(all...); }, arrays, ends,
                 count, next, requested, dim, points);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
