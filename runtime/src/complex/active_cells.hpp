// SPDX-License-Identifier: BSD-3-Clause
//
// The active cells of a complex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "complex/cell_cases.hpp"
#include "complex/complex_edges.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Bits of the points of a complex: bit p % 32 of word p / 32.
struct PointBits {
  std::vector<std::uint32_t> high;     ///< value >= isovalue
  std::vector<std::uint32_t> missing;  ///< NaN; empty if no value is missing

  [[nodiscard]] static bool at(const std::vector<std::uint32_t>& bits, Index p) noexcept {
    return (bits[p >> 5] >> (p & 31u) & 1u) != 0;
  }
  [[nodiscard]] bool is_high(Index p) const noexcept { return at(high, p); }
  [[nodiscard]] bool is_missing(Index p) const noexcept { return !missing.empty() && at(missing, p); }
};

/// A cell with both high and low corners and no missing one.
struct ActiveCell {
  Index cell;               ///< in its group
  std::uint16_t signature;  ///< bit v: corner v is high
  std::uint32_t variant;    ///< CellCases::of
};

/// The active cells among consecutive cells of one group, and the sizes of their contours.
struct ActiveBlock {
  std::size_t group = 0;
  std::vector<ActiveCell> cells;
  std::vector<Index> missing;   ///< cells with missing corners
  std::vector<CellKey> keys;    ///< of cells whose contours are built, until their contours are built
  std::uint64_t crossings = 0;  ///< crossed edges, counted in each cell
  std::uint64_t simplices = 0;
  std::uint64_t shared = 0;  ///< vertices in common 3-faces, counted in each cell
  std::uint64_t own = 0;     ///< vertices of the cells' own
};

/// Which contours cells have.
struct CellTables {
  std::vector<CellCases> of_group;
};

/// Compares all values with the isovalue.
[[nodiscard]] PointBits classify_points(std::span<const double> values, double isovalue, const WorkOptions& work);

/// The active cells in blocks that do not depend on the number of threads. `edges`: null if not known; otherwise blocks
/// of cells without active ones are passed over. `values`: of the points, for cells that are resolved from them.
/// Errors: Cancelled.
[[nodiscard]] std::vector<ActiveBlock> find_active_cells(const CellGroups& cells, const CellTables& tables,
                                                         const PointBits& bits, const ComplexEdges* edges,
                                                         std::span<const double> values, const WorkOptions& work);

/// The active ones of `active` (ascending numbers: by group, then by cell), in the same kind of blocks. There must be
/// no missing values.
[[nodiscard]] std::vector<ActiveBlock> blocks_of_cells(const CellGroups& cells, const CellTables& tables,
                                                       std::span<const Index> active, std::span<const double> values,
                                                       double isovalue, const WorkOptions& work);

}  // namespace tegl::detail
