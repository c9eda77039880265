// SPDX-License-Identifier: BSD-3-Clause
//
// The cells of staggered lattices by numbers of samples.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "tegl/complex.hpp"
#include "tegl/lattice.hpp"

namespace tegl::detail {

/// Cells of a lattice: their types, and the corners of all cells one after the other.
struct LatticeCells {
  std::vector<CellType> types;
  std::vector<Index> corners;
};

/// The cells of `lattice` (not fcc_in_time) over an array of these sizes, axis 0 fastest.
[[nodiscard]] LatticeCells cells_of_lattice(Lattice lattice, const std::array<std::size_t, 4>& sizes);

}  // namespace tegl::detail
