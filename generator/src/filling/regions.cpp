// SPDX-License-Identifier: BSD-3-Clause
//
// Regions from the contours that ContourBuilder makes for the tile and its faces.
#include "filling/regions.hpp"

#include "filling/facets.hpp"

namespace tegl::gen {

RegionBuilder::RegionBuilder(const Lattice& lattice, int k, Alternative alternative, Triangulation triangulation,
                             RegionStyle style)
    : SignatureRegions(lattice, k, contours_by_dimension(lattice, k, alternative, triangulation), style, true) {}

}  // namespace tegl::gen
