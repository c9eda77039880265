// SPDX-License-Identifier: BSD-3-Clause
//
// Packing of comparisons into words. The compiler turns the byte loops into vector code; eight flags
// are then gathered by one multiplication.
// Based on: H. S. Warren, Hacker's Delight, 2nd ed. 2012, section 7-4 (compress by multiplication).
#include "bitplanes.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

namespace tegl::detail {
namespace {

/// Bit i of the result is flags[i], each 0 or 1.
Word pack(const std::uint8_t* flags) noexcept {
  Word word = 0;
  for (std::size_t byte = 0; byte < 8; ++byte) {
    Word eight = 0;
    if constexpr (std::endian::native == std::endian::little) {
      std::memcpy(&eight, flags + 8 * byte, 8);
    } else {
      for (unsigned i = 0; i < 8; ++i) eight |= static_cast<Word>(flags[8 * byte + i]) << (8 * i);
    }
    word |= ((eight * 0x0102040810204080u) >> 56) << (8 * byte);
  }
  return word;
}

/// 64 adjacent samples.
template <Value T>
Word high_word(const T* samples, T threshold) noexcept {
  alignas(64) std::uint8_t flags[kWordBits];
  for (std::size_t i = 0; i < kWordBits; ++i) flags[i] = samples[i] >= threshold ? 1 : 0;
  return pack(flags);
}

template <Value T>
Word nan_word(const T* samples) noexcept {
  alignas(64) std::uint8_t flags[kWordBits];
  std::uint8_t any = 0;
  for (std::size_t i = 0; i < kWordBits; ++i) {
    flags[i] = samples[i] != samples[i] ? 1 : 0;
    any = static_cast<std::uint8_t>(any | flags[i]);
  }
  return any == 0 ? 0 : pack(flags);
}

}  // namespace

template <Value T>
bool classify_row(const T* samples, std::ptrdiff_t stride, std::size_t count, const Threshold<T>& threshold, Word* high,
                  Word* missing) noexcept {
  bool any_missing = false;
  const std::size_t words = (count + kWordBits - 1) / kWordBits;
  for (std::size_t w = 0; w < words; ++w) {
    const std::size_t first = w * kWordBits;
    const std::size_t length = std::min(kWordBits, count - first);
    const T* block = samples + static_cast<std::ptrdiff_t>(first) * stride;
    T gathered[kWordBits];
    if (stride != 1 || length < kWordBits) {
      for (std::size_t i = 0; i < length; ++i) gathered[i] = block[static_cast<std::ptrdiff_t>(i) * stride];
      std::fill(gathered + length, gathered + kWordBits, T{});
      block = gathered;
    }
    const Word mask = length == kWordBits ? ~Word{0} : (Word{1} << length) - 1;
    high[w] = threshold.never ? 0 : high_word(block, threshold.value) & mask;
    if constexpr (std::is_floating_point_v<T>) {
      const Word nans = nan_word(block) & mask;
      if (nans != 0 && !any_missing) {
        std::fill(missing, missing + w, Word{0});
        any_missing = true;
      }
      if (any_missing) missing[w] = nans;
    }
  }
  return any_missing;
}

#define TEGL_INSTANTIATE(T) \
  template bool classify_row<T>(const T*, std::ptrdiff_t, std::size_t, const Threshold<T>&, Word*, Word*) noexcept;
TEGL_INSTANTIATE(std::uint8_t)
TEGL_INSTANTIATE(std::int8_t)
TEGL_INSTANTIATE(std::uint16_t)
TEGL_INSTANTIATE(std::int16_t)
TEGL_INSTANTIATE(std::int32_t)
TEGL_INSTANTIATE(float)
TEGL_INSTANTIATE(double)
#undef TEGL_INSTANTIATE

}  // namespace tegl::detail
