// SPDX-License-Identifier: BSD-3-Clause
//
// Declares the generated tables, by name and by dimension. `gen` writes their definitions into the build tree.
#pragma once

#include "tegl/table_contract.hpp"
#include "tegl/tile/choices.hpp"
#include "tegl/tile/triangulation.hpp"

namespace tegl::tables {

extern const TileTable kTile2Barycentric, kTile2Compact;
extern const TileTable kTile3Barycentric, kTile3Compact;
extern const TileTable kTile4Barycentric, kTile4Compact;

/// The cube with every ambiguous square resolved independently.
extern const ResolvedTable kTile3Resolved;

extern const RegionTable kRegion1BarycentricLow, kRegion1BarycentricHigh, kRegion1CompactLow, kRegion1CompactHigh;
extern const RegionTable kRegion2BarycentricLow, kRegion2BarycentricHigh, kRegion2CompactLow, kRegion2CompactHigh;
extern const RegionTable kRegion3BarycentricLow, kRegion3BarycentricHigh, kRegion3CompactLow, kRegion3CompactHigh;

/// The table of the dim-tile's contours, dim = 2, 3, 4.
const TileTable& tile_table(int dim, Triangulation triangulation) noexcept;

/// The table of the k-tile's high regions, k = 1, 2, 3.
const RegionTable& region_table(int k, Triangulation triangulation, tile::Alternative alternative) noexcept;

}  // namespace tegl::tables
