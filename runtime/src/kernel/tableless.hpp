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

/// Extracts the contour of `source` over `grid` into memory; in 2D to 4D triangulated barycentrically. `plan`'s members
/// on batches and on keeping tiles have no effect. An image without tiles has an empty contour. Tiles with a missing
/// corner are left out; the contour is made a manifold beside them.
template <int N, class Real>
Extraction<N, Real> extract_tiles(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                                  std::size_t tile_bytes = kBuiltTileBytes, const ExtractPlan& plan = {});

/// The size of the contour of extract_tiles, which is not written; with missing values it is made, and then dropped.
template <int N>
ExtractedSize count_tiles(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options);

}  // namespace tegl::detail
