// SPDX-License-Identifier: BSD-3-Clause
//
// The contour of one tile as plain data: facets with their triangulations, and Sigma, their boundary.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/lattice.hpp"
#include "tegl/tile/facets.hpp"
#include "tegl/tile/triangulation.hpp"

namespace tegl::gen {

using tegl::Triangulation;
using tile::Alternative;
using tile::Filling;

const char* alternative_name(Alternative a) noexcept;      ///< "low", "high"
const char* triangulation_name(Triangulation t) noexcept;  ///< "barycentric", "compact"

/// An oriented simplex by local vertices as in the table contract; the first n count for an n-tile. tile::Simplex
/// has the vertices of any tile instead.
using LocalSimplex = std::array<std::uint8_t, 4>;

/// One facet of the contour, as tile::Facet, by local vertices.
struct LocalFacet {
  Filling filling = Filling::simplex;     ///< how it is filled
  int sign = 1;                           ///< dimension 1 only: +1 if the edge's second end is high
  int boundary_euler = 0;                 ///< Euler characteristic of its component of Sigma
  std::vector<std::uint8_t> points;       ///< edge points; n = 3: in cyclic order, n = 2: from, to; else ascending
  std::vector<LocalSimplex> simplices{};  ///< its triangulation
  std::uint32_t boundary_facets = 0;      ///< number of (n-2)-facets in its boundary
};

/// All facets of a tile; positive sides face the high corners.
struct TileContour {
  std::vector<LocalFacet> facets;          ///< one per component of Sigma
  std::vector<LocalSimplex> boundary;      ///< Sigma: oriented (n-2)-simplices, n - 1 vertices each
  std::vector<std::int8_t> boundary_sign;  ///< n = 2 only (0-simplices): +1 or -1
  std::uint32_t cone_vertices = 0;         ///< number of own vertices that are barycentres
  std::vector<std::uint64_t> side_masks;   ///< one per side vertex: the corners and edges of which it is the mean
};

/// The contour of a 4-tile's complement in the other alternative: the same simplices with reversed orientation.
TileContour inverted(const TileContour& contour);

}  // namespace tegl::gen
