// SPDX-License-Identifier: BSD-3-Clause
//
// Filling the components of Sigma (private to the generator).
#pragma once

#include "filling/face_contours.hpp"
#include "filling/hull.hpp"
#include "filling/tile_contour.hpp"
#include "filling/tile_regions.hpp"

namespace tegl::gen {

/// What fillings are taken from, beside Sigma.
struct FillingSources {
  const HullContours* hulls = nullptr;             ///< of the tile; needed for compact contours
  const SignatureRegions* side_regions = nullptr;  ///< of the tile's faces; needed for 4-cubes
};

/// Appends one facet per component of contour.boundary, for tiles of dimension 3 and 4.
void fill(const FaceContours& faces, const FillingSources& sources, Signature signature, TileContour& contour);

}  // namespace tegl::gen
