// SPDX-License-Identifier: BSD-3-Clause
//
// The extraction without tables, in any dimension: every tile's contour is built when its signature is first met.
// Private; from 5D on it is what `extract` does. In 2D to 4D tests hold it against the tables.
#pragma once

#include "image/extract_source.hpp"
#include "kernel/extract_kernel.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Bytes of built tiles that are kept for later use, beside those in use.
inline constexpr std::size_t kBuiltTileBytes = std::size_t{1} << 28;

/// The contour of `source` over `grid`, triangulated barycentrically, in memory. `contour` null: its size alone. Of
/// `plan`, how slabs are put together and what tiles are kept do not count. `stats` may be null. An image without tiles
/// has an empty contour. Throws UnsupportedData for missing values in 5D.
template <int N, class Real>
ContourSize extract_tiles(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                          Contour<N, Real>* contour, ExtractStats* stats, std::size_t tile_bytes = kBuiltTileBytes,
                          const ExtractPlan& plan = {});

/// Whether there are no tables for that, so that tiles are built.
template <int N>
inline constexpr bool kIsTileByTile = N > 4;

/// The same in memory, in any dimension. `stats` may be null.
template <int N, class Real>
Contour<N, Real> extract_any(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                             ExtractStats* stats, const ExtractPlan& plan = {}) {
  Contour<N, Real> contour;
  if constexpr (kIsTileByTile<N>)
    extract_tiles<N, Real>(source, grid, options, &contour, stats, kBuiltTileBytes, plan);
  else
    contour = extract_source<N, Real>(source, grid, generated_tables<N>(options), options, stats, plan);
  return contour;
}

}  // namespace tegl::detail
