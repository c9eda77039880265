// SPDX-License-Identifier: BSD-3-Clause
//
// Facets, symmetries and planes of the shapes of mesh cells, which the runtime uses to close contours at the borders of
// meshes and to fill 4D cells: certified, and as C++ text.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cells/cell.hpp"
#include "tegl/shape_contract.hpp"

namespace tegl::gen {

/// Owning counterpart of tables::ShapeTable, which documents the arrays.
struct ShapeTables {
  std::string name;  ///< of the shape
  std::vector<tables::CellFacet> facets = {};
  std::vector<std::uint8_t> symmetries = {};
  std::vector<tables::PlaneSides> planes = {};
};

/// The tables of all shapes in the order of tables::CellShape, certified.
[[nodiscard]] std::vector<ShapeTables> make_all_shape_tables();

/// Certifies tables of all shapes in the order of tables::CellShape. Each facet of the
/// lattice is listed once, with its shape; orientations of two facets cancel at their common face, and one orientation
/// is compared with the sign of a determinant.
/// Symmetries: all permutations of corners that map facets to facets. Planes: the signs of all determinants of five
/// corners. Errors: CertificateFailed.
void certify_shape_tables(std::span<const ShapeTables> all);

/// The arrays of the tables as C++, within namespace tegl::tables.
[[nodiscard]] std::string shape_arrays(const std::vector<ShapeTables>& all);
/// The definition of tables::shape_table.
[[nodiscard]] std::string shape_function(const std::vector<ShapeTables>& all);
/// Elements of a JSON array: counts and digests.
[[nodiscard]] std::string shape_manifest(const std::vector<ShapeTables>& all);

}  // namespace tegl::gen
