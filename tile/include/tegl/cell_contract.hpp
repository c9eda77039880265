// SPDX-License-Identifier: BSD-3-Clause
//
// The layout of the tables of mesh cells that the generator emits and the runtime reads: triangles, tetrahedra, wedges
// and others, and their prisms over an interval of time. table_contract.hpp has the tables of the cells of images.
//
// Corners. Corner 0 is the origin. A pyramid over a base of m corners has the base's corners first, its apex last; a
// prism has the base's corners, then the same at the upper end: corner v + m is above corner v. A double pyramid has
// the base's corners, then the two apexes, so corners 2 a and 2 a + 1 of an octahedron and of a 16-cell are opposite.
// So a quadrilateral and a hexahedron have the numbering of cubes (bit i of v is coordinate i). A signature has bit v
// set iff corner v is high.
//
// Local vertices of simplices, one byte each:
//   [0, E)        the contour's point on edge e (CellTable::edges)
//   [E, ...)      added vertices of the list: first those in 3-faces of a 4-cell (shared with the cell on the other
//                 side), then the barycentres of the cell's own facets, then the side vertices
//
// Positions of added vertices. Vertex j has the mask CellTable::masks[first_mask + j]: bit v is corner v, bit
// corner_count + e is the point of edge e. A barycentre is the mean of the points of its mask. A side vertex is the
// midpoint of the cell's centre (the mean of all corners) and the mean of the corners and points of its mask. A collar
// vertex, which no emitted table has, is a quarter of the way from the mean to the centre. The mask of a vertex in a
// 3-face is the set of points of a polygon in that face, and identifies it: no two polygons of a cell have the same
// points.
//
// Orientation. The positive side of a simplex faces the high corners, if the cell's corners are oriented as the
// reference corners are: det[v_1 - v_0, ..., v_{n-1} - v_0, d] > 0 for a vector d towards high.
//
// Alternatives. Tables hold the low-connected alternative. The high-connected alternative of signature s is the
// low-connected one of ~s with reversed orientation.
#pragma once

#include <cstdint>

#include "tegl/tile/triangulation.hpp"

namespace tegl::tables {

/// Version of the layout below. Emitted tables carry it.
inline constexpr std::uint32_t kCellContractVersion = 1;

/// Shapes of mesh cells.
enum class CellShape : std::uint8_t {
  triangle,           ///< 2D
  quadrilateral,      ///< 2D
  tetrahedron,        ///< 3D
  wedge,              ///< 3D: triangle x interval
  pyramid,            ///< 3D: over a quadrilateral
  hexahedron,         ///< 3D: quadrilateral x interval
  simplex4,           ///< 4D: 5 corners
  tetrahedron_prism,  ///< 4D: tetrahedron x interval
  wedge_prism,        ///< 4D: wedge x interval
  pyramid_prism,      ///< 4D: pyramid x interval
  hexahedron_prism,   ///< 4D: hexahedron x interval
  octahedron,         ///< 3D: a double pyramid over a square
  octahedron_prism,   ///< 4D: octahedron x interval
  cell16,             ///< 4D: a double pyramid over an octahedron, the cross-polytope
};
/// Number of shapes.
inline constexpr unsigned kCellShapes = 14;

/// The contour of one signature.
struct CellList {
  std::uint32_t first_simplex;   ///< index into CellTable::simplices, in simplices (not bytes)
  std::uint32_t first_mask;      ///< index into CellTable::masks
  std::uint16_t simplex_count;   ///< number of simplices
  std::uint8_t shared_vertices;  ///< number of added vertices in 3-faces (4D)
  std::uint8_t cone_vertices;    ///< number of barycentres of the cell's own facets
  std::uint8_t side_vertices;    ///< number of side vertices
  std::uint8_t collar_vertices;  ///< number of collar vertices, the last ones; 0 in emitted tables

  /// Number of added vertices.
  [[nodiscard]] constexpr unsigned added() const noexcept {
    return unsigned{shared_vertices} + cone_vertices + side_vertices + collar_vertices;
  }
};

/// The contours of all signatures of a cell.
///
/// If element_of is null, list_of[s] is the list of signature s itself. Otherwise list_of[s] is the list of the
/// representative r of the class of s, and element_of[s] is the symmetry g with s = g(r): corner v of the list is
/// corner permutations[g * permutation_stride + v], edge e is edge permutations[g * permutation_stride + corner_count +
/// e], also in masks, and if reverses[g] is 1, the last two vertices of each simplex are exchanged.
struct CellTable {
  std::uint32_t version;             ///< kCellContractVersion
  std::uint32_t dim;                 ///< dimension n of the cell, 2, 3 or 4
  std::uint32_t corner_count;        ///< number of corners
  std::uint32_t edge_count;          ///< number of edges
  std::uint32_t max_simplices;       ///< maximum over all signatures
  std::uint32_t max_added;           ///< maximum number of added vertices over all signatures
  std::uint32_t permutation_stride;  ///< corner_count + edge_count, or 0
  const std::int8_t* corners;        ///< corner_count x dim reference coordinates
  const std::uint8_t* edges;         ///< edge_count x 2 corners
  const std::uint16_t* list_of;      ///< 2^corner_count list indices
  const std::uint16_t* element_of;   ///< 2^corner_count symmetries, or null
  const std::uint8_t* permutations;  ///< symmetries x permutation_stride, or null
  const std::uint8_t* reverses;      ///< by symmetry, or null
  const CellList* lists;             ///< the lists
  const std::uint8_t* simplices;     ///< x dim local vertices
  const std::uint64_t* masks;        ///< by added vertex
};

}  // namespace tegl::tables
