// SPDX-License-Identifier: BSD-3-Clause
//
// The tables that an extraction uses.
#pragma once

#include "tegl/extract.hpp"
#include "tegl/table_contract.hpp"
#include "tile/row_table.hpp"

namespace tegl::detail {

/// Tables of one extraction, all of one triangulation.
template <int N>
struct TableSet {
  const tables::TileTable* tile = nullptr;    ///< dimension N
  std::uint32_t max_simplices = 0;            ///< of a tile, as a table of the dimension has them
  std::uint32_t max_tile_vertices = 0;        ///< the same
  const RowTable* rows = nullptr;             ///< flat form of `tile` for the fast path, if available
  bool compact = false;                       ///< whether `tile` is of the compact triangulation
  const tables::TileTable* cube = nullptr;    ///< dimension 3; N = 4 only
  const tables::RegionTable* face = nullptr;  ///< dimension N - 1; for closed borders
  /// High-connected alternative of `face` (N < 4), if ambiguities are resolved from the data.
  const tables::RegionTable* high_face = nullptr;
};

/// Returns the generated tables for the given options.
template <int N>
TableSet<N> generated_tables(const ExtractOptions& options);

}  // namespace tegl::detail
