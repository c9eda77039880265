// SPDX-License-Identifier: BSD-3-Clause
//
// Reads values around edges (see edge_stencil.hpp). Highway's foreach_target compiles this file once per instruction
// set.
#include "image/edge_stencil.hpp"

#include <algorithm>
#include <array>
#include <type_traits>
#include <utility>

// Type of the samples, type of the arithmetic, function name. Guarded because the file is read once per instruction
// set.
#ifndef TEGL_FOR_VALUES
#define TEGL_FOR_VALUES(APPLY)            \
  APPLY(std::uint8_t, float, pick_u8f)    \
  APPLY(std::int8_t, float, pick_i8f)     \
  APPLY(std::uint16_t, float, pick_u16f)  \
  APPLY(std::int16_t, float, pick_i16f)   \
  APPLY(float, float, pick_f32f)          \
  APPLY(std::uint8_t, double, pick_u8d)   \
  APPLY(std::int8_t, double, pick_i8d)    \
  APPLY(std::uint16_t, double, pick_u16d) \
  APPLY(std::int16_t, double, pick_i16d)  \
  APPLY(std::int32_t, double, pick_i32d)  \
  APPLY(float, double, pick_f32d)         \
  APPLY(double, double, pick_f64d)
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/edge_stencil.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Loads as many values as D has lanes.
template <class D, class T>
HWY_INLINE hn::Vec<D> load_values(D d, const T* from) {
  using Calc = hn::TFromD<D>;
  const hn::Rebind<T, D> values;
  const hn::Rebind<std::int32_t, D> integers;
  if constexpr (std::is_same_v<T, Calc>)
    return hn::LoadU(d, from);
  else if constexpr (sizeof(T) == sizeof(std::int32_t))
    return hn::PromoteTo(d, hn::LoadU(values, from));
  else if constexpr (std::is_same_v<Calc, float>)
    return hn::ConvertTo(d, hn::PromoteTo(integers, hn::LoadU(values, from)));
  else
    return hn::PromoteTo(d, hn::PromoteTo(integers, hn::LoadU(values, from)));
}

template <class D, class M>
HWY_INLINE hn::Mask<D> chosen_from(D d, M mask) {
  const hn::Rebind<std::int32_t, D> integers;
  if constexpr (sizeof(hn::TFromD<D>) == sizeof(std::int32_t))
    return hn::RebindMask(d, mask);
  else
    return hn::MaskFromVec(hn::BitCast(d, hn::PromoteTo(hn::RebindToSigned<D>(), hn::VecFromMask(integers, mask))));
}

template <class D>
HWY_INLINE auto lanes_from(D d, hn::Vec<hn::Rebind<std::int32_t, D>> lanes) {
  if constexpr (sizeof(hn::TFromD<D>) == sizeof(std::int32_t))
    return hn::IndicesFromVec(d, lanes);
  else
    return hn::IndicesFromVec(d, hn::PromoteTo(hn::RebindToSigned<D>(), lanes));
}

/// Maximum number of registers that hold the samples of one group of edges.
constexpr std::size_t kMostRegisters = 8;

/// Location of the values of as many edges as D has lanes.
template <class D>
struct Picked {
  using Lanes = decltype(lanes_from(D(), hn::Zero(hn::Rebind<std::int32_t, D>())));
  std::array<std::ptrdiff_t, kMostRegisters> first;  ///< by register: first sample
  std::array<Lanes, kMostRegisters> lanes;
  std::array<hn::Mask<D>, kMostRegisters> chosen;  ///< edges in this register or a later one
};

