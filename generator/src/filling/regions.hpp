// SPDX-License-Identifier: BSD-3-Clause
//
// The regions of tiles with the contours that the tables have. Used to close contours at an image's border.
#pragma once

#include "filling/tile_regions.hpp"

namespace tegl::gen {

/// Builds the regions of any signature of the k-cube, k = 1, 2, 3.
class RegionBuilder : public SignatureRegions {
 public:
  /// For k-tiles of a lattice, which must outlive it.
  RegionBuilder(const Lattice& lattice, int k, Alternative alternative, Triangulation triangulation, RegionStyle style);
};

}  // namespace tegl::gen
