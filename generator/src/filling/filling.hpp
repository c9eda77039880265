// SPDX-License-Identifier: BSD-3-Clause
//
// Fills the components of Sigma (private to the generator).
#pragma once

#include "base/tile_contour.hpp"
#include "embedding/embedding_proof.hpp"
#include "filling/face_contours.hpp"
#include "filling/hull.hpp"
#include "filling/tile_regions.hpp"

namespace tegl::gen {

/// Auxiliary data for fillings, besides Sigma.
struct FillingSources {
  const HullContours* hulls = nullptr;             ///< hulls of the tile; required for compact contours
  const EmbeddingProof* proof = nullptr;           ///< of the tile; required for compact contours
  const SignatureRegions* side_regions = nullptr;  ///< regions of the tile's faces; required for 4-cubes
};

/// Appends one facet per component of contour.boundary, for tiles of dimension 3 and 4.
void fill(const FaceContours& faces, const FillingSources& sources, Signature signature, TileContour& contour);

}  // namespace tegl::gen
