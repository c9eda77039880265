// SPDX-License-Identifier: BSD-3-Clause
//
// The generated tables by dimension.
#include "tegl/generated/tables.hpp"

namespace tegl::tables {

const TileTable& tile_table(int dim, int triangulation) noexcept {
  static constexpr const TileTable* kTables[3][2] = {
      {&kTile2Barycentric, &kTile2Compact}, {&kTile3Barycentric, &kTile3Compact}, {&kTile4Barycentric, &kTile4Compact}};
  return *kTables[dim - 2][triangulation];
}

const RegionTable& region_table(int k, int triangulation, int alternative) noexcept {
  static constexpr const RegionTable* kTables[3][2][2] = {
      {{&kRegion1BarycentricLow, &kRegion1BarycentricHigh}, {&kRegion1CompactLow, &kRegion1CompactHigh}},
      {{&kRegion2BarycentricLow, &kRegion2BarycentricHigh}, {&kRegion2CompactLow, &kRegion2CompactHigh}},
      {{&kRegion3BarycentricLow, &kRegion3BarycentricHigh}, {&kRegion3CompactLow, &kRegion3CompactHigh}}};
  return *kTables[k - 1][triangulation][alternative];
}

}  // namespace tegl::tables
