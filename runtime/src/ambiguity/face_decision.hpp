// SPDX-License-Identifier: BSD-3-Clause
//
// Resolution of squares and cubes by their values alone, without an image.
#pragma once

#include <span>

#include "ambiguity/face_estimator.hpp"
#include "tile/cube_key.hpp"

namespace tegl::detail {

/// Key of a cube with these values, by a rule that is not a caller's.
CubeKey cube_key(FaceRule rule, std::span<const double, 8> values, double isovalue, unsigned signature) noexcept;
/// Whether the centre of an ambiguous square with these values is high, by a rule that is not a caller's.
bool is_square_high(FaceRule rule, std::span<const double, 4> values, double isovalue) noexcept;

}  // namespace tegl::detail
