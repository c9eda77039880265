// SPDX-License-Identifier: BSD-3-Clause
//
// Pass 4 of the extraction: writes the vertices that a row's cubes own, in 4D.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "kernel/cell_vertices.hpp"
#include "kernel/extract_cell.hpp"
#include "kernel/extract_count.hpp"
#include "kernel/extract_edges.hpp"
#include "kernel/placement.hpp"
#include "kernel/shared_places.hpp"
#include "tile/extract_tables.hpp"

namespace tegl::detail {

/// Writes the barycentres of a row's cubes along `Axes`, unless tiles write them (TileWriter::writes_cubes). `view`:
/// the layers that contain the cubes.
template <unsigned Axes, class Real>
void generate_cubes(const EdgeCrossings<4>& source, const tables::TileTable& table, const Placement<4, Real>& placement,
                    const SlabView<4>& view, const CubePlane& plane, std::size_t row, std::size_t layer,
                    VertexRun<typename Placement<4, Real>::Vertex> vertices) noexcept {
  const RowShape<4>& shape = *view.shape;
  if (plane.count[row] == 0) return;
  const Word* const first = plane.bits[0].data() + row * shape.words();
  auto index = shape.index_of(row);
  index[3] = layer;
  CellBits<4, Axes> cells(view, row);
  std::array<TilePoint<3>, tables::kFaceSlots> points;
  Index next = plane.first(row);
  // cubes with vertices, 64 positions at a time
  for (std::size_t w = 0; w < shape.words(); ++w) {
    Word rest = first[w];
    if (rest == 0) continue;
    cells.load(w);
    for (; rest != 0; rest &= rest - 1) {
      const auto bit = static_cast<unsigned>(std::countr_zero(rest));
      const unsigned signature = cells.signature(bit);
      index[0] = w * kWordBits + bit;
      const SimplexList<3> list(table, signature);
      const EdgePlaces<4, Axes> places(source, index, signature);
      own_places<3>(
          list, false, [&](unsigned v) { return places(list.mapped(v)); }, points.data());
      for (unsigned j = 0; j < list.own_vertices(); ++j, ++next) {
        vertices[next] = placement.template in_cell<CellFrame<4, Axes>>(index, points[j]);
        if (placement.normals() != nullptr)
          vertices.normal(next) = placement.normals()->template in_cell<CellFrame<4, Axes>>(index, points[j]);
      }
    }
  }
}

/// Writes the vertices of a row's listed cubes, or adds those that are no barycentres to `together`, to be written
/// later.
template <unsigned Axes, class Real>
void generate_listed_cubes(const EdgeCrossings<4>& source, Triangulation triangulation,
                           const Placement<4, Real>& placement, const SlabView<4>& view, const CubePlane& plane,
                           std::size_t row, std::size_t layer, VertexRun<typename Placement<4, Real>::Vertex> vertices,
                           CellVertices<4, Real>& together) noexcept {
  if (plane.count[row] == 0) return;
  const ResolvedCubes& cubes = ResolvedCubes::instance(triangulation);
  auto index = view.shape->index_of(row);
  index[3] = layer;
  std::array<TilePoint<3>, ResolvedCubes::kMostOwn> points;
  Index next = plane.first(row);
  for (const ListedCube& cube : plane.lists.row(row)) {
    index[0] = cube.at;
    const unsigned number = list_of_key(CubeKey(cube.key));
    if (cubes.summary(number).barycentres == 0) {
      together.add(cubes, number, index, Axes, next);
      next += cubes.own_vertices(number);
      continue;
    }
    const SimplexList<3> list(variant_table<3>(triangulation).tile, cube.key);
    const EdgePlaces<4, Axes> places(source, index, signature_of<3>(cube.key));
    own_places<3>(list, false, places, points.data(), places.rays());
    for (unsigned j = 0; j < list.own_vertices(); ++j, ++next) {
      vertices[next] = placement.template in_cell<CellFrame<4, Axes>>(index, points[j]);
      if (placement.normals() != nullptr)
        vertices.normal(next) = placement.normals()->template in_cell<CellFrame<4, Axes>>(index, points[j]);
    }
  }
}

}  // namespace tegl::detail
