// SPDX-License-Identifier: BSD-3-Clause
//
// The extraction without tables, in any dimension: every tile's contour is built when its signature is first met.
// Private; from 5D on it is what `extract` does. In 2D to 4D tests hold it against the tables.
#pragma once

#include "extract_kernel.hpp"
#include "extract_source.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Bytes of built tiles that are kept for later use, beside those in use.
inline constexpr std::size_t kBuiltTileBytes = std::size_t{1} << 28;

/// The contour of `source` over `grid`, triangulated barycentrically. `contour` null: its size alone. `stats` may be
/// null. Throws UnsupportedData for missing values.
template <int N, class Real>
ContourSize extract_tiles(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                          Contour<N, Real>* contour, ExtractStats* stats, std::size_t tile_bytes = kBuiltTileBytes);

}  // namespace tegl::detail
