// SPDX-License-Identifier: BSD-3-Clause
//
// Single samples of files: numbers in text, and values in the other byte order.
#pragma once

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include <fmt/format.h>

#include "base/common.hpp"

namespace tegl::io_detail {

/// Reverses the bytes of each value.
template <class T>
void swap_bytes(std::span<T> values) {
  using Bits = std::conditional_t<sizeof(T) == 1, std::uint8_t,
                                  std::conditional_t<sizeof(T) == 2, std::uint16_t,
                                                     std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;
  for (T& value : values) {
    const auto bits = std::bit_cast<Bits>(value);
    if constexpr (sizeof(T) == 2)
      value = std::bit_cast<T>(static_cast<Bits>(__builtin_bswap16(bits)));
    else if constexpr (sizeof(T) == 4)
      value = std::bit_cast<T>(static_cast<Bits>(__builtin_bswap32(bits)));
    else if constexpr (sizeof(T) == 8)
      value = std::bit_cast<T>(static_cast<Bits>(__builtin_bswap64(bits)));
  }
}

/// Parses a whole word as T. Integers may be written with a decimal point or an exponent. Floating-point numbers below
/// the smallest of T become 0.
template <class T>
bool parse_sample(std::string_view word, T& value) {
  word = without_plus(word);
  const char* const end = word.data() + word.size();
  const auto is_whole = [&](std::from_chars_result result) { return result.ec == std::errc() && result.ptr == end; };
  if (word.empty()) return false;
  if (is_whole(std::from_chars(word.data(), end, value))) return true;
  if constexpr (std::is_integral_v<T>) {
    double number = 0;
    if (!is_whole(std::from_chars(word.data(), end, number)) || number != std::trunc(number)) return false;
    // max + 1 is a power of two, so double represents it exactly for every type.
    const double beyond = std::ldexp(1.0, std::numeric_limits<T>::digits);
    if (!(number >= static_cast<double>(std::numeric_limits<T>::lowest()) && number < beyond)) return false;
    value = static_cast<T>(number);
    return true;
  } else {
    long double number = 0;
    if (!is_whole(std::from_chars(word.data(), end, number)) || !(std::abs(number) < 1)) return false;
    value = static_cast<T>(number);
    return true;
  }
}

template <class T>
std::string expected_numbers(std::string_view type) {
  if constexpr (std::is_integral_v<T>)
    return fmt::format("whole numbers from {} to {} ({})", std::numeric_limits<T>::lowest(),
                       std::numeric_limits<T>::max(), type);
  return fmt::format("numbers of type {}", type);
}

}  // namespace tegl::io_detail
