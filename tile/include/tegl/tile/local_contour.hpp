// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of a cell of up to four dimensions by local vertices, as in the tables of mesh cells (cell_contract.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/tile/facets.hpp"

namespace tegl::tile {

/// Simplices of local vertices: edges, then added vertices, ordered by kind and mask.
struct LocalContour {
  std::vector<std::array<std::uint8_t, 4>> simplices = {};  ///< oriented; the first n vertices count
  std::vector<std::uint64_t> masks = {};                    ///< of added vertices
  std::array<std::uint8_t, 3> added_count = {};             ///< in 3-faces, barycentres, side vertices
};

/// Converts the facets of a cell of n dimensions, 2 to 4. `edge_of`: by face of the lattice, the number of an edge
/// (other faces: any value); `edge_count`: number of edges; `reversed`: exchanges the last two vertices of each
/// simplex. Throws std::logic_error for a vertex of a kind that the tables do not have, std::length_error for more than
/// 256 vertices.
[[nodiscard]] LocalContour local_contour(const FaceLattice& lattice, std::span<const std::uint8_t> edge_of,
                                         unsigned edge_count, const TileFacets& facets, bool reversed);

}  // namespace tegl::tile
