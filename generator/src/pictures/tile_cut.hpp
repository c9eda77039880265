// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of a 4-tile cut at one value of its last coordinate, for pictures (private to the generator).
#pragma once

#include <array>
#include <vector>

#include "filling/facets.hpp"
#include "pictures/picture.hpp"

namespace tegl::gen {

/// Triangles in the unit cube, the right-hand normal towards high. Edge points lie half way, barycentres about the
/// middle of their facets; time is in (0, 1).
[[nodiscard]] std::vector<std::array<Place, 3>> cut(const ContourBuilder& builder, Signature signature,
                                                    const TileContour& contour, double time);

}  // namespace tegl::gen
