// SPDX-License-Identifier: BSD-3-Clause
//
// Declares the generated tables, by name and by dimension. `gen` writes their definitions into the build tree.
#pragma once

#include <array>

#include "tegl/table_contract.hpp"
#include "tegl/tile/choices.hpp"
#include "tegl/tile/triangulation.hpp"

namespace tegl::tables {

extern const TileTable kTile2Barycentric, kTile2Compact;
extern const TileTable kTile3Barycentric, kTile3Compact;
extern const TileTable kTile4Barycentric, kTile4Compact;
/// Of the 4D tiles that do not depend on the data beyond their signature (kAmbiguous4), compact contours that do not
/// depend on which side is high; no simplices for the others.
extern const TileTable kTile4Balanced;

/// The cube with every ambiguous square resolved independently.
extern const ResolvedTable kTile3Resolved;

extern const RegionTable kRegion1BarycentricLow, kRegion1BarycentricHigh, kRegion1CompactLow, kRegion1CompactHigh;
extern const RegionTable kRegion2BarycentricLow, kRegion2BarycentricHigh, kRegion2CompactLow, kRegion2CompactHigh;
extern const RegionTable kRegion3BarycentricLow, kRegion3BarycentricHigh, kRegion3CompactLow, kRegion3CompactHigh;

/// Plain tables for loops over many tiles. The barycentric table of 4D tiles has no such form.
extern const RowTable kTile2BarycentricRows, kTile2CompactRows;
extern const RowTable kTile3BarycentricRows, kTile3CompactRows;
extern const RowTable kTile4CompactRows;
/// For estimated ambiguities: the tiles that the data may change are marked as having own vertices. These are all tiles
/// in the barycentric triangulation, and those of kAmbiguous4 in the compact one; the others are those of kTile4Balanced.
extern const RowTable kTile4EstimatedBarycentricRows, kTile4EstimatedCompactRows;

/// Squares and cubes with resolved ambiguities.
extern const VariantTable kTile2BarycentricVariants, kTile2CompactVariants;
extern const VariantTable kTile3BarycentricVariants, kTile3CompactVariants;

/// A set of 4D signatures as bits: with a byte for each it would not stay in the nearest cache.
struct SignatureSet4 {
  std::array<std::uint64_t, 65536 / 64> words;
  constexpr bool operator[](std::size_t signature) const noexcept {
    return (words[signature / 64] >> (signature % 64) & 1u) != 0;
  }
};

/// Whether a tile depends on the data beyond its signature: a square is ambiguous, or it may have several facets. By
/// signature. In 4D: if false, Sigma is empty or one sphere.
extern const std::array<bool, 256> kAmbiguous3;
extern const SignatureSet4 kAmbiguous4;

/// By entry of kTile3Resolved.
extern const std::array<CubeJoin, 656> kCubeJoins;

/// The table of the dim-tile's contours, dim = 2, 3, 4.
const TileTable& tile_table(int dim, Triangulation triangulation) noexcept;

/// The same table for loops over many tiles, or null.
const RowTable* row_table(int dim, Triangulation triangulation) noexcept;

/// Squares or cubes with resolved ambiguities, dim = 2, 3.
const VariantTable& variant_table(int dim, Triangulation triangulation) noexcept;

/// The table of the k-tile's high regions, k = 1, 2, 3.
const RegionTable& region_table(int k, Triangulation triangulation, tile::Alternative alternative) noexcept;

}  // namespace tegl::tables
