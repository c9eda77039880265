// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction into memory in any dimension: by tables, or tile by tile.
#pragma once

#include "kernel/extract_kernel.hpp"
#include "kernel/tableless.hpp"

namespace tegl::detail {

/// Whether contours of dimension N are extracted without tables, by building tiles.
template <int N>
inline constexpr bool kIsTileByTile = N > 4;

/// Extracts a contour into memory in any dimension, by tables or by building tiles.
template <int N, class Real>
Extraction<N, Real> extract_in_memory(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                                      const ExtractPlan& plan = {}) {
  if constexpr (kIsTileByTile<N>)
    return extract_tiles<N, Real>(source, grid, options, kBuiltTileBytes, plan);
  else
    return extract_source<N, Real>(source, grid, generated_tables<N>(options), options, plan);
}

}  // namespace tegl::detail
