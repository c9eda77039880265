// SPDX-License-Identifier: BSD-3-Clause
//
// Counts the faces of tetrahedra that have a vertex as their smallest one, at vertices where all triangles that are
// counted are shared by two tetrahedra of opposite orientations: nearly all vertices of a contour. Other vertices are
// left to the caller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/vertex_stars.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The faces whose smallest vertex is the centre of a star.
struct ClosedStar {
  std::uint16_t edges = 0;  ///< 0 unless they are requested
  std::uint16_t triangles = 0;
  std::uint16_t tetrahedra = 0;
  std::uint16_t boundary = 0;  ///< triangles in one tetrahedron
  /// Whether each of these triangles is in two tetrahedra, which induce opposite orientations on it, or, on request, in
  /// one. If not, or if the star is large, nothing else is set.
  bool is_settled = false;

  /// The vertex at the centre, minus the edges, plus the triangles, minus the tetrahedra.
  [[nodiscard]] std::int32_t euler_above() const noexcept { return 1 - int{edges} + int{triangles} - int{tetrahedra}; }
};

/// More about stars, on request. Then boundary triangles are allowed.
struct ClosedStars {
  /// By tetrahedron, its row of the tetrahedra across its triangles: entry i is across the triangle opposite to vertex
  /// i. Entries are written for the triangles that are counted.
  Index* across = nullptr;
  /// The other ends of the edges that are counted, if any are, star after star: the first `edge_count` of them.
  std::vector<Index> edges;
  std::size_t edge_count = 0;
};

/// The stars of the vertices from, from + 1, … `rows`: #S x 4, row = tetrahedron. `more`: null or what to add to.
void count_closed_stars(const Index* rows, const Stars& stars, std::size_t from, bool with_edges,
                        std::span<ClosedStar> found, ClosedStars* more = nullptr);

}  // namespace tegl::detail
