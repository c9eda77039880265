// SPDX-License-Identifier: BSD-3-Clause
//
// Constraints for the dimensions and coordinate types that the library is compiled for. A template argument outside of
// them is a compile error that names the constraint, and not a linker error. Also the default scale of the axes.
#pragma once

#include <array>
#include <type_traits>

namespace tegl {

/// True for dimensions kLeast to kMost. Constrains types and functions that do not exist in all dimensions.
template <int N, int kLeast, int kMost>
concept DimensionBetween = (N >= kLeast) && (N <= kMost);

/// The types of contour coordinates: float or double.
template <class R>
concept Coordinate = std::is_same_v<R, float> || std::is_same_v<R, double>;

namespace detail {
/// The scale of the axes that changes nothing: 1 along each.
template <int N>
constexpr std::array<double, N> all_one() {
  std::array<double, N> result{};
  result.fill(1.0);
  return result;
}
}  // namespace detail

}  // namespace tegl
