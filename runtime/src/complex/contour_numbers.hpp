// SPDX-License-Identifier: BSD-3-Clause
//
// Everything about a contour of a complex except positions: active cells, and the numbers of vertices and simplices.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "complex/shared_points.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Checks the options of an extraction from a complex. Errors: InvalidIsovalue, InvalidArgument.
void check_complex_options(double isovalue, const ExtractOptions& options);

/// How polygons and polyhedra are resolved.
[[nodiscard]] PolytopeRules rules_of(const ExtractOptions& options, double isovalue);

/// The simplices of an active cell.
struct CellSimplices {
  Index cell;               ///< number among all cells: by group, then polygons, polyhedra and 4D polytopes
  std::uint16_t signature;  ///< 0 for polygons, polyhedra and 4D polytopes
  std::uint32_t end;        ///< the number of the first simplex behind them
};

/// The numbers of a contour. Vertices: those on edges, then barycentres in common 3-faces, then vertices of cells,
/// of polygons, polyhedra and 4D polytopes last. Simplices: in the order of the cells.
class ContourNumbers {
 public:
  /// The arguments must outlive this object. Reports progress from 0 to 1. `active`: numbers of the cells that may be
  /// active; null: any. Errors: TooLarge, Cancelled.
  ContourNumbers(const CellGroups& cells, const ComplexEdges* edges, std::span<const double> values, double isovalue,
                 const ExtractOptions& options, const Progress& progress, ExtractStats& stats,
                 const std::vector<Index>* active = nullptr);
  // crossings_ refers to other members
  ContourNumbers(const ContourNumbers&) = delete;
  ContourNumbers& operator=(const ContourNumbers&) = delete;

  [[nodiscard]] ContourSize size() const noexcept { return {vertex_count_, simplex_count_}; }
  [[nodiscard]] const std::vector<ActiveBlock>& blocks() const noexcept { return blocks_; }
  [[nodiscard]] const std::vector<EdgeEnds>& edge_ends() const noexcept { return crossings_.ends(); }
  [[nodiscard]] const std::vector<PolygonKey>& polygons() const noexcept { return shared_.keys; }
  /// The shared vertices that are no barycentres of polygons; their numbers are in `polygons`.
  [[nodiscard]] const std::vector<CubePoint>& points_in_cubes() const noexcept { return shared_.in_cubes; }
  [[nodiscard]] const std::vector<LoopPoint>& loops() const noexcept { return shared_.loops; }
  [[nodiscard]] const tables::CellTable& table(std::size_t group) const noexcept { return cases(group).table(); }
  [[nodiscard]] const CellCases& cases(std::size_t group) const noexcept { return tables_.of_group[group]; }
  /// The vertices on crossed edges of a block's cells: one cell after the other, by edge.
  [[nodiscard]] const Buffer<Index>& crossings(std::size_t block) const noexcept { return crossings_.of_block(block); }
  [[nodiscard]] std::uint64_t first_simplex(std::size_t block) const noexcept { return first_simplex_[block]; }
  [[nodiscard]] const std::vector<PolytopeBlock>& polytopes() const noexcept { return polytopes_; }
  /// The numbers of the first barycentre and of the first simplex of a block of polytopes.
  [[nodiscard]] std::uint64_t first_of_polytopes(std::size_t block) const noexcept { return polytope_own_[block]; }
  [[nodiscard]] std::uint64_t first_simplex_of_polytopes(std::size_t block) const noexcept {
    return polytope_simplex_[block];
  }
  /// The number of a vertex of the prisms in a block of polytopes (PolytopeBlock::tetrahedra).
  [[nodiscard]] Index prism_vertex(std::size_t block, std::uint32_t vertex) const noexcept {
    const PolytopeBlock& of = polytopes_[block];
    if (vertex < PolytopeBlock::kShared) return of.numbers[of.vertices[vertex]];
    if (vertex >= PolytopeBlock::kOwn) return static_cast<Index>(polytope_own_[block] + vertex - PolytopeBlock::kOwn);
    const std::uint64_t number = shared_.numbers[polytope_shared_[block] + vertex - PolytopeBlock::kShared];
    return static_cast<Index>(edge_ends().size() + number);
  }
  /// The barycentre of the polygon with these vertices in a common 3-face, or kNoPoint.
  [[nodiscard]] Index polygon(std::span<const Index> vertices) const;
  /// The same for a facet of prisms with a key (key_of_facet).
  [[nodiscard]] Index polygon_in(const std::array<Index, 4>& facet, std::span<const Index> vertices) const;

  /// The number of a vertex in a hexahedron between two cells (`point.number` is not read). `crossing`: the smallest
  /// number of a vertex on the hexahedron's edges.
  [[nodiscard]] Index in_cube(const CubePoint& point, Index crossing) const;

  /// The vertices of an active cell: by edge, then by added vertex.
  using CellVertices = std::array<Index, 256>;
  /// Calls visit(cell, first simplex, contour, vertices) for the active cells of a block.
  template <class Visit>
  void for_each_cell(std::size_t block, const Visit& visit) const;

  /// The simplices of the active cells, ascending.
  [[nodiscard]] std::vector<CellSimplices> simplices_by_cell(const CellGroups& cells) const;

  /// The numbers of vertices on edges of cells with missing corners, ascending: the contour may touch itself there.
  [[nodiscard]] std::vector<Index> vertices_at_missing(const CellGroups& cells) const;
  /// Whether a value is missing.
  [[nodiscard]] bool any_missing() const noexcept { return !bits_.missing.empty(); }

 private:
  CellTables tables_;
  PointBits bits_;
  std::vector<ActiveBlock> blocks_;
  std::vector<PolytopeBlock> polytopes_;
  CrossingNumbers crossings_;
  SharedPoints shared_;
  std::vector<std::uint64_t> first_shared_, first_own_, first_simplex_;  ///< by block
  std::uint64_t own_base_ = 0;
  std::uint64_t vertex_count_ = 0, simplex_count_ = 0;
  [[nodiscard]] Index number_of(const PolygonKey& key) const;

  std::vector<std::uint64_t> polytope_own_, polytope_simplex_, polytope_shared_;  ///< first ones, by block of polytopes
};

template <class Visit>
void ContourNumbers::for_each_cell(std::size_t block, const Visit& visit) const {
  const ActiveBlock& of = blocks_[block];
  const CellCases& cases = tables_.of_group[of.group];
  std::uint64_t shared = first_shared_[block], own = first_own_[block], simplex = first_simplex_[block];
  std::size_t crossing = 0;
  CellVertices vertices{};
  for (const ActiveCell& cell : of.cells) {
    const CellContour contour = cases.of(cell.signature, cell.variant);
    const tables::CellList& list = contour.list();
    crossings_.of_cell(block, cell, crossing, vertices.data());
    Index* added = vertices.data() + cases.table().edge_count;
    for (unsigned j = 0; j < list.shared_vertices; ++j)
      *added++ = static_cast<Index>(edge_ends().size() + shared_.numbers[shared++]);
    for (unsigned j = list.shared_vertices; j < list.added(); ++j) *added++ = static_cast<Index>(own_base_ + own++);
    visit(cell, simplex, contour, vertices);
    simplex += list.simplex_count;
  }
}

}  // namespace tegl::detail
