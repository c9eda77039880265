// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate of two neighbouring tiles: on the face that they share, the boundary of one tile's contour must be
// the boundary of the other's with the opposite orientation. Where it is not, the contour has a hole.
//
// Based on: M. Liversage, thesis, 1994, sections 6.2.10 (consistency), 7.2.6 (the hole of figure 7.3) and 9.4 (why
// "marching cubes" makes it: the exchange of high and low as a symmetry).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "filling/facets.hpp"
#include "symmetry/symmetry.hpp"

namespace tegl::gen {

/// What two neighbours were found to do, over all pairs of signatures that agree on the face between them.
struct PairFigures {
  std::uint64_t pairs = 0;      ///< pairs of signatures, along every axis
  std::uint64_t unmatched = 0;  ///< those whose contours do not close on the shared face
  // The first of these, by axis, the face's signature and the pair; meaningless if there is none.
  int axis = 0;         ///< the axis across which they lie
  Signature below = 0;  ///< of the tile with the smaller coordinate along the axis
  Signature above = 0;  ///< of the one with the larger
};

/// Counts the pairs of neighbours whose contours do not match. `contours` has the contour of every signature of the
/// n-cube; builder is asked for the tile and the numbering of vertices only. O(simplices log simplices).
/// Errors: Internal if a contour has a boundary inside of its tile.
[[nodiscard]] PairFigures certify_pairs(const ContourBuilder& builder, std::span<const TileContour> contours);

/// What is wrong with the first pair that does not match, for a message.
[[nodiscard]] std::string unmatched_text(int dim, const PairFigures& figures);

/// The (n-2)-simplices in which the contours of two neighbours do not match, as local vertices of the lower one's
/// face 2 axis + 1, lifted into that tile. Empty if they match.
[[nodiscard]] std::vector<Simplex> open_simplices(const ContourBuilder& builder, const TileContour& below,
                                                  const TileContour& above, int axis);

/// The table that classes suggest: each signature takes its representative's contour through the group element that
/// leads there, the exchange of high and low included. n = 2, 3. With inversion that is the construction of Lorensen
/// and Cline (1987). Errors: InvalidArgument for other dimensions.
[[nodiscard]] std::vector<TileContour> contours_by_class(const ContourBuilder& builder, GroupKind kind, bool inversion);

}  // namespace tegl::gen