/// Writes the values of as many edges as D has lanes, by place. kCount: number of registers with their samples; 0:
/// `count`.
template <std::size_t kCount, class D, class T>
HWY_INLINE void pick_some(D d, const EdgesInRow<T, hn::TFromD<D>>& row, const Picked<D>& picked, std::size_t count,
                          hn::TFromD<D>* out) {
  for (std::size_t place = 0; place < row.places; ++place, out += kEdgesAtOnce) {
    const T* const from = row.from[place];
    const auto values = [&](std::size_t r) {
      return hn::TableLookupLanes(load_values(d, from + picked.first[r]), picked.lanes[r]);
    };
    auto result = values(0);
    for (std::size_t r = 1; r < (kCount != 0 ? kCount : count); ++r)
      result = hn::IfThenElse(picked.chosen[r], values(r), result);
    hn::StoreU(result, d, out);
  }
}

/// Whether all edges are in the same row in ascending order. Rows that overlap, or coincide by a stride of 0, may start
/// at the same position; edges do not ascend then.
template <class T, class Calc>
HWY_INLINE bool is_row(const EdgesInRow<T, Calc>& row) {
  const auto check = [&](auto d, const auto* values, std::size_t first, auto compare) HWY_ATTR {
    constexpr std::size_t kLanes = hn::MaxLanes(d);
    static_assert(kLanes < kEdgesAtOnce / 2);
    auto good = hn::Eq(hn::Zero(d), hn::Zero(d));
    for (std::size_t i = first; i < row.count; i += kLanes)
      good = hn::And(good, compare(d, values + std::min(i, row.count - kLanes)));
    return hn::AllTrue(d, good);
  };
  return check(hn::ScalableTag<std::int64_t>(), row.rows, 0,
               [&](auto d, const std::ptrdiff_t* at) HWY_ATTR {
                 return hn::Eq(hn::LoadU(d, reinterpret_cast<const std::int64_t*>(at)), hn::Set(d, row.rows[0]));
               }) &&
         check(hn::ScalableTag<std::uint32_t>(), row.at, 1, [&](auto d, const std::uint32_t* at) HWY_ATTR {
           return hn::Lt(hn::LoadU(d, at - 1), hn::LoadU(d, at));
         });
}

template <class T, class Calc>
HWY_INLINE bool pick(const EdgesInRow<T, Calc>& row) {
  const hn::ScalableTag<Calc> d;
  const hn::Rebind<std::int32_t, decltype(d)> integers;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  static_assert(kLanes <= kMostLanes);
  // Emulated registers save nothing.
  if (HWY_TARGET == HWY_EMU128 || HWY_TARGET == HWY_SCALAR) return false;
  if (kEdgesPerRegister * (row.at[row.count - 1] - row.at[0]) >= kLanes * row.count || !is_row(row)) return false;
  // Sample indices are relative to the first edge, because registers cannot hold large numbers.
  const std::size_t origin = std::max<std::size_t>(row.at[0], row.begin);
  const std::size_t limit = std::min<std::size_t>(row.at[row.count - 1], row.end - 1) - origin;
  const std::ptrdiff_t final = static_cast<std::ptrdiff_t>(row.end - kLanes) - static_cast<std::ptrdiff_t>(origin);
  const auto from_origin = [&](std::uint32_t x) { return std::min(std::max<std::size_t>(x, origin) - origin, limit); };
  const auto set = [&](std::ptrdiff_t x) { return hn::Set(integers, static_cast<std::int32_t>(x)); };
  std::array<std::uint32_t, kEdgesAtOnce + kMostLanes> at;  // entries past the last edge are read too
  std::copy_n(row.at, row.count, at.begin());
  std::fill_n(at.begin() + row.count, kLanes, row.at[row.count - 1]);
  Picked<decltype(hn::ScalableTag<Calc>())> picked;
  for (std::size_t i = 0; i < row.count; i += kLanes) {
    const auto ahead = hn::Sub(hn::LoadU(integers, reinterpret_cast<const std::int32_t*>(at.data() + i)),
                               hn::Set(integers, static_cast<std::int32_t>(static_cast<std::uint32_t>(origin))));
    const auto edges = hn::Max(hn::Min(ahead, set(static_cast<std::ptrdiff_t>(limit))), hn::Zero(integers));
    const std::size_t x = from_origin(at[i]);
    const std::size_t count = (from_origin(at[i + kLanes - 1]) - x) / kLanes + 1;
    if (count > kMostRegisters) return false;
    // lanes of each edge in the registers
    for (std::size_t r = 0; r < count; ++r) {
      const auto begin = static_cast<std::ptrdiff_t>(x + r * kLanes);
      const std::ptrdiff_t first = std::min(begin, final);
      picked.first[r] = first + row.rows[0] + static_cast<std::ptrdiff_t>(origin);
      picked.lanes[r] = lanes_from(d, hn::And(hn::Sub(edges, set(first)), set(kLanes - 1)));
      picked.chosen[r] = chosen_from(d, hn::Gt(edges, set(begin - 1)));
    }
    // copy the values
    switch (count) {
      case 1:
        pick_some<1>(d, row, picked, count, row.out + i);
        break;
      case 2:
        pick_some<2>(d, row, picked, count, row.out + i);
        break;
      case 3:
        pick_some<3>(d, row, picked, count, row.out + i);
        break;
      default:
        pick_some<0>(d, row, picked, count, row.out + i);
    }
  }
  return true;
}

