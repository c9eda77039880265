// SPDX-License-Identifier: BSD-3-Clause
//
// Segments of squares, and their certificate.
#include "builders/square_contours.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "base/lattice.hpp"
#include "tegl/tile/certificate.hpp"

namespace tegl::gen {

std::vector<SquareSegment> square_segments(unsigned signature, bool centre_high) {
  const auto is_high = [signature](unsigned k) { return (signature >> kRingCorner[k % 4] & 1u) != 0; };
  const auto is_critical = [&is_high](unsigned k) { return is_high(k) != is_high(k + 1); };
  std::vector<SquareSegment> segments;
  unsigned used = 0;
  for (unsigned k = 0; k < 4; ++k) {
    if (!is_critical(k) || (used >> k & 1u) != 0) continue;
    const bool run_begins = is_high(k + 1) != centre_high;
    unsigned other = k;
    do {
      other = (other + (run_begins ? 1 : 3)) % 4;
    } while (!is_critical(other));
    used |= 1u << k | 1u << other;
    const bool falls = is_high(k);
    segments.push_back({kRingEdge[falls ? k : other], kRingEdge[falls ? other : k]});
  }
  return segments;
}

void certify_squares() {
  const tile::FaceLattice lattice = tile::FaceLattice::cube(2);
  const CubeLattice tiles(2);
  const Tile& square = tiles.tile(2);
  for (unsigned k = 0; k < 4; ++k)
    if (square.edge_between(kRingCorner[k], kRingCorner[(k + 1) % 4]) != kRingEdge[k])
      throw Error(ErrorCode::Internal, "the ring of the square's edges differs from the tables' numbering");
  tile::FacetBuilder builder(lattice);
  for (unsigned signature = 0; signature < 16; ++signature)
    for (const bool centre_high : {false, true}) {
      const std::vector<tile::Choice> choices(lattice.faces().size(),
                                              centre_high ? tile::Choice::high : tile::Choice::low);
      tile::TileFacets built = builder.build(signature, {choices, tile::Alternative::low}, tile::Geometry::without);
      std::array<tile::VertexId, 4> vertex{};  // of the point on each edge
      for (tile::VertexId v = 0; v < built.vertices.size(); ++v)
        for (std::size_t e = 0; e < 4 && built.vertices[v].kind == tile::VertexKind::edge; ++e)
          if (lattice.faces()[built.vertices[v].face].corners ==
              (Signature{1} << square.edges[e][0] | Signature{1} << square.edges[e][1]))
            vertex[e] = v;
      tile::Simplices expected;
      for (const tile::Facet& facet : built.facets)
        expected.insert(expected.end(), facet.simplices.begin(), facet.simplices.end());
      tile::Facet facet;
      for (const SquareSegment& segment : square_segments(signature, centre_high)) {
        tile::Simplex& simplex = facet.simplices.emplace_back(tile::kNoSimplex);
        simplex[0] = vertex[segment[0]], simplex[1] = vertex[segment[1]];
      }
      built.facets.assign(1, facet);
      const bool same = facet.simplices.size() == expected.size() &&
                        std::is_permutation(expected.begin(), expected.end(), facet.simplices.begin());
      const tile::Fault fault = tile::certify(lattice, built);
      if (!same || fault != tile::Fault::none)
        throw Error(ErrorCode::CertificateFailed,
                    fmt::format("square of signature {}, centre {}: {}", signature, centre_high ? "high" : "low",
                                same ? tile::name_of(fault) : "not the contour of the general builder"));
    }
}

}  // namespace tegl::gen
