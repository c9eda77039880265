// SPDX-License-Identifier: BSD-3-Clause
//
// The regions of tiles bounded by the contours of the tables. They close contours at an image's border.
#pragma once

#include "filling/tile_regions.hpp"

namespace tegl::gen {

/// Builds the regions of every signature of the k-cube, k = 1, 2, 3.
class RegionBuilder : public SignatureRegions {
 public:
  /// Builds k-tiles of `lattice`, which must outlive this object.
  RegionBuilder(const Lattice& lattice, int k, Alternative alternative, Triangulation triangulation, RegionStyle style);
};

}  // namespace tegl::gen
