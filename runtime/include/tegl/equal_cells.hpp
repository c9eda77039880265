// SPDX-License-Identifier: BSD-3-Clause
//
// Cells that a mesh has twice.
#pragma once

#include <cstddef>
#include <optional>

#include "tegl/complex.hpp"

namespace tegl {

/// Two cells with the same corners, by their numbers from 0.
struct EqualCells {
  std::size_t first = 0;   ///< the smaller number
  std::size_t second = 0;  ///< the larger number
};

/// Finds two cells with the same points as corners, in any order: a complex with them has a contour that is no manifold
/// there. The constructors of Complex do not look for them, as this takes about a fifth of their time; the readers of
/// files and Python do. Of several pairs, the one with the smallest second cell, then with the smallest first. `cells`:
/// as for Complex, where they have been checked; `ends` may be empty without polygons, polyhedra and polytopes. Errors:
/// InvalidArgument for an unknown type, if `ends` is empty. O(C) time, unless one point is in most of the cells: then
/// O(C log C). At most 48 bytes for each cell until it returns, and the corners of cells that are given by faces alone.
[[nodiscard]] std::optional<EqualCells> find_equal_cells(const CellLists& cells);

}  // namespace tegl
