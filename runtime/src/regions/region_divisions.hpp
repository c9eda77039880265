// SPDX-License-Identifier: BSD-3-Clause
//
// Divides the regions of 3D shapes, which close 4D contours, into tetrahedra that do not overlap, by emitted tables.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "tegl/generated/tables.hpp"
#include "tegl/region_boundary.hpp"

namespace tegl::detail {

/// The high part of a shape, divided.
struct RegionDivision {
  using Triangle = RegionTriangle;

  /// The first vertex sees the others as the boundary's triangles are seen from inside.
  std::vector<RegionTetrahedron> tetrahedra;
  /// The corners (bit v) and points (bit kFirstEdge + e) whose mean a vertex from kFirstOwn on is.
  std::vector<std::uint32_t> own;
  /// A vertex from kFirstOwn on that is not a mean, but lies between a corner and the mean, so near to the corner that
  /// it sees all of these triangles.
  struct Near {
    std::uint8_t own, corner;
    std::vector<Triangle> seen;
  };
  std::vector<Near> near;
  /// Where such a vertex is on the way from the corner (0) to the mean (1).
  [[nodiscard]] double weight(const Near& of, const ShapePlaces& places) const noexcept;
  /// Whether no tetrahedra overlap, wherever the points are on their edges.
  bool is_proved = true;
};

/// The divisions of all regions that have occurred.
class RegionDivisions {
 public:
  /// `triangulation`, `alternative`: of the contours in the shapes.
  RegionDivisions(Triangulation triangulation, tile::Alternative alternative)
      : cube_(tables::region_table(3, triangulation, alternative)) {}

  /// The division of the high part of a shape with this boundary, whose triangles face outwards. It has the boundary's
  /// triangles. The division depends only on the boundary.
  [[nodiscard]] const RegionDivision& of(tables::CellShape shape, RegionTriangles boundary);

 private:
  using Boundary = RegionTriangles;
  using Divisions = std::map<std::pair<tables::CellShape, Boundary>, RegionDivision>;

  [[nodiscard]] const RegionDivision& of_region(tables::CellShape shape, const Boundary& boundary);

  const tables::RegionTable& cube_;
  Divisions known_;    ///< of shapes
  Divisions regions_;  ///< of single regions
};

}  // namespace tegl::detail
