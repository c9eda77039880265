// SPDX-License-Identifier: BSD-3-Clause
//
// What each simplex adds to the sums of PieceSums.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "mesh/simplex_geometry.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The terms of one simplex in the sums over a contour.
template <int N>
struct PieceTerms {
  double size;        ///< length, area or volume
  double flux;        ///< N times the volume of the cone over the simplex with its apex at the reference point
  PointOf<N> moment;  ///< size times the sum of the corners, relative to the reference point: N times the moment
};

template <int N>
inline PieceTerms<N> piece_terms_of(const std::array<PointOf<N>, N>& corners, const PointOf<N>& reference,
                                    const PointOf<N>& normal) noexcept {
  PieceTerms<N> terms{length_of<N>(normal), 0.0, {}};
  for (int a = 0; a < N; ++a) {
    double middle = 0.0;
    for (const PointOf<N>& corner : corners) middle += corner[a] - reference[a];
    terms.moment[a] = terms.size * middle;
    terms.flux += normal[a] * (corners[0][a] - reference[a]);
  }
  return terms;
}

/// The terms of the simplices from, from + 1, … of a contour that is not wrapped, with the reference point of the label
/// of each; without labels, of label 0. The terms of simplices whose labels have no reference point are not defined.
/// The same bits as by `piece_terms_of`, for any instruction set.
void find_piece_terms(const SimplexView<4>& contour, std::span<const PointOf<4>> references,
                      std::span<const Index> labels, std::size_t from, std::span<PieceTerms<4>> terms);

}  // namespace tegl::detail
