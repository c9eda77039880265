// SPDX-License-Identifier: BSD-3-Clause
//
// Filling the components of Sigma (private to the generator).
#pragma once

#include "tegl/gen/facets.hpp"

namespace tegl::gen {

/// Appends one facet per component of contour.boundary, for tiles of dimension 3 and 4.
void fill(const ContourBuilder& builder, Signature signature, TileContour& contour);

}  // namespace tegl::gen
