// SPDX-License-Identifier: BSD-3-Clause
//
// The contours of polygons and polyhedra. They are built when an extraction meets the cell: in each face the contour is
// segments between crossed edges, around a polyhedron these are loops, and each loop bounds a disc. What is built in a
// face depends on the face's values alone, so cells of any types agree there.
//
// Based on: M. Liversage, thesis, 1994, section 7.3 (loops on the boundary of a cell); tests compare with FacetBuilder.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ambiguity/face_estimator.hpp"
#include "polytope/polytopes.hpp"
#include "tegl/tile/triangulation.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// How polygons and loops are resolved.
struct PolytopeRules {
  bool is_compact = true;          ///< no barycentre where the loop can be divided by diagonals
  bool joins_high = false;         ///< fixed rule: ambiguous faces join their high corners
  std::optional<FaceRule> rule{};  ///< instead: from the values at a face's corners
  double isovalue = 0;
};

/// Whether the high corners of an ambiguous face are joined. `values`: at the corners around the face, where high and
/// low alternate more than twice. A quadrilateral as in an image; other faces by the mean of their corners, also by the
/// rules of saddles.
[[nodiscard]] bool is_face_high(const PolytopeRules& rules, std::span<const double> values);

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
};

/// Builds the contours of all polytopes, or of `listed` ones (ascending), in blocks that do not
/// depend on the number of threads. The last vertices of a piece are oriented so that its positive side faces high
/// corners in a cell that is not inverted. Errors: Cancelled.
[[nodiscard]] std::vector<PolytopeBlock> build_polytope_contours(const Polytopes& polytopes,
                                                                 std::span<const double> values,
                                                                 const PolytopeRules& rules,
                                                                 const std::vector<Index>* listed,
                                                                 const WorkOptions& work);

/// Makes cones of the fans that have a diagonal in common with another one: cells that meet in several faces. To be
/// called when vertices are numbered, before the sizes of the blocks are used.
void separate_diagonals(std::vector<PolytopeBlock>& blocks);

}  // namespace tegl::detail
