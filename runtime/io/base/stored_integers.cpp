// SPDX-License-Identifier: BSD-3-Clause
//
// Implements ValueScaling: contours of values from the integers that a file stores.
#include "base/stored_integers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <variant>

namespace tegl {

double ValueScaling::value_of(double stored) const noexcept {
  const double of_file = slope < 0 ? static_cast<double>(least + greatest) - stored : stored;
  const double value = of_file * slope + intercept;
  return single_precision ? static_cast<double>(static_cast<float>(value)) : value;
}

double ValueScaling::stored_isovalue(double isovalue) const noexcept {
  // the first integer whose value reaches the isovalue; greatest + 1 if there is none
  std::int64_t first = least;
  for (std::int64_t end = greatest + 1; first < end;) {
    const std::int64_t middle = first + (end - first) / 2;
    if (value_of(static_cast<double>(middle)) >= isovalue)
      end = middle;
    else
      first = middle + 1;
  }
  const auto high = static_cast<double>(first);
  if (first <= greatest && value_of(high) == isovalue) return high;
  // Values are rounded: the quotient may lie on the other side of an integer.
  const double above_low = std::nextafter(high - 1.0, std::numeric_limits<double>::infinity());
  const double below_high = std::nextafter(high, -std::numeric_limits<double>::infinity());
  const double of_file = (isovalue - intercept) / slope;
  return std::clamp(slope < 0 ? static_cast<double>(least + greatest) - of_file : of_file, above_low, below_high);
}

namespace io_detail {

std::optional<ValueScaling> integer_scaling(const ValueArray& values, double slope, double intercept) {
  return std::visit(
      [&]<class T>(const ValueVector<T>&) -> std::optional<ValueScaling> {
        if constexpr (!std::is_integral_v<T> || sizeof(T) > 4 || std::is_same_v<T, std::uint32_t>) {
          return std::nullopt;
        } else {
          using Real = std::conditional_t<sizeof(T) <= 2, float, double>;
          using Limits = std::numeric_limits<T>;
          const ValueScaling scaling{slope, intercept, Limits::lowest(), Limits::max(), std::is_same_v<Real, float>};
          const double largest = std::max(std::abs(slope * static_cast<double>(Limits::lowest()) + intercept),
                                          std::abs(slope * static_cast<double>(Limits::max()) + intercept));
          // The difference of the values of neighbouring integers is at least four roundings.
          const double rounding = std::max(largest * static_cast<double>(std::numeric_limits<Real>::epsilon()),
                                           static_cast<double>(std::numeric_limits<Real>::min()));
          const double most = static_cast<double>(std::numeric_limits<Real>::max()) / 4;
          if (!(std::abs(slope) >= 4 * rounding) || !(largest <= most)) return std::nullopt;
          return scaling;
        }
      },
      values);
}

ValueArray in_reverse_order(ValueArray&& values) {
  std::visit(
      []<class T>(ValueVector<T>& all) {
        if constexpr (std::is_integral_v<T>)
          for (T& value : all) value = static_cast<T>(~value);
      },
      values);
  return std::move(values);
}

}  // namespace io_detail

}  // namespace tegl
