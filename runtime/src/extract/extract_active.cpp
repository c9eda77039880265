// SPDX-License-Identifier: BSD-3-Clause
//
// Extraction with an index of the active tiles.

#include <fmt/format.h>

#include "base/stopwatch.hpp"
#include "extract/uncertainty.hpp"
#include "image/row_source.hpp"
#include "kernel/extract_in_memory.hpp"
#include "kernel/tile_selection.hpp"
#include "search/index_file.hpp"

namespace tegl {

namespace {

template <Value T, int N>
void require_index_of(const Image<T, N>& image, const ActiveTiles<N>& active) {
  if (active.image().sizes == image.grid().sizes() && active.image().value_type == kValueType<T>) return;
  throw Error(
      ErrorCode::InvalidArgument,
      fmt::format("an index of an image of {} {}; expected one of {} {}", fmt::join(active.image().sizes, " x "),
                  name_of(active.image().value_type), fmt::join(image.grid().sizes(), " x "), name_of(kValueType<T>)));
}

}  // namespace

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> Extraction<N, Real> extract_with_stats(const Image<T, N>& image, double isovalue,
                                                                          const ActiveTiles<N>& active,
                                                                          const ExtractOptions& options) {
  detail::check_arguments(isovalue, options);
  require_index_of(image, active);
  const bool missing = active.image().any_missing;
  if (options.close && !active.is_complete())
    throw Error(ErrorCode::InvalidArgument,
                "the border cannot be closed around chosen tiles; expected an index of all active tiles");
  const bool finds_all = active.is_complete() && options.close && missing;
  if (active.grid().count() == 0 || finds_all) return extract_with_stats<Real>(image, isovalue, options);
  detail::Stopwatch watch;
  // A skipped row provides no state to its neighbours, which extraction next to missing values needs: then select tiles
  // instead of rows.
  const detail::TileSelection selection = active.is_complete() && !missing
                                              ? detail::TileSelection::rows_of(active, isovalue)
                                              : detail::TileSelection::tiles_of(active, isovalue);
  double seconds = 0;
  watch.add_to(seconds);
  detail::ExtractPlan plan;
  plan.selection = &selection;
  detail::ImageSource<T, N> source(image, isovalue, options.epsilon);
  auto result = detail::extract_with_uncertainty<N, Real>(source, image.grid(), image, options, plan);
  result.stats.find_seconds += seconds;
  return result;
}

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                                                       \
  template Extraction<N, Real> extract_with_stats<Real, T, N>(const Image<T, N>&, double, const ActiveTiles<N>&, \
                                                              const ExtractOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
