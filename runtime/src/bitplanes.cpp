// SPDX-License-Identifier: BSD-3-Clause
//
// Packing of comparisons into words; compiled once per instruction set (Highway's foreach_target).
#include "bitplanes.hpp"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bitplanes.cpp"
#include "dispatch.hpp"
// Highway's own headers come after this one.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A mask's lanes as bits, lane 0 lowest.
template <class D, class M>
HWY_INLINE Word bits_of(D d, M mask) {
  constexpr std::size_t kLanes = hn::MaxLanes(D());
  using Bits = std::conditional_t<
      kLanes <= 8, std::uint8_t,
      std::conditional_t<kLanes == 16, std::uint16_t, std::conditional_t<kLanes == 32, std::uint32_t, std::uint64_t>>>;
  Bits bits = 0;
  hn::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&bits));
  return bits;
}

/// 64 adjacent samples against the threshold. `missing` gets the NaNs.
template <class T>
HWY_INLINE Word high_word(const T* samples, T threshold, Word& missing) {
  const hn::ScalableTag<T> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const auto limit = hn::Set(d, threshold);
  Word word = 0;
  missing = 0;
  if constexpr (std::is_floating_point_v<T>) {
    auto none_missing = hn::Eq(limit, limit);
    for (std::size_t i = 0; i < kWordBits; i += kLanes) {
      const auto values = hn::LoadU(d, samples + i);
      word |= bits_of(d, hn::Ge(values, limit)) << i;
      none_missing = hn::And(none_missing, hn::Eq(values, values));
    }
    if (HWY_UNLIKELY(!hn::AllTrue(d, none_missing)))
      for (std::size_t i = 0; i < kWordBits; i += kLanes) {
        const auto values = hn::LoadU(d, samples + i);
        missing |= bits_of(d, hn::Not(hn::Eq(values, values))) << i;  // Ne is false for NaN on some sets
      }
    return word;
  } else {
    for (std::size_t i = 0; i < kWordBits; i += kLanes)
      word |= bits_of(d, hn::Lt(hn::LoadU(d, samples + i), limit)) << i;
    return ~word;
  }
}

template <class T>
HWY_INLINE bool classify(const T* samples, std::ptrdiff_t stride, std::size_t count, const Threshold<T>& threshold,
                         Word* high, Word* missing) {
  bool any_missing = false;
  const std::size_t words = (count + kWordBits - 1) / kWordBits;
  for (std::size_t w = 0; w < words; ++w) {
    const std::size_t first = w * kWordBits;
    const std::size_t length = std::min(kWordBits, count - first);
    const T* block = samples + static_cast<std::ptrdiff_t>(first) * stride;
    T gathered[kWordBits];
    if (stride != 1 || length < kWordBits) {
      if (stride == 1)
        std::memcpy(gathered, block, length * sizeof(T));
      else
        for (std::size_t i = 0; i < length; ++i) gathered[i] = block[static_cast<std::ptrdiff_t>(i) * stride];
      std::memset(gathered + length, 0, (kWordBits - length) * sizeof(T));
      block = gathered;
    }
    const Word mask = length == kWordBits ? ~Word{0} : (Word{1} << length) - 1;
    Word nans = 0;
    const Word word = high_word(block, threshold.value, nans) & mask;
    high[w] = threshold.never ? 0 : word;
    if constexpr (std::is_floating_point_v<T>) {
      nans &= mask;
      if (nans != 0 && !any_missing) {
        std::fill(missing, missing + w, Word{0});
        any_missing = true;
      }
      if (any_missing) missing[w] = nans;
    }
  }
  return any_missing;
}

#define TEGL_CLASSIFY(T, name)                                                                                     \
  bool name(const T* samples, std::ptrdiff_t stride, std::size_t count, const Threshold<T>& threshold, Word* high, \
            Word* missing) {                                                                                       \
    return classify(samples, stride, count, threshold, high, missing);                                             \
  }
TEGL_CLASSIFY(std::uint8_t, classify_u8)
TEGL_CLASSIFY(std::int8_t, classify_i8)
TEGL_CLASSIFY(std::uint16_t, classify_u16)
TEGL_CLASSIFY(std::int16_t, classify_i16)
TEGL_CLASSIFY(std::int32_t, classify_i32)
TEGL_CLASSIFY(float, classify_f32)
TEGL_CLASSIFY(double, classify_f64)
#undef TEGL_CLASSIFY

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

#define TEGL_DISPATCH(T, name)                                                                                    \
  HWY_EXPORT(name);                                                                                               \
  template <>                                                                                                     \
  bool classify_row<T>(const T* samples, std::ptrdiff_t stride, std::size_t count, const Threshold<T>& threshold, \
                       Word* high, Word* missing) noexcept {                                                      \
    return HWY_DYNAMIC_DISPATCH(name)(samples, stride, count, threshold, high, missing);                          \
  }
TEGL_DISPATCH(std::uint8_t, classify_u8)
TEGL_DISPATCH(std::int8_t, classify_i8)
TEGL_DISPATCH(std::uint16_t, classify_u16)
TEGL_DISPATCH(std::int16_t, classify_i16)
TEGL_DISPATCH(std::int32_t, classify_i32)
TEGL_DISPATCH(float, classify_f32)
TEGL_DISPATCH(double, classify_f64)
#undef TEGL_DISPATCH

}  // namespace tegl::detail

#endif  // HWY_ONCE
