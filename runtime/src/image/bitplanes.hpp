// SPDX-License-Identifier: BSD-3-Clause
//
// Classification of samples against an isovalue, one bit each: the first step of the extraction. A row of samples along
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

/// The test `V >= isovalue` in the image's own type, with exactly the result of the test in real numbers.
template <Value T>
struct Threshold {
  T value{};
  bool never = false;  ///< no value of the type reaches the isovalue
};

/// `isovalue` must be finite.
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

/// Rows of samples at equal distances. Strides are in elements.
template <Value T>
struct SampleRows {
  const T* first;
  std::ptrdiff_t stride;  ///< between samples
  std::size_t count;      ///< samples per row
  std::ptrdiff_t row_stride;
  std::size_t rows;  ///< at most 64
};

/// Destination of rows of bits; `pitch`: words between rows.
struct BitRows {
  Word* first;
  std::size_t pitch;
};

/// Classifies rows. Writes ceil(count / 64) words per row to `high`; bits past the end are 0. A row of `missing`
/// receives the bits of NaNs if it has any, and otherwise is not written. Returns the rows with NaNs, bit r for row r.
template <Value T>
Word classify_rows(const SampleRows<T>& samples, const Threshold<T>& threshold, BitRows high, BitRows missing) noexcept;

/// Classifies one row. Returns whether it has NaNs.
template <Value T>
bool classify_row(const T* samples, std::ptrdiff_t stride, std::size_t count, const Threshold<T>& threshold, Word* high,
                  Word* missing) noexcept {
  return classify_rows<T>({samples, stride, count, 0, 1}, threshold, {high, 0}, {missing, 0}) != 0;
}

}  // namespace tegl::detail
