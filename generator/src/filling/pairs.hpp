// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate of two neighbouring tiles: on the shared face, the boundary of one tile's contour must be the
// boundary of the other's with the opposite orientation. Otherwise the contour has a hole there.
//
// Based on: M. Liversage, thesis, 1994, sections 6.2.10 (consistency), 7.2.6 (the hole of figure 7.3) and 9.4 (its
// cause in "marching cubes": the exchange of high and low used as a symmetry).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "filling/facets.hpp"
#include "symmetry/symmetry.hpp"

namespace tegl::gen {

/// Result for all pairs of signatures that agree on the face between the two tiles.
struct PairFigures {
  std::uint64_t pairs = 0;      ///< pairs of signatures, along every axis
  std::uint64_t unmatched = 0;  ///< pairs whose contours do not close on the shared face
  // The first unmatched pair, ordered by axis, the face's signature and the pair; undefined if there is none.
  int axis = 0;         ///< the axis orthogonal to the shared face
  Signature below = 0;  ///< signature of the tile with the smaller coordinate
  Signature above = 0;  ///< signature of the tile with the larger coordinate
};

/// Counts the pairs of neighbours whose contours do not match. `contours` holds the contour of every signature of the
/// n-cube. `builder` supplies only the tile and the numbering of vertices. O(s log s) in the number of simplices.
/// Errors: Internal if a contour has a boundary inside its tile.
[[nodiscard]] PairFigures certify_pairs(const ContourBuilder& builder, std::span<const TileContour> contours);

/// Message that describes the first unmatched pair.
[[nodiscard]] std::string unmatched_text(int dim, const PairFigures& figures);

/// The (n-2)-simplices in which the contours of two neighbours do not match, as local vertices of the lower tile (on
/// its face 2 axis + 1). Empty if they match.
[[nodiscard]] std::vector<LocalSimplex> open_simplices(const ContourBuilder& builder, const TileContour& below,
                                                       const TileContour& above, int axis);

/// The table by equivalence classes: each signature gets its representative's contour, mapped by a group element, which
/// may include the exchange of high and low. With inversion this is the construction of Lorensen and Cline (1987). n =
/// 2, 3; errors: InvalidArgument for other dimensions.
[[nodiscard]] std::vector<TileContour> contours_by_class(const ContourBuilder& builder, GroupKind kind, bool inversion);

}  // namespace tegl::gen
