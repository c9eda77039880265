// SPDX-License-Identifier: BSD-3-Clause
//
// All compact contours in the 3D faces of 4D cells.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_tables.hpp"
#include "tegl/face_filling_contract.hpp"

namespace tegl::gen {

/// Owning counterpart of tables::FaceFillingTable, which documents the arrays.
struct FaceFillings {
  std::string name;  ///< of the shape
  bool high_connected = false;
  std::vector<tables::FillingCase> cases = {};
  std::vector<tables::FaceFilling> fillings = {};
  std::vector<std::array<std::uint8_t, 3>> triangles = {};
  std::vector<tables::FillingPolygon> polygons = {};
  std::vector<tables::FillingApex> apexes = {};
  std::vector<std::array<std::uint8_t, tables::kCubeFrames>> of_frames = {};
};

/// All fillings of a 3D shape, from its compact table: fans of each polygon; in a hexahedron, the cube's table in each
/// of the 48 frames. Certified (certify_face_fillings). Errors: CertificateFailed; Internal for a table with added
/// vertices.
[[nodiscard]] FaceFillings make_face_fillings(const CellTables& compact, bool high_connected);

/// Every filling of a signature has the boundary of the table's own contour, as many triangles, and no other side in a
/// face of the shape; no two are equal. Every frame and every choice of apexes has a number of a filling. Errors:
/// CertificateFailed, with shape, signature and fault.
void certify_face_fillings(const CellTables& compact, const FaceFillings& fillings);

/// The fillings of both alternatives of all 3D shapes among the tables.
[[nodiscard]] std::vector<FaceFillings> make_all_face_fillings(std::span<const CellTables> tables);

/// Arrays as C++ text, for an anonymous namespace.
[[nodiscard]] std::string face_filling_arrays(const std::vector<FaceFillings>& all);
/// The definition of tables::face_filling_table.
[[nodiscard]] std::string face_filling_function(const std::vector<FaceFillings>& all);
/// Elements of a JSON array: counts and digest of each table.
[[nodiscard]] std::string face_filling_manifest(const std::vector<FaceFillings>& all);

}  // namespace tegl::gen
