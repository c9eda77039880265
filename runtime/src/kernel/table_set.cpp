// SPDX-License-Identifier: BSD-3-Clause
//
// Selects the generated tables for an extraction's options.
#include "kernel/table_set.hpp"

#include "ambiguity/face_estimator.hpp"
#include "tegl/generated/tables.hpp"
#include "tile/variant_table.hpp"

namespace tegl::detail {

template <int N>
TableSet<N> generated_tables(const ExtractOptions& options) {
  using tile::Alternative;
  const Triangulation triangulation = options.triangulation;
  const Alternative alternative = options.ambiguity == Ambiguity::high ? Alternative::high : Alternative::low;
  TableSet<N> set;
  set.tile = &tables::tile_table(N, triangulation);
  set.rows = tables::row_table(N, triangulation);
  set.compact = triangulation == Triangulation::compact;
  set.max_simplices = set.tile->max_simplices;
  set.max_tile_vertices = set.tile->max_tile_vertices;
  if constexpr (N == 4)
    if (is_estimated(options.ambiguity)) {
      set.rows = set.compact ? &tables::kTile4EstimatedCompactRows : &tables::kTile4EstimatedBarycentricRows;
      if (set.compact) set.tile = &tables::kTile4Balanced;
    }
  if constexpr (N < 4)
    if (is_estimated(options.ambiguity)) {
      const tables::VariantTable& variants = variant_table<N>(triangulation);
      set.tile = &variants.tile;
      set.max_simplices = set.tile->max_simplices;
      set.max_tile_vertices = set.tile->max_tile_vertices;
      set.rows = &variants.rows;
      if (options.close) set.high_face = &tables::region_table(N - 1, triangulation, Alternative::high);
    }
  if (N == 4) set.cube = &tables::tile_table(3, triangulation);
  if (options.close) set.face = &tables::region_table(N - 1, triangulation, alternative);
  return set;
}

template TableSet<2> generated_tables<2>(const ExtractOptions&);
template TableSet<3> generated_tables<3>(const ExtractOptions&);
template TableSet<4> generated_tables<4>(const ExtractOptions&);

}  // namespace tegl::detail
