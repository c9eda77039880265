// SPDX-License-Identifier: BSD-3-Clause
//
// The facets of cells, and those on the border of a complex: facets of one cell only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "complex/cell_groups.hpp"
#include "tegl/generated/cells.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

using tables::CellFacet;

/// The facets of a shape.
[[nodiscard]] inline std::span<const CellFacet> facets_of(tables::CellShape shape) noexcept {
  const tables::ShapeTable& table = tables::shape_table(shape);
  return {table.facets, table.facet_count};
}

/// The points of a facet of a polygon (its edge) or polyhedron (around the face), in the direction of its ring.
[[nodiscard]] std::vector<Index> facet_points(const Polytopes& polytopes, std::size_t cell, std::size_t facet);

/// A facet of a cell.
struct BorderFacet {
  std::uint32_t group;  ///< or the number of groups: of the polytopes
  Index cell;           ///< in its group
  std::uint16_t facet;  ///< number in facets_of, facet_points or facets_of_solid
};
using BorderFacets = std::vector<BorderFacet>;

/// The facets that belong to one cell only, by cell. O(F log f) time for F facets, at most f at a point; 24 bytes for
/// each facet in 3D, 40 in 4D. Errors: Cancelled.
[[nodiscard]] BorderFacets find_border(std::size_t points, const CellGroups& cells, const WorkOptions& work);

}  // namespace tegl::detail
