// SPDX-License-Identifier: BSD-3-Clause
//
// The generated tables by dimension.
#include "tegl/generated/tables.hpp"

#include <cstddef>

namespace tegl::tables {

const TileTable& tile_table(int dim, Triangulation triangulation) noexcept {
  static constexpr const TileTable* kTables[3][2] = {
      {&kTile2Barycentric, &kTile2Compact}, {&kTile3Barycentric, &kTile3Compact}, {&kTile4Barycentric, &kTile4Compact}};
  return *kTables[dim - 2][static_cast<std::size_t>(triangulation)];
}

const RowTable* row_table(int dim, Triangulation triangulation) noexcept {
  static constexpr const RowTable* kTables[3][2] = {{&kTile2BarycentricRows, &kTile2CompactRows},
                                                    {&kTile3BarycentricRows, &kTile3CompactRows},
                                                    {nullptr, &kTile4CompactRows}};
  return kTables[dim - 2][static_cast<std::size_t>(triangulation)];
}

const VariantTable& variant_table(int dim, Triangulation triangulation) noexcept {
  static constexpr const VariantTable* kTables[2][2] = {{&kTile2BarycentricVariants, &kTile2CompactVariants},
                                                        {&kTile3BarycentricVariants, &kTile3CompactVariants}};
  return *kTables[dim - 2][static_cast<std::size_t>(triangulation)];
}

const RegionTable& region_table(int k, Triangulation triangulation, tile::Alternative alternative) noexcept {
  static constexpr const RegionTable* kTables[3][2][2] = {
      {{&kRegion1BarycentricLow, &kRegion1BarycentricHigh}, {&kRegion1CompactLow, &kRegion1CompactHigh}},
      {{&kRegion2BarycentricLow, &kRegion2BarycentricHigh}, {&kRegion2CompactLow, &kRegion2CompactHigh}},
      {{&kRegion3BarycentricLow, &kRegion3BarycentricHigh}, {&kRegion3CompactLow, &kRegion3CompactHigh}}};
  return *kTables[k - 1][static_cast<std::size_t>(triangulation)][static_cast<std::size_t>(alternative)];
}

}  // namespace tegl::tables
