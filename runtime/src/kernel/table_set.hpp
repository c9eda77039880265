// SPDX-License-Identifier: BSD-3-Clause
//
// The tables that an extraction uses.
#pragma once

#include "tegl/extract.hpp"
#include "tegl/table_contract.hpp"
#include "tile/extract_rows.hpp"

namespace tegl::detail {

/// Tables that one extraction uses. All of one triangulation.
template <int N>
struct TableSet {
  const tables::TileTable* tile = nullptr;      ///< of N
  const RowTable* rows = nullptr;               ///< `tile` for the quick way, if it is at hand
  bool compact = false;                         ///< the compact triangulation
  const tables::TileTable* cube = nullptr;      ///< of 3; N = 4 only
  const tables::RegionTable* face = nullptr;    ///< of N - 1; for closed borders
  const tables::RegionTable* square = nullptr;  ///< of 2; N = 4, for closed borders
  /// `face` (N = 4: `square`) of the high-connected alternative, where data decide.
  const tables::RegionTable* high_face = nullptr;
};

/// The generated tables that the options ask for.
template <int N>
TableSet<N> generated_tables(const ExtractOptions& options);

}  // namespace tegl::detail