#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128

/// Four adjacent samples of each of four edges: of sample i those at i - 1, i, i + 1 and i + 2. One load for several
/// values, and one store for four edges.
template <class D>
struct FourRows {
  using V = hn::Vec<D>;
  D d;
  V lower01, lower23, upper01, upper23;

  template <class T>
  HWY_INLINE FourRows(D tag, const T* from, const std::array<std::ptrdiff_t, 4>& at) : d(tag) {
    const auto values = [&](unsigned i) HWY_ATTR { return load_values(d, from + at[i] - 1); };
    const V v0 = values(0), v1 = values(1), v2 = values(2), v3 = values(3);
    lower01 = hn::InterleaveLower(d, v0, v1);
    lower23 = hn::InterleaveLower(d, v2, v3);
    upper01 = hn::InterleaveUpper(d, v0, v1);
    upper23 = hn::InterleaveUpper(d, v2, v3);
  }
  HWY_INLINE V before() const { return hn::ConcatLowerLower(d, lower23, lower01); }
  HWY_INLINE V here() const { return hn::ConcatUpperUpper(d, lower23, lower01); }
  HWY_INLINE V next() const { return hn::ConcatLowerLower(d, upper23, upper01); }
  HWY_INLINE V after_next() const { return hn::ConcatUpperUpper(d, upper23, upper01); }
};

/// The sample of each of four edges and the next one.
template <class D>
struct FourPairs {
  hn::Vec<D> here, next;

  template <class T>
  HWY_INLINE FourPairs(D d, const T* from, const std::array<std::ptrdiff_t, 4>& at) {
#if HWY_ARCH_X86
    if constexpr (std::is_same_v<T, float> && std::is_same_v<hn::TFromD<D>, float>) {
      // Only the two: the four that FourRows reads are often in two cache lines.
      static_cast<void>(d);
      const auto two = [&](unsigned i) HWY_ATTR {
        const __m128i pair = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from + at[i]));
        return _mm_loadh_pi(_mm_castsi128_ps(pair), reinterpret_cast<const __m64*>(from + at[i + 1]));
      };
      const __m128 first = two(0), second = two(2);
      here = hn::Vec<D>{_mm_shuffle_ps(first, second, _MM_SHUFFLE(2, 0, 2, 0))};
      next = hn::Vec<D>{_mm_shuffle_ps(first, second, _MM_SHUFFLE(3, 1, 3, 1))};
      return;
    }
#endif
    const FourRows<D> rows(d, from, at);
    here = rows.here();
    next = rows.next();
  }
};

