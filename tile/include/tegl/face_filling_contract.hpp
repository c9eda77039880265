// SPDX-License-Identifier: BSD-3-Clause
//
// The layout of the tables of compact contours in the 3D faces of 4D cells, which the generator emits. Two cells at a
// face number its corners in different ways, so each face has a table of all ways to draw the contour in it by
// triangles between points on edges, with no side but the contour's own in the face's boundary.
#pragma once

#include <array>
#include <cstdint>

#include "tegl/cell_contract.hpp"

namespace tegl::tables {

/// One way to draw the contour of a signature: triangles of three edges of the shape, oriented as in the shape's table.
struct FaceFilling {
  std::uint16_t first_triangle;  ///< index into FaceFillingTable::triangles
  std::uint8_t triangles;        ///< number of triangles
};

/// A polygon of a signature that can be drawn in several ways, as fans.
struct FillingPolygon {
  std::uint16_t first_apex;  ///< index into FaceFillingTable::apexes
  std::uint8_t apexes;       ///< number of edges that fans may start from
  std::uint8_t weight;       ///< factor of its choice in the number of the filling
};

/// An edge that a fan may start from.
struct FillingApex {
  std::uint8_t edge;    ///< of the shape
  std::uint8_t choice;  ///< the fan's number; fans with equal triangles have one number
};

/// The fillings of one signature. Filling number i is FaceFillingTable::fillings[first_filling + i].
struct FillingCase {
  std::uint16_t first_filling;  ///< index into FaceFillingTable::fillings
  std::uint8_t fillings;        ///< number of fillings
  std::uint8_t own;             ///< number of the filling of the shape's own compact table
  std::uint16_t first_polygon;  ///< index into FaceFillingTable::polygons
  std::uint8_t polygons;        ///< the filling's number is the sum of their choices times weights; 0 for hexahedra
};

/// Number of ways to number the corners of a cube along its axes. Frame 6 v + i begins at corner v and has the i-th
/// permutation of the axes, in lexicographic order.
inline constexpr unsigned kCubeFrames = 48;

/// All fillings of a 3D shape, for one alternative.
struct FaceFillingTable {
  const FillingCase* cases;                                ///< by signature
  const FaceFilling* fillings;                             ///< by case
  const std::array<std::uint8_t, 3>* triangles;            ///< by filling
  const FillingPolygon* polygons;                          ///< by case; null for hexahedra
  const FillingApex* apexes;                               ///< by polygon; null for hexahedra
  const std::array<std::uint8_t, kCubeFrames>* of_frames;  ///< hexahedra, by signature: number of the filling; or null
};

}  // namespace tegl::tables
