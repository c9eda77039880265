// SPDX-License-Identifier: BSD-3-Clause
//
// Samples against an isovalue, one bit each: the first step of the extraction. A row of samples along
// axis 0 becomes words of 64 bits, lowest bit first.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "tegl/image.hpp"

namespace tegl::detail {

using Word = std::uint64_t;
inline constexpr std::size_t kWordBits = 64;

/// The test `V >= isovalue` in the image's own type, with exactly the outcome of the test in real numbers.
template <Value T>
struct Threshold {
  T value{};
  bool never = false;  ///< no value of the type reaches the isovalue
};

/// Precondition: `isovalue` is finite.
template <Value T>
Threshold<T> make_threshold(double isovalue) {
  using Limits = std::numeric_limits<T>;
  if constexpr (std::is_integral_v<T>) {
    const double up = std::ceil(isovalue);
    if (up > static_cast<double>(Limits::max())) return {Limits::max(), true};
    if (up <= static_cast<double>(Limits::min())) return {Limits::min(), false};
    return {static_cast<T>(up), false};
  } else if constexpr (std::is_same_v<T, float>) {
    // The smallest float that is not below the isovalue.
    if (isovalue > static_cast<double>(Limits::max())) return {Limits::infinity(), false};
    if (isovalue < static_cast<double>(Limits::lowest())) return {Limits::lowest(), false};
    auto value = static_cast<float>(isovalue);
    if (static_cast<double>(value) < isovalue) value = std::nextafter(value, Limits::infinity());
    return {value, false};
  } else {
    return {isovalue, false};
  }
}

/// Classifies `count` samples, `stride` elements apart. Writes ceil(count / 64) words; bits past the
/// end are 0. `missing` gets the NaNs if there are any, and is left alone otherwise.
/// Returns whether there are any.
template <Value T>
bool classify_row(const T* samples, std::ptrdiff_t stride, std::size_t count, const Threshold<T>& threshold, Word* high,
                  Word* missing) noexcept;

}  // namespace tegl::detail
