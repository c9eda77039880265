// SPDX-License-Identifier: BSD-3-Clause
//
// Boundaries of regions in 3D shapes of mesh cells, as oriented triangles between the vertices of ShapeVertices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/shape_places.hpp"

namespace tegl::detail {

using RegionTriangle = std::array<std::uint8_t, 3>;     ///< three vertices
using RegionTriangles = std::vector<RegionTriangle>;    ///< sorted: each starts at its smallest vertex, and they ascend
using RegionTetrahedron = std::array<std::uint8_t, 4>;  ///< four vertices

/// The same triangle, starting at its smallest vertex.
[[nodiscard]] RegionTriangle from_smallest(RegionTriangle t) noexcept;
/// The triangles of a tetrahedron. Each faces outwards if the first one, opposite to the first vertex, does.
[[nodiscard]] std::array<RegionTriangle, 4> faces_of(const RegionTetrahedron& t) noexcept;
/// Sorts triangles in any order.
void sort_boundary(RegionTriangles& triangles);
/// Adds an oriented triangle to a sorted boundary, where it may cancel another one.
void add_to_boundary(RegionTriangles& boundary, const RegionTriangle& triangle);
/// The vertices of triangles as bits.
[[nodiscard]] std::uint64_t vertices_of(const RegionTriangles& triangles) noexcept;
/// The edges (kFirstEdge + e) of a boundary's triangles at a vertex.
[[nodiscard]] std::vector<std::uint8_t> edges_around(const RegionTriangles& boundary, unsigned vertex);
/// The boundaries of the regions: its connected parts.
[[nodiscard]] std::vector<RegionTriangles> split_regions(const RegionTriangles& boundary);

/// Where a symmetry of a shape moves each vertex.
using RegionMap = std::array<std::uint8_t, ShapeVertices::kEnd>;
/// Of the images of a boundary under all symmetries of its shape, the first one, and how it is reached. `symmetries`:
/// as ShapeTable::symmetries. Barycentres are numbered by the first of their edges.
[[nodiscard]] RegionTriangles representative_of(const RegionTriangles& boundary, const tables::CellTable& shape,
                                                std::span<const std::uint8_t> symmetries, RegionMap& map);

}  // namespace tegl::detail
