// SPDX-License-Identifier: BSD-3-Clause
//
// The extraction without tables, in any dimension: every tile's contour is built when its signature is first met.
// Private; from 5D on it is what `extract` does, and in 4D where barycentric tiles are resolved from the data.
// Otherwise, in 2D to 4D, tests hold it against the tables.
#pragma once

#include "extract_kernel.hpp"
#include "extract_source.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Bytes of built tiles that are kept for later use, beside those in use.
inline constexpr std::size_t kBuiltTileBytes = std::size_t{1} << 28;

/// The contour of `source` over `grid`, triangulated barycentrically, put into `output`: caps come along with the slabs
/// that they belong to. Of `plan`, how slabs are put together and what tiles are kept do not count. An image without
/// tiles leaves the output alone. Throws UnsupportedData for missing values in 5D.
template <int N, class Real>
ExtractStats extract_tiles_to(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                              const ExtractPlan& plan, ContourOutput<N, Real>& output,
                              std::size_t tile_bytes = kBuiltTileBytes);

/// The same, to be run; null for an image without tiles.
template <int N, class Real>
std::unique_ptr<SteppedExtraction<N, Real>> make_tiles_extraction(SampleSource<N>& source, const Grid<N>& grid,
                                                                  const ExtractOptions& options,
                                                                  const ExtractPlan& plan,
                                                                  ContourOutput<N, Real>& output);

/// The same in memory. `contour` null: its size alone, as far as no value is missing. `stats` may be null.
template <int N, class Real>
ContourSize extract_tiles(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                          Contour<N, Real>* contour, ExtractStats* stats, std::size_t tile_bytes = kBuiltTileBytes,
                          const ExtractPlan& plan = {});

/// Whether there are no tables for that, so that tiles are built.
template <int N>
constexpr bool is_tile_by_tile(const ExtractOptions& options) noexcept {
  return N > 4 || (N == 4 && options.triangulation == Triangulation::barycentric && is_estimated(options.ambiguity));
}

/// The contour of `source` over `grid`, by tables where there are any, put into `output`.
template <int N, class Real>
requires(N <= 4) ExtractStats
    extract_any_to(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options, const ExtractPlan& plan,
                   ContourOutput<N, Real>& output) {
  if constexpr (N == 4)
    if (is_tile_by_tile<N>(options)) return extract_tiles_to<N, Real>(source, grid, options, plan, output);
  return extract_to<N, Real>(source, grid, generated_tables<N>(options), options, plan, output);
}

/// The same, to be run; null for an image without tiles.
template <int N, class Real>
requires(N <= 4) std::unique_ptr<SteppedExtraction<N, Real>> make_any_extraction(SampleSource<N>& source,
                                                                                 const Grid<N>& grid,
                                                                                 const ExtractOptions& options,
                                                                                 const ExtractPlan& plan,
                                                                                 ContourOutput<N, Real>& output) {
  if constexpr (N == 4)
    if (is_tile_by_tile<N>(options)) return make_tiles_extraction<N, Real>(source, grid, options, plan, output);
  return make_extraction<N, Real>(source, grid, generated_tables<N>(options), options, plan, output);
}

/// The same in memory, in any dimension. `stats` may be null.
template <int N, class Real>
Contour<N, Real> extract_any(SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options,
                             ExtractStats* stats, const ExtractPlan& plan = {}) {
  Contour<N, Real> contour;
  if constexpr (N >= 4)
    if (is_tile_by_tile<N>(options)) {
      extract_tiles<N, Real>(source, grid, options, &contour, stats, kBuiltTileBytes, plan);
      return contour;
    }
  if constexpr (N <= 4)
    contour = extract_source<N, Real>(source, grid, generated_tables<N>(options), options, stats, plan);
  return contour;
}

}  // namespace tegl::detail
