// SPDX-License-Identifier: BSD-3-Clause
//
// The generated tables of mesh cells.
#pragma once

#include "tegl/cell_contract.hpp"
#include "tegl/face_filling_contract.hpp"
#include "tegl/region_contract.hpp"
#include "tegl/shape_contract.hpp"

namespace tegl::tables {

/// The table of a cell's contours. 4-cells have barycentric contours only: both triangulations give the same table.
const CellTable& cell_table(CellShape shape, Triangulation triangulation) noexcept;

/// All compact contours of a 3D shape in the faces of 4-cells; null for other shapes.
const FaceFillingTable* face_filling_table(CellShape shape, bool high_connected) noexcept;

/// Facets, symmetries and planes of a shape.
const ShapeTable& shape_table(CellShape shape) noexcept;

/// The divisions of the high parts of a 3D shape; null for other shapes.
const RegionDivisionTable* region_division_table(CellShape shape) noexcept;

}  // namespace tegl::tables
