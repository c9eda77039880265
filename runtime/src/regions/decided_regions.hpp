// SPDX-License-Identifier: BSD-3-Clause
//
// Divides the high parts of 3D shapes in which the contour is decided from the data, and may have a tunnel.
#pragma once

#include <array>
#include <cstdint>

#include "regions/cube_frame.hpp"
#include "regions/region_divisions.hpp"
#include "tegl/tile/choices.hpp"

namespace tegl::detail {

/// The contour in a hexahedron that is decided: a list of the resolved cube (ResolvedCubes), as a frame sees it.
struct CubeContour {
  CubeFrame frame;
  std::uint16_t list;

  /// `frame`: its number. `signature`, `squares`: the high corners and the high ones of the ambiguous squares, in the
  /// hexahedron's own frame.
  CubeContour(unsigned frame, unsigned signature, unsigned squares, tile::Choice choice) noexcept;
};

/// Whether a list of the resolved cube has a tunnel.
[[nodiscard]] bool has_tunnel(unsigned list) noexcept;

/// The high part of a hexahedron, by the regions of the resolved cube. Barycentres and other own vertices of the list
/// have the numbers from ShapeVertices::kFirstCentre on, in the list's order. `sides`: the triangles in the
/// hexahedron's faces, facing outwards. Where the table has other diagonals there, two tetrahedra are exchanged for two
/// others, if they have a common vertex inside; otherwise the division has a new vertex and is not proved.
[[nodiscard]] RegionDivision divide_cube(const CubeContour& contour, Triangulation triangulation,
                                         const RegionTriangles& sides);

/// Corners of an octahedron around one of its axes, which has the corners 2 pair and 2 pair + 1.
[[nodiscard]] constexpr std::array<std::uint8_t, 4> corners_around(unsigned pair) noexcept {
  const auto b = static_cast<std::uint8_t>(2 * ((pair + 1) % 3)), c = static_cast<std::uint8_t>(2 * ((pair + 2) % 3));
  return {b, c, static_cast<std::uint8_t>(b + 1), static_cast<std::uint8_t>(c + 1)};
}

/// The high part of an octahedron in which a tunnel connects two opposite corners, which alone are high or low. The
/// tunnel is a ring of four quadrilaterals, coned from their barycentres: number i, from ShapeVertices::kFirstCentre
/// on, is between the corners i and i + 1 around the axis (corners_around). A barycentre is inside the tetrahedron of
/// these two corners and the axis, so it sees the sides of the high part of this tetrahedron, for all positions.
[[nodiscard]] RegionDivision divide_around_tunnel(unsigned pair, bool is_high, const RegionTriangles& sides);

}  // namespace tegl::detail
