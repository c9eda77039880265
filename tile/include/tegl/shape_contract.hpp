// SPDX-License-Identifier: BSD-3-Clause
//
// The layout of the tables of shapes of mesh cells, which the generator emits: facets, symmetries, and on which sides
// of the hyperplanes through their corners the other corners are. They do not depend on signatures.
#pragma once

#include <array>
#include <cstdint>

#include "tegl/cell_contract.hpp"

namespace tegl::tables {

/// A facet of a shape: an edge, a polygon or a 3D cell.
struct CellFacet {
  CellShape shape;                      ///< of polygons and 3D cells; `triangle` for an edge, which has 2 corners
  std::uint8_t corner_count;            ///< number of corners
  std::array<std::uint8_t, 8> corners;  ///< of the cell, ascending: in the facet's own order
  /// Whether the facet's own orientation, followed by a direction into the cell, is not that of the cell's reference
  /// corners. An edge is oriented from its first corner to the second.
  bool is_inverted;
};

/// The corners on either side of a hyperplane. Corners in it have no bit.
struct PlaneSides {
  std::uint16_t above;  ///< bits of corners
  std::uint16_t below;  ///< bits of corners
};

/// A shape without contours.
struct ShapeTable {
  std::uint8_t facet_count;     ///< number of facets
  std::uint8_t symmetry_count;  ///< 3D: number of symmetries; otherwise 0
  std::uint16_t plane_count;    ///< 4D: number of hyperplanes; otherwise 0
  const CellFacet* facets;      ///< the facets
  /// 3D: symmetry x (corners, edges): the images of corners, then those of edges. Symmetries are sorted by the images
  /// of corners; the identity is the first. Otherwise null.
  const std::uint8_t* symmetries;
  /// 4D: all hyperplanes through four corners, ascending; which side is `above` does not matter, above < below.
  /// Otherwise null.
  const PlaneSides* planes;
};

}  // namespace tegl::tables
