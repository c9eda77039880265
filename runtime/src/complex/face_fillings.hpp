// SPDX-License-Identifier: BSD-3-Clause
//
// Compact contours in the 3D faces of 4D cells. The two cells at a face number its corners in different ways, so the
// diagonals of its polygons are chosen by the numbers of the points.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/cell_contract.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// All ways to draw the contour in a 3D shape by triangles between points on edges, with no side but the contour's own
/// in the shape's boundary: fans of each polygon; in a hexahedron, the cube's table in each of the 48 frames. In the
/// frame that begins at the smallest number and has its axes in ascending order, neighbouring cubes of a grid agree
/// with the contour of an image.
class FaceFillings {
 public:
  /// Three edges of the shape, oriented as in the shape's table.
  using Triangle = std::array<std::uint8_t, 3>;

  FaceFillings(tables::CellShape shape, bool high_connected);

  /// The number of the filling for corners with these numbers: polygons are fans from their point on the smallest edge
  /// of those allowed, hexahedra have the frame of the smallest number.
  [[nodiscard]] std::uint8_t choose(unsigned signature, const Index* corners) const noexcept;
  /// The number of the filling of the shape's own table.
  [[nodiscard]] std::uint8_t own(unsigned signature) const noexcept { return cases_[signature].own; }
  [[nodiscard]] std::span<const Triangle> triangles(unsigned signature, std::uint8_t filling) const noexcept {
    return cases_[signature].fillings[filling];
  }

 private:
  using Triangles = std::vector<Triangle>;
  /// A polygon that can be drawn in several ways.
  struct Polygon {
    std::vector<std::uint8_t> apexes;   ///< edges that fans may start from
    std::vector<std::uint8_t> choices;  ///< by apex: the fan's number; fans with equal triangles have one number
    std::uint8_t weight;                ///< of its choice in the number of the filling
  };
  /// A signature.
  struct Case {
    std::vector<Triangles> fillings;
    std::vector<Polygon> polygons;        ///< not of hexahedra
    std::vector<std::uint8_t> of_frames;  ///< of hexahedra: number of the filling by frame
    std::uint8_t own = 0;
  };

  void add_fans(const Triangles& table, Case& to) const;
  void add_frames(unsigned signature, bool high_connected, Case& to) const;
  [[nodiscard]] Triangles of_table(unsigned signature, bool high_connected) const;
  [[nodiscard]] bool share_a_polygon(unsigned edge, unsigned other) const noexcept;

  tables::CellShape shape_;
  const tables::CellTable& table_;
  std::vector<std::uint8_t> polygons_;  ///< corners of the shape's 2-faces, as bits
  std::vector<Case> cases_;             ///< by signature
};

}  // namespace tegl::detail
