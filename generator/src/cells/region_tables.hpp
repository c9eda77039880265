// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of regions: the high parts of the 3D facets of 4D cells, divided into tetrahedra. The runtime closes contours
// of 4D meshes with them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cells/cell.hpp"
#include "cells/cell_tables.hpp"
#include "cells/face_fillings.hpp"
#include "cells/region_search.hpp"
#include "cells/shape_tables.hpp"
#include "tegl/region_contract.hpp"

namespace tegl::gen {

/// Owning counterpart of tables::RegionDivisionTable, which documents the arrays, with counts.
struct CapTables {
  std::string name;  ///< of the shape
  std::vector<tables::RegionRecord> records = {};
  std::vector<RegionTriangle> triangles = {};
  std::vector<RegionTetrahedron> tetrahedra = {};
  std::vector<std::uint32_t> own = {};
  std::vector<tables::NearVertex> near = {};
  std::uint64_t boundaries = 0;  ///< different ones of the high parts of shapes
  /// Regions up to symmetry without a division that is proved; they have no record.
  std::vector<RegionTriangles> unproved = {};
};

/// The different boundaries, sorted, of the high parts of a 3D shape as a facet: for all signatures, with both ways to
/// join the high corners of each ambiguous quadrilateral, all fans in the polygons, and, in each polygon of the
/// contour, a barycentre or one of the compact `fillings` by low and high.
[[nodiscard]] std::vector<RegionTriangles> list_boundaries(const Cell& cell, const ShapeTables& shape,
                                                           std::span<const FaceFillings> fillings);
/// Divides and certifies all regions with these boundaries. Errors: CertificateFailed; std::logic_error if an offset or
/// a count does not fit into its record.
[[nodiscard]] CapTables make_region_tables(const Cell& cell, const ShapeTables& shape,
                                           std::span<const FaceFillings> fillings);
/// The tables of all 3D shapes in the order of tables::CellShape.
[[nodiscard]] std::vector<CapTables> make_all_region_tables(std::span<const ShapeTables> shapes,
                                                            std::span<const FaceFillings> fillings);

/// Certifies each record: its boundary is closed and connected and precedes the next one, the oriented boundaries of
/// its tetrahedra add up to it, and each tetrahedron is positive for all positions of the points on their edges. Own
/// vertices are the means of their points or, near a corner, any points near enough to the corner. Errors:
/// CertificateFailed.
void certify_region_tables(const Cell& cell, const CapTables& tables);

/// The arrays of the tables as C++, within namespace tegl::tables.
[[nodiscard]] std::string region_arrays(const std::vector<CapTables>& all);
/// The definition of tables::region_division_table.
[[nodiscard]] std::string region_function(const std::vector<CapTables>& all);
/// Elements of a JSON array: counts and digests.
[[nodiscard]] std::string region_manifest(const std::vector<CapTables>& all);

}  // namespace tegl::gen
