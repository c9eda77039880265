// SPDX-License-Identifier: BSD-3-Clause
//
// Side filling (private to the generator).
#pragma once

#include <vector>

#include "filling/face_contours.hpp"
#include "filling/tile_contour.hpp"
#include "filling/tile_regions.hpp"

namespace tegl::gen {

/// Fills a component of a 4-tile's Sigma of any genus by a copy of one side of the tile's boundary: its high
/// side for the low-connected alternative, its low side for the high-connected one. Appends the masks of the
/// vertices that it adds to contour.side_masks; all cone vertices must have been numbered before. `regions`: of the
/// tile's faces.
/// Throws std::logic_error if that side is bounded by more than the component.
void fill_by_side(const FaceContours& faces, const SignatureRegions& regions, Signature signature,
                  const std::vector<Simplex>& component, TileContour& contour, Facet& facet);

}  // namespace tegl::gen
