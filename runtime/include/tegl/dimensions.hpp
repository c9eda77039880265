// SPDX-License-Identifier: BSD-3-Clause
//
// The dimensions and coordinate types that the library is compiled for, as constraints: a template argument outside of
// them is an error of the compiler that names the constraint, not one of the linker.
#pragma once

#include <type_traits>

namespace tegl {

/// The dimensions kLeast to kMost. Types and functions that do not exist in all dimensions are constrained by it.
template <int N, int kLeast, int kMost>
concept DimensionBetween = (N >= kLeast) && (N <= kMost);

/// The types that coordinates of contours have: float or double.
template <class R>
concept Coordinate = std::is_same_v<R, float> || std::is_same_v<R, double>;

}  // namespace tegl
