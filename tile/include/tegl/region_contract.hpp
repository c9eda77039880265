// SPDX-License-Identifier: BSD-3-Clause
//
// The layout of the table of regions of 3D shapes, which the generator emits: the high parts of the facets of 4D cells,
// divided into tetrahedra that do not overlap, wherever the contour's points are on their edges. Vertices are those of
// detail::ShapeVertices (tegl/shape_places.hpp).
#pragma once

#include <cstdint>

namespace tegl::tables {

/// A vertex that is no mean, but lies between a corner and the mean of its points, so near to the corner that it sees
/// all of some triangles.
struct NearVertex {
  std::uint8_t own;          ///< the vertex, from ShapeVertices::kFirstOwn on
  std::uint8_t corner;       ///< the corner
  std::uint8_t seen;         ///< number of triangles that it sees
  std::uint32_t first_seen;  ///< index into RegionDivisionTable::triangles
};

/// The division of one region.
struct RegionRecord {
  std::uint32_t first_triangle;     ///< index into RegionDivisionTable::triangles
  std::uint32_t first_tetrahedron;  ///< index into RegionDivisionTable::tetrahedra
  std::uint16_t first_own;          ///< index into RegionDivisionTable::own
  std::uint16_t first_near;         ///< index into RegionDivisionTable::near
  std::uint8_t triangles;           ///< number of triangles of the boundary, ascending
  std::uint8_t tetrahedra;          ///< number of tetrahedra
  std::uint8_t own;                 ///< number of own vertices
  std::uint8_t near;                ///< number of own vertices near a corner
};

/// All regions of a shape that are proved, up to its symmetries.
struct RegionDivisionTable {
  std::uint32_t count;             ///< number of regions
  const RegionRecord* records;     ///< in ascending order of their triangles
  const std::uint8_t* triangles;   ///< x 3 vertices, oriented outwards, or all inwards
  const std::uint8_t* tetrahedra;  ///< x 4 vertices, with the boundary's triangles as boundary
  const std::uint32_t* own;        ///< bit v: corner v; bit 8 + e: edge e; an own vertex is their mean
  const NearVertex* near;          ///< by region
};

}  // namespace tegl::tables
