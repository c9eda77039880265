// SPDX-License-Identifier: BSD-3-Clause
//
// The lower and the upper link of vertices of tetrahedra, connected across the triangles at the vertex: words of 64
// bits for sets of tetrahedra of a star, from neighbours that are known. This needs no numbers for the vertices of the
// link, and decides nearly all vertices of a contour.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mesh/vertex_stars.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// What a star has below and above its centre.
struct StarSides {
  Index below = 0;             ///< the last tetrahedron with a vertex below the centre
  std::int32_t growth = 0;     ///< tetrahedra that begin at the centre minus those that end there
  bool are_connected = false;  ///< if not, nothing else is set
};

/// Tetrahedra that list their vertices by ascending rank.
struct RankedTetrahedra {
  const std::array<Index, 4>* ranks;   ///< by tetrahedron
  const std::array<Index, 4>* across;  ///< by tetrahedron and place: the tetrahedron across the triangle without it
  const Stars& stars;                  ///< by vertex, not by rank
};

/// The sides of the vertices from, from + 1, …, which have these ranks. If `are_connected`, then so are the vertices
/// of the link above the vertex by edges of the link among them, and those below it, and both exist. The converse need
/// not hold: at borders, at edges whose tetrahedra are not connected across triangles, and if the star has more than 64
/// tetrahedra or two whose numbers have equal lower bits.
void find_sides(const RankedTetrahedra& tetrahedra, std::size_t from, std::span<const Index> ranks,
                std::span<StarSides> found);

}  // namespace tegl::detail
