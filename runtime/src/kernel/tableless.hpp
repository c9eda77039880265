// SPDX-License-Identifier: BSD-3-Clause
//
// The extraction without tables, in any dimension: a tile's contour is built when its signature first occurs. Private.
// `extract` uses it from 5D on. In 2D to 4D tests compare it with the tables.
#pragma once

#include "image/sample_source.hpp"
#include "kernel/extract_kernel.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Maximum bytes of built tiles kept for later use, in addition to those in use.
inline constexpr std::size_t kBuiltTileBytes = std::size_t{1} << 28;

/// Extracts the contour of `source` over `grid` into memory, triangulated barycentrically. If `contour` is null, only
/// its size is determined. `plan`'s members on batches and on keeping tiles have no effect. `stats` may be null. An
/// image without tiles has an empty contour. Throws UnsupportedData for missing values.
template <int N, class Real>
ContourSize extract_tiles(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                          Contour<N, Real>* contour, ExtractStats* stats, std::size_t tile_bytes = kBuiltTileBytes,
                          const ExtractPlan& plan = {});

/// Whether contours of dimension N are extracted without tables, by building tiles.
template <int N>
inline constexpr bool kIsTileByTile = N > 4;

/// Extracts a contour into memory in any dimension. `stats` may be null.
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