/// The sample of each of four edges.
template <class D, class T>
HWY_INLINE hn::Vec<D> four_values(D d, const T* from, const std::array<std::ptrdiff_t, 4>& at) {
#if HWY_ARCH_X86
  if constexpr (std::is_same_v<T, float> && std::is_same_v<hn::TFromD<D>, float>) {
    const auto value = [&](unsigned i) HWY_ATTR { return _mm_load_ss(from + at[i]); };
#if HWY_TARGET <= HWY_SSE4
    const __m128 two = _mm_insert_ps(value(0), value(1), 0x10);
    return hn::Vec<D>{_mm_insert_ps(_mm_insert_ps(two, value(2), 0x20), value(3), 0x30)};
#else
    return hn::Vec<D>{_mm_movelh_ps(_mm_unpacklo_ps(value(0), value(1)), _mm_unpacklo_ps(value(2), value(3)))};
#endif
  }
#endif
  return FourRows<D>(d, from, at).here();
}

/// The places that FourRows does not read: neighbours in rows of their own. kAlongRow: of each value and the next one,
/// which are read together, the first.
template <bool kAlongRow, std::size_t kAxes>
struct SinglePlaces {
  static constexpr std::size_t kCount = kAlongRow ? 2 * kAxes - 2 : 4 * kAxes - 6;
  std::array<std::size_t, kCount> at;

  HWY_INLINE explicit SinglePlaces(std::size_t own) {
    std::size_t count = 0;
    // along the row, places 4 a + 2 and 4 a + 3 are next to 4 a and 4 a + 1
    for (std::size_t place = 4; place < 4 * kAxes; ++place)
      if (kAlongRow ? place % 4 < 2 : place != own + 1 && place != own + 2) at[count++] = place;
  }
};

template <bool kAlongRow, std::size_t kAxes, class T, class Calc>
HWY_INLINE std::uint64_t gather_fours(const EdgesAnywhere<T, Calc>& edges) {
  // local, because stores of vectors may change any memory
  const std::size_t count = edges.count, own = 4 * edges.axis;
  const std::ptrdiff_t* const rows = edges.rows;
  const std::uint32_t* const at = edges.at;
  Calc* const all = edges.out;
  const T* const first_row = edges.from[kAlongRow ? 0 : own + 2] + (kAlongRow ? 1 : 0);
  const T* const second_row = edges.from[own + 1];
  const SinglePlaces<kAlongRow, kAxes> singles(own);
  std::array<const T*, singles.kCount> from;
  std::array<std::size_t, singles.kCount> to;
  for (std::size_t s = 0; s < singles.kCount; ++s) {
    from[s] = edges.from[singles.at[s]];
    to[s] = singles.at[s] * kEdgesAtOnce;
  }
  const hn::FixedTag<Calc, 4> d;
  using Rows = FourRows<hn::FixedTag<Calc, 4>>;
  const auto four = [&](const std::array<std::ptrdiff_t, 4>& samples, Calc* out) HWY_ATTR {
    const auto store = [&](std::size_t place, auto values)
                           HWY_ATTR { hn::StoreU(values, d, out + place * kEdgesAtOnce); };
    const Rows row(d, first_row, samples);
    store(0, row.before());
    store(1, row.next());
    if constexpr (kAlongRow) {
      store(2, row.here());
      store(3, row.after_next());
    } else {
      store(own + 2, row.here());
      const Rows other(d, second_row, samples);
      store(2, other.before());
      store(3, other.next());
      store(own + 1, other.here());
    }
    const auto single = [&](std::size_t s) HWY_ATTR {
      if constexpr (kAlongRow) {
        const FourPairs beside(d, from[s], samples);
        hn::StoreU(beside.here, d, out + to[s]);
        hn::StoreU(beside.next, d, out + to[s] + 2 * kEdgesAtOnce);
      } else {
        hn::StoreU(four_values(d, from[s], samples), d, out + to[s]);
      }
    };
    // Unrolled, as not every optimisation level unrolls a loop.
    [&]<std::size_t... S>(std::index_sequence<S...>) HWY_ATTR { (single(S), ...); }
    (std::make_index_sequence<singles.kCount>());
  };
  const hn::FixedTag<std::uint32_t, 4> lanes;
  const auto most = hn::Set(lanes, static_cast<std::uint32_t>(edges.row_size - 4));
  std::uint64_t left = 0;
  for (std::size_t i = 0; i < count; i += 4) {
    const std::size_t first = std::min(i, count - 4);  // some edges are read twice
    const auto inside = hn::Sub(hn::LoadU(lanes, at + first), hn::Set(lanes, 1u));
    if (HWY_LIKELY(hn::AllTrue(lanes, hn::Eq(inside, hn::Min(inside, most))))) {
      const auto sample = [&](std::size_t j) HWY_ATTR { return rows[j] + static_cast<std::ptrdiff_t>(at[j]); };
      four({sample(first), sample(first + 1), sample(first + 2), sample(first + 3)}, all + first);
    } else {
      left |= std::uint64_t{15} << first;
    }
  }
  return left;
}

