// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images whose cells are all divided alike, without storing the simplices. `extract_divided` uses it in 5D,
// where a cell has up to 1 920 simplices. In 2D to 4D tests compare it with complexes.
#pragma once

#include <array>
#include <cstddef>

#include "base/function_ref.hpp"
#include "tegl/division.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Reads `count` samples along axis 0 from an index on, as doubles.
template <int N>
using ReadSamples = FunctionRef<void(const std::array<std::size_t, N>& from, std::size_t count, double* out)>;

/// Extracts the contour of the samples over `grid`. `division`: kuhn or symmetric. `contour`: null to count only.
/// Vertices are ordered by cells; one that several cells share belongs to the last of them. Errors: those of
/// extract_divided in 5D.
template <int N, class Real>
ExtractedSize extract_divided_cells(const Grid<N>& grid, ReadSamples<N> read, Division division, double isovalue,
                                    const ExtractOptions& options, Contour<N, Real>* contour);

}  // namespace tegl::detail
