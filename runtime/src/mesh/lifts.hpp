// SPDX-License-Identifier: BSD-3-Clause
//
// Unrolls the components of wrapped contours in place: the periods by which each vertex moves.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/simplex_geometry.hpp"

namespace tegl::detail {

/// The vertices of a wrapped contour as neighbours: each component is moved from the torus to plain space. A component
/// that winds round a period has no such image.
template <int N>
struct Lifts {
  std::vector<std::array<std::int32_t, N>> times;  ///< by vertex: multiples of the periods
  std::vector<bool> winds;                         ///< by label: a closed path in it goes round a period

  /// The vertex moved by its multiples.
  [[nodiscard]] PointOf<N> point(const SimplexView<N>& contour, Index v) const noexcept {
    PointOf<N> x = contour.point(v);
    for (std::size_t p = 0; p < contour.periods().size(); ++p) add_times(contour.periods()[p], times[v][p], x);
    return x;
  }
};

/// Finds them, for labels 0 ... references.size() - 1; other simplices are left out. Without labels all have label 0.
/// In each component the first corner of the first simplex is next to `references` of its label. Empty for a contour
/// without periods. Nearly O(S + V) time; 4 N + 4 bytes per vertex until it returns, and 4 N of the result.
///
/// Based on: union-find with the difference of each element from its parent, as for potentials; a path that closes with
/// a difference other than 0 winds.
template <int N>
[[nodiscard]] Lifts<N> find_lifts(const SimplexView<N>& contour, std::span<const Index> simplex_labels,
                                  std::span<const PointOf<N>> references);

}  // namespace tegl::detail
