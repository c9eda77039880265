// SPDX-License-Identifier: BSD-3-Clause
//
// The shapes of mesh cells. None is typed by hand: each is a pyramid, a prism or a double pyramid over a
// smaller one, down to a point.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/lattice.hpp"
#include "tegl/cell_contract.hpp"
#include "tegl/tile/face_lattice.hpp"

namespace tegl::gen {

/// A cell of 2, 3 or 4 dimensions, with faces of any shapes.
struct Cell {
  std::string name;           ///< as in tables::CellShape
  Tile tile;                  ///< of kind `other`: corners, edges (pairs a < b, ascending), the corners of faces
  tile::FaceLattice lattice;  ///< all faces
};

/// All cells in the order of tables::CellShape.
[[nodiscard]] std::vector<Cell> mesh_cells();

/// The cell with a name as in tables::CellShape. Throws std::invalid_argument if there is none.
[[nodiscard]] Cell mesh_cell(std::string_view name);

/// Whether the cell is a cube, in the numbering of the table contract except for edges.
[[nodiscard]] bool is_cube(const Cell& cell);

}  // namespace tegl::gen
