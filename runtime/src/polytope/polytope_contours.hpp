// SPDX-License-Identifier: BSD-3-Clause
//
// The contours of polygons and polyhedra. They are built when an extraction meets the cell: in each face the contour is
// segments between crossed edges, around a polyhedron these are loops, and each loop bounds a disc. What is built in a
// face depends on the face's values alone, so cells of any types agree there.
//
// Based on: M. Liversage, thesis, 1994, section 7.3 (loops on the boundary of a cell); tests compare with FacetBuilder.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/workers.hpp"
#include "polytope/loops.hpp"
#include "polytope/polytopes.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// The active ones among consecutive polytopes.
struct PolytopeBlock {
  /// A segment (2D), or a loop around a disc.
  struct Piece {
    Index cell;         ///< in Polytopes
    std::uint32_t end;  ///< in `vertices`
    bool is_coned;      ///< from a barycentre; otherwise a fan from its first vertex
  };
  std::vector<Index> missing;               ///< cells with missing corners
  std::vector<std::array<Index, 2>> edges;  ///< the crossed ones by their ends, ascending, each once
  std::vector<Index> numbers;               ///< of the contour's vertices on them
  std::vector<Piece> pieces;                ///< by cell
  std::vector<std::uint32_t> vertices;      ///< of all pieces, as positions in `edges`
  std::uint64_t simplices = 0, own = 0;     ///< sizes of the contour; own vertices are the barycentres
  std::uint64_t active = 0;                 ///< number of active cells

  /// A vertex of prisms over polyhedra that is not on an edge.
  struct InnerVertex {
    enum class Kind : std::uint8_t {
      polygon,  ///< barycentre of a loop in a facet that is tabled (SolidFacet); known by its vertices
      loop,     ///< the same in another facet: known by the facet and a vertex
      in_cube,  ///< a vertex of a hexahedron's own, as in images: known by the hexahedron and the mask
      mean,     ///< of the cell: the mean of its points
      inwards,  ///< of the cell: half-way from there to the mean of the cell's corners
      collar,   ///< likewise, a quarter of the way
    };
    Kind kind;
    Index cell;
    /// In `inner_vertices`: the vertices on edges that it is the mean of; `in_cube`: all of the hexahedron.
    std::uint32_t first_vertex, vertices_end;
    std::uint32_t first_corner, corners_end;  ///< in `inner_corners`, likewise
    std::array<Index, 8> points;              ///< `loop`: key_of_facet; `in_cube`: as the tables order them
    std::uint32_t mask;                       ///< `in_cube`: corners (bit v), edges (bit 8 + e) of the cube of images
  };
  /// Of prisms: tetrahedra instead of loops. A vertex is a position in `vertices`, or kShared or kOwn and a position in
  /// `shared` or `own_vertices`. The ends of pieces, one for each cell, are positions in `tetrahedra`.
  std::vector<std::array<std::uint32_t, 4>> tetrahedra;
  std::vector<InnerVertex> shared;            ///< with the cell on the other side of a facet
  std::vector<InnerVertex> own_vertices;      ///< of cells
  std::vector<std::uint32_t> inner_vertices;  ///< positions in `vertices`
  std::vector<Index> inner_corners;           ///< points
  static constexpr std::uint32_t kShared = 1u << 30, kOwn = 1u << 31;
};

/// Builds the contours of all polytopes, or of `listed` ones (ascending), in blocks that do not
/// depend on the number of threads. The last vertices of a piece are oriented so that its positive side faces high
/// corners in a cell that is not inverted. Errors: Cancelled.
[[nodiscard]] std::vector<PolytopeBlock> build_polytope_contours(const Polytopes& polytopes,
                                                                 std::span<const double> values,
                                                                 const PolytopeRules& rules,
                                                                 const std::vector<Index>* listed,
                                                                 const WorkOptions& work);

/// Builds blocks of `cells` cells each. make_builder(block): an object with members add(cell) and finish().
template <class MakeBuilder>
std::vector<PolytopeBlock> build_blocks(std::size_t cells, const Polytopes& polytopes, const std::vector<Index>* listed,
                                        const WorkOptions& work, const MakeBuilder& make_builder) {
  const std::size_t count = listed == nullptr ? polytopes.size() : listed->size();
  std::vector<PolytopeBlock> blocks(block_count(count, cells));
  for_each_item(blocks.size(), work.threads, work.progress, [&](std::size_t b) {
    auto builder = make_builder(blocks[b]);
    for (std::size_t i = cells * b; i < std::min(count, cells * (b + 1)); ++i)
      builder.add(listed == nullptr ? static_cast<Index>(i) : (*listed)[i]);
    builder.finish();
  });
  return blocks;
}

/// Sets the edges of a block, and the positions of `crossed` among them as its vertices.
void set_edges(PolytopeBlock& block, const std::vector<std::array<Index, 2>>& crossed);

/// Makes cones of the fans that have a diagonal in common with another one: cells that meet in several faces. To be
/// called when vertices are numbered, before the sizes of the blocks are used.
void separate_diagonals(std::vector<PolytopeBlock>& blocks, unsigned threads);

}  // namespace tegl::detail
