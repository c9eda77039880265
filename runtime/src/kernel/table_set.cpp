// SPDX-License-Identifier: BSD-3-Clause
//
// Selects the generated tables for an extraction's options.
#include "kernel/table_set.hpp"

#include <optional>

#include "ambiguity/face_estimator.hpp"
#include "tegl/generated/tables.hpp"
#include "tile/tesseract_fill.hpp"
#include "tile/variant_table.hpp"

namespace tegl::detail {

namespace {

/// Flat table, built once, as it takes 256 KiB in 4D. Null if the fast path cannot use the table.
template <int N, Triangulation T>
const RowTable* row_table() {
  static const auto table = [] {
    const tables::TileTable& tile = tables::tile_table(N, T);
    return RowTable::can_use(tile) ? std::make_optional<RowTable>(tile) : std::nullopt;
  }();
  return table ? &*table : nullptr;
}

}  // namespace

template <int N>
TableSet<N> generated_tables(const ExtractOptions& options) {
  using tile::Alternative;
  const Triangulation triangulation = options.triangulation;
  const Alternative alternative = options.ambiguity == Ambiguity::high ? Alternative::high : Alternative::low;
  TableSet<N> set;
  set.tile = &tables::tile_table(N, triangulation);
  set.rows = triangulation == Triangulation::barycentric ? row_table<N, Triangulation::barycentric>()
                                                         : row_table<N, Triangulation::compact>();
  set.compact = triangulation == Triangulation::compact;
  if constexpr (N == 4)
    if (is_estimated(options.ambiguity)) set.rows = &estimated_tesseracts(triangulation);
  if constexpr (N < 4)
    if (is_estimated(options.ambiguity)) {
      const VariantTable<N>& variants = variant_table<N>(triangulation);
      set.tile = &variants.tile();
      set.rows = &variants.rows();
      if (options.close) set.high_face = &tables::region_table(N - 1, triangulation, Alternative::high);
    }
  if (N == 4) set.cube = &tables::tile_table(3, triangulation);
  if (options.close) set.face = &tables::region_table(N - 1, triangulation, alternative);
  if (options.close && N == 4) {
    set.square = &tables::region_table(2, triangulation, alternative);
    if (is_estimated(options.ambiguity)) set.high_face = &tables::region_table(2, triangulation, Alternative::high);
  }
  return set;
}

template TableSet<2> generated_tables<2>(const ExtractOptions&);
template TableSet<3> generated_tables<3>(const ExtractOptions&);
template TableSet<4> generated_tables<4>(const ExtractOptions&);

}  // namespace tegl::detail
