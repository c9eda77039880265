// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts the contour of a 4-tile at a value of its last coordinate, for pictures (private to the generator).
#pragma once

#include <array>
#include <vector>

#include "filling/facets.hpp"
#include "pictures/picture.hpp"

namespace tegl::gen {

/// Returns triangles in the unit cube; their right-hand normals point towards high. Edge points lie at the middle of
/// edges, barycentres approximately in the middle of their facets. time is in (0, 1).
[[nodiscard]] std::vector<std::array<Place, 3>> cut(const ContourBuilder& builder, Signature signature,
                                                    const TileContour& contour, double time);

}  // namespace tegl::gen
