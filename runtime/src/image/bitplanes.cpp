// SPDX-License-Identifier: BSD-3-Clause
//
// Packs comparisons into words. Highway's foreach_target compiles this file once per instruction set.
#include "image/bitplanes.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/bitplanes.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kFetchedAhead = 4096;  ///< bytes from the samples that are compared to those that are requested

/// The lanes of a mask as bits, lane 0 lowest.
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

/// Compares at most 64 adjacent samples with the threshold. `missing` receives the NaNs.
template <class T>
HWY_INLINE Word high_word(const T* samples, std::size_t length, T threshold, Word& missing) {
  const hn::ScalableTag<T> d;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  const auto limit = hn::Set(d, threshold);
  [[maybe_unused]] auto none_missing = hn::Eq(limit, limit);
  Word word = 0;
  const auto compare = [&](const auto& values, std::size_t i) HWY_ATTR {
    if constexpr (std::is_floating_point_v<T>) {
      word |= bits_of(d, hn::Ge(values, limit)) << i;
      none_missing = hn::And(none_missing, hn::Eq(values, values));
    } else {
      word |= bits_of(d, hn::Not(hn::Lt(values, limit))) << i;
    }
  };
  // compare whole registers, then the rest
  T rest[kLanes] = {};
  const std::size_t whole = length - length % kLanes;
  for (std::size_t i = 0; i < whole; i += kLanes) compare(hn::LoadU(d, samples + i), i);
  if (whole < length) {
    std::memcpy(rest, samples + whole, (length - whole) * sizeof(T));
    compare(hn::LoadU(d, rest), whole);
  }
  // find NaNs if there are any
  missing = 0;
  if constexpr (std::is_floating_point_v<T>) {
    if (HWY_UNLIKELY(!hn::AllTrue(d, none_missing)))
      for (std::size_t i = 0; i < length; i += kLanes) {
        const auto values = hn::LoadU(d, i < whole ? samples + i : rest);
        missing |= bits_of(d, hn::Not(hn::Eq(values, values))) << i;  // Ne is false for NaN on some instruction sets
      }
  }
  return word;
}

/// Requests the 64 samples that a later call of high_word reads. Processors fetch ahead by themselves, but not across
/// the end of a page of 4 KiB, and rows of a layer follow one another in memory. They need not stay in the caches,
/// since most are read once. The address may be past the end of the image.
template <class T>
HWY_INLINE void fetch_ahead(const T* samples) {
  constexpr std::size_t kLine = 64;
  const auto address = reinterpret_cast<std::uintptr_t>(samples) + kFetchedAhead;
  for (std::size_t byte = 0; byte < kWordBits * sizeof(T); byte += kLine)
    __builtin_prefetch(reinterpret_cast<const char*>(address + byte), 0, 0);
}

/// high_word for samples that are not adjacent, at most 64.
template <class T>
HWY_INLINE Word gathered_word(const T* samples, std::ptrdiff_t stride, std::size_t length, T threshold, Word& missing) {
  T gathered[kWordBits];
  for (std::size_t i = 0; i < length; ++i) gathered[i] = samples[static_cast<std::ptrdiff_t>(i) * stride];
  return high_word(gathered, length, threshold, missing);
}

/// Classifies one row. Returns whether any sample is missing.
template <class T>
HWY_INLINE bool classify(const T* samples, std::ptrdiff_t stride, std::size_t count, const Threshold<T>& threshold,
                         Word* high, Word* missing) {
  bool any_missing = false;
  for (std::size_t w = 0, first = 0; first < count; ++w, first += kWordBits) {
    const std::size_t length = std::min(kWordBits, count - first);
    const T* const block = samples + static_cast<std::ptrdiff_t>(first) * stride;
    Word nans = 0;
    if (stride == 1 && length == kWordBits) fetch_ahead(block);
    const Word word = stride != 1           ? gathered_word(block, stride, length, threshold.value, nans)
                      : length == kWordBits ? high_word(block, kWordBits, threshold.value, nans)
                                            : high_word(block, length, threshold.value, nans);
    const Word mask = length == kWordBits ? ~Word{0} : (Word{1} << length) - 1;
    high[w] = threshold.never ? 0 : word & mask;
    if constexpr (std::is_floating_point_v<T>) {
      if (nans != 0 && !any_missing) {
        std::fill(missing, missing + w, Word{0});
        any_missing = true;
      }
      if (any_missing) missing[w] = nans & mask;
    }
  }
  return any_missing;
}

template <class T>
HWY_INLINE Word classify_all(const SampleRows<T>& samples, const Threshold<T> threshold, BitRows high,
                             BitRows missing) {
  Word any_missing = 0;
  for (std::size_t r = 0; r < samples.rows; ++r) {
    const T* const row = samples.first + static_cast<std::ptrdiff_t>(r) * samples.row_stride;
    const bool any = classify(row, samples.stride, samples.count, threshold, high.first + r * high.pitch,
                              missing.first + r * missing.pitch);
    any_missing |= Word{any} << r;
  }
  return any_missing;
}

#define TEGL_CLASSIFY(T, name)                                                                            \
  Word name(const SampleRows<T>& samples, const Threshold<T>& threshold, BitRows high, BitRows missing) { \
    return classify_all(samples, threshold, high, missing);                                               \
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

#define TEGL_DISPATCH(T, name)                                                                     \
  HWY_EXPORT(name);                                                                                \
  template <>                                                                                      \
  Word classify_rows<T>(const SampleRows<T>& samples, const Threshold<T>& threshold, BitRows high, \
                        BitRows missing) noexcept {                                                \
    return HWY_DYNAMIC_DISPATCH(name)(samples, threshold, high, missing);                          \
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
