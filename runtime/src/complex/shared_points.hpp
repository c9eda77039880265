// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of the barycentres in 3-faces of 4D cells, which the cells on both sides of a face share.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "complex/crossings.hpp"

namespace tegl::detail {

/// A barycentre by the vertices of its polygon: ascending numbers, unused entries at the end kNoPoint. The polygons of
/// a complex have different vertices, whatever the numbering of the cells that they are in.
using PolygonKey = std::array<Index, 12>;
inline constexpr Index kNoPoint = ~Index{0}, kInCube = kNoPoint - 1, kInFacet = kNoPoint - 2;

/// A vertex of the contour's own in a hexahedron between two cells, as in a cube of images.
struct CubePoint {
  std::array<Index, 8> corners;
  std::uint32_t mask;  ///< corners (bit v) and edges (bit 8 + e) of the cube of images
  Index number;        ///< in SharedPoints
};

/// The key of a vertex in a hexahedron, the same for all cells that have it: a crossed edge, the ends of the diagonal
/// from the smallest point, and the mask in the frame of the points' numbers. `crossing`: the smallest number of a
/// vertex on the hexahedron's edges.
[[nodiscard]] PolygonKey key_of(const CubePoint& point, Index crossing) noexcept;

/// The barycentre of a loop in a facet of prisms over polyhedra, which may have more vertices than a PolygonKey.
struct LoopPoint {
  std::vector<Index> vertices;  ///< ascending numbers
  Index number;                 ///< in SharedPoints
};
/// Its key: the smallest vertex and the facet (key_of_facet). A facet has no two loops with a common vertex.
[[nodiscard]] PolygonKey key_of_loop(Index smallest, const std::array<Index, 4>& facet) noexcept;

/// The shared vertices of a contour, ordered by their keys: barycentres, and vertices in cubes. The key of the latter
/// names the cube and the mask; its last entry is kInCube. The last entry of a loop's key is kInFacet.
struct SharedPoints {
  std::vector<PolygonKey> keys;
  std::vector<CubePoint> in_cubes;
  std::vector<LoopPoint> loops;
  std::vector<Index> numbers;  ///< into `keys`, by shared vertex, counted in each cell; vertices in polytopes come last
};

/// What vertices of a contour are known by: the first ones, on edges and in common 3-faces, and vertices of its caps at
/// points.
struct VertexKeys {
  std::vector<EdgeEnds> edges = {};       ///< by the ends
  std::vector<PolygonKey> polygons = {};  ///< by the vertices of the polygon
  std::size_t before_caps = 0;            ///< number of vertices before the caps' vertices
  std::vector<Index> corners = {};        ///< the points at which the first vertices of the caps are
};

/// Numbers the shared barycentres of all active cells. Errors: TooLarge, Cancelled.
[[nodiscard]] SharedPoints number_shared_points(const CellGroups& cells, const CellTables& tables,
                                                const std::vector<ActiveBlock>& blocks,
                                                const std::vector<PolytopeBlock>& polytopes,
                                                const CrossingNumbers& crossings, const WorkOptions& work);

}  // namespace tegl::detail