template <bool kAlongRow, class T, class Calc>
HWY_INLINE std::uint64_t gather_fours(const EdgesAnywhere<T, Calc>& edges) {
  if (edges.places == 8) return gather_fours<kAlongRow, 2>(edges);
  if (edges.places == 12) return gather_fours<kAlongRow, 3>(edges);
  return gather_fours<kAlongRow, 4>(edges);
}

#endif

template <class T, class Calc>
HWY_INLINE std::uint64_t gather(const EdgesAnywhere<T, Calc>& edges) {
#if HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128
  if constexpr (sizeof(Calc) == sizeof(float))
    if (edges.count >= 4 && edges.row_size >= 4)
      return edges.axis == 0 ? gather_fours<true>(edges) : gather_fours<false>(edges);
#endif
  return ~std::uint64_t{0} >> (kEdgesAtOnce - edges.count);
}

template <class T, class Calc>
HWY_INLINE void convert(const T* from, std::size_t count, Calc* out) {
  const hn::ScalableTag<Calc> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  std::size_t i = 0;
  for (; i + kLanes <= count; i += kLanes) hn::StoreU(load_values(d, from + i), d, out + i);
  for (; i < count; ++i) out[i] = static_cast<Calc>(from[i]);
}

// Highway's dispatch tables cannot hold templates.
#define TEGL_PICK(T, Calc, name)                                                             \
  bool name(const EdgesInRow<T, Calc>& row) { return pick(row); }                            \
  std::uint64_t name##_gather(const EdgesAnywhere<T, Calc>& edges) { return gather(edges); } \
  void name##_convert(const T* from, std::size_t count, Calc* out) { convert(from, count, out); }
TEGL_FOR_VALUES(TEGL_PICK)
#undef TEGL_PICK

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

#define TEGL_DISPATCH(T, Calc, name)                                                   \
  HWY_EXPORT(name);                                                                    \
  template <>                                                                          \
  bool pick_values<T, Calc>(const EdgesInRow<T, Calc>& row) noexcept {                 \
    return HWY_DYNAMIC_DISPATCH(name)(row);                                            \
  }                                                                                    \
  HWY_EXPORT(name##_gather);                                                           \
  template <>                                                                          \
  std::uint64_t gather_values<T, Calc>(const EdgesAnywhere<T, Calc>& edges) noexcept { \
    return HWY_DYNAMIC_DISPATCH(name##_gather)(edges);                                 \
  }                                                                                    \
  HWY_EXPORT(name##_convert);                                                          \
  template <>                                                                          \
  void convert_values<T, Calc>(const T* from, std::size_t count, Calc* out) noexcept { \
    HWY_DYNAMIC_DISPATCH(name##_convert)(from, count, out);                            \
  }
TEGL_FOR_VALUES(TEGL_DISPATCH)
#undef TEGL_DISPATCH

}  // namespace tegl::detail

#endif  // HWY_ONCE
