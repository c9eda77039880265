// SPDX-License-Identifier: BSD-3-Clause
//
// The generated tables of mesh cells.
#pragma once

#include "tegl/cell_contract.hpp"

namespace tegl::tables {

/// The table of a cell's contours. 4-cells have barycentric contours only: both triangulations give the same table.
const CellTable& cell_table(CellShape shape, Triangulation triangulation) noexcept;

}  // namespace tegl::tables
