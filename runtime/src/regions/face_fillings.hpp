// SPDX-License-Identifier: BSD-3-Clause
//
// Compact contours in the 3D faces of 4D cells. The two cells at a face number its corners in different ways, so the
// diagonals of its polygons are chosen by the numbers of the points.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "tegl/contour.hpp"
#include "tegl/generated/cells.hpp"

namespace tegl::detail {

/// All ways to draw the contour in a 3D shape by triangles between points on edges, with no side but the contour's own
/// in the shape's boundary: fans of each polygon; in a hexahedron, the cube's table in each of the 48 frames. In the
/// frame that begins at the smallest number and has its axes in ascending order, neighbouring cubes of a grid agree
/// with the contour of an image.
class FaceFillings {
 public:
  /// Three edges of the shape, oriented as in the shape's table.
  using Triangle = std::array<std::uint8_t, 3>;

  /// `shape`: of three dimensions.
  FaceFillings(tables::CellShape shape, bool high_connected)
      : fillings_(*tables::face_filling_table(shape, high_connected)),
        table_(tables::cell_table(shape, Triangulation::compact)) {}

  /// The number of the filling for corners with these numbers: polygons are fans from their point on the smallest edge
  /// of those allowed, hexahedra have the frame of the smallest number.
  [[nodiscard]] std::uint8_t choose(unsigned signature, const Index* corners) const noexcept;
  /// The number of the filling of the shape's own table.
  [[nodiscard]] std::uint8_t own(unsigned signature) const noexcept { return fillings_.cases[signature].own; }
  [[nodiscard]] std::span<const Triangle> triangles(unsigned signature, std::uint8_t filling) const noexcept {
    const tables::FaceFilling& of = fillings_.fillings[fillings_.cases[signature].first_filling + filling];
    return {fillings_.triangles + of.first_triangle, of.triangles};
  }

 private:
  const tables::FaceFillingTable& fillings_;
  const tables::CellTable& table_;
};

}  // namespace tegl::detail
