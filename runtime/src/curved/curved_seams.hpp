// SPDX-License-Identifier: BSD-3-Clause
//
// Curved grids with periodic axes: one sample longer, so that cells across a seam have coordinates at both ends.
#pragma once

#include <span>
#include <vector>

#include "tegl/curved.hpp"

namespace tegl::detail {

/// A curved grid that repeats its first samples behind the last ones along the axes of seams.
template <int N>
struct LongerCurved {
  Grid<N> grid;
  std::vector<CurvedAxis> curved;
};

/// Errors: InvalidGrid for seams that do not fit the grid.
template <int N>
[[nodiscard]] LongerCurved<N> longer_curved(const Grid<N>& grid, std::span<const CurvedAxis> curved,
                                            std::span<const CurvedSeam<N>> seams);

/// The periods in space of a contour on the grid: those of seams whose vectors are not 0.
template <int N>
[[nodiscard]] std::vector<Period<N>> periods_of_seams(const Grid<N>& grid, std::span<const CurvedAxis> curved,
                                                      std::span<const CurvedSeam<N>> seams);

}  // namespace tegl::detail
