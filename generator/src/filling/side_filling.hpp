// SPDX-License-Identifier: BSD-3-Clause
//
// Side filling (private to the generator).
#pragma once

#include <vector>

#include "base/tile_contour.hpp"
#include "filling/face_contours.hpp"
#include "filling/tile_regions.hpp"

namespace tegl::gen {

/// Fills a component of a 4-tile's Sigma of any genus by a copy of one side of the tile's boundary: the high side for
/// the low-connected alternative, the low side for the high-connected one. Appends the masks of added vertices to
/// contour.side_masks; all cone vertices must be numbered before. `regions`: regions of the tile's faces. Throws
/// std::logic_error if other components bound that side too.
void fill_by_side(const FaceContours& faces, const SignatureRegions& regions, Signature signature,
                  const std::vector<LocalSimplex>& component, TileContour& contour, LocalFacet& facet);

}  // namespace tegl::gen
