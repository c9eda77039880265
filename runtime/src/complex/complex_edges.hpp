// SPDX-License-Identifier: BSD-3-Clause
//
// The edges of a complex.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "complex/cell_groups.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// The ends of an edge: the smaller number of a point first.
using EdgeEnds = std::array<Index, 2>;

/// All edges of a complex, and those of each cell.
struct ComplexEdges {
  std::vector<EdgeEnds> ends;                ///< ascending, without duplicates
  std::vector<std::vector<Index>> of_cells;  ///< by group: #cells x (edges of the shape), numbers of edges
};

/// Finds the edges. Buckets by the smaller end; each is sorted by itself, so all passes except the first run on all
/// threads. Errors: TooLarge (2^32 edges or more), Cancelled.
[[nodiscard]] ComplexEdges find_complex_edges(std::size_t points, const CellGroups& cells, const WorkOptions& work);

}  // namespace tegl::detail
