// SPDX-License-Identifier: BSD-3-Clause
//
// The ways to find active tiles: each is built from an image, or read from a file.
#pragma once

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "index_file.hpp"
#include "tegl/active_tiles.hpp"

namespace tegl::detail {

template <int N>
using ActiveTilesPtr = std::unique_ptr<tegl::ActiveTiles<N>>;

/// What a method works on. All must outlive the building or reading, the image's values the index too.
template <Value T, int N>
struct IndexTask {
  const Image<T, N>& image;
  const IndexedImage<N>& identity;
  const ActiveTilesOptions& options;

  /// Throws Cancelled where the caller's progress says stop.
  void tell(double fraction) const {
    if (options.progress && !options.progress(fraction))
      throw Error(ErrorCode::Cancelled, fmt::format("building of the index cancelled at {:.0f} %", 100 * fraction));
  }
};

/// Numbers of tiles in trees and buckets.
using TileId = std::uint32_t;

template <Value T, int N>
ActiveTilesPtr<N> make_full_scan(const IndexTask<T, N>& task);

template <Value T, int N>
ActiveTilesPtr<N> build_interval_tree(const IndexTask<T, N>& task);
template <Value T, int N>
ActiveTilesPtr<N> read_interval_tree(IndexReader& from, const IndexTask<T, N>& task);

template <Value T, int N>
ActiveTilesPtr<N> build_span_space(const IndexTask<T, N>& task);
template <Value T, int N>
ActiveTilesPtr<N> read_span_space(IndexReader& from, const IndexTask<T, N>& task);

template <Value T, int N>
ActiveTilesPtr<N> build_min_max_tree(const IndexTask<T, N>& task);
template <Value T, int N>
ActiveTilesPtr<N> read_min_max_tree(IndexReader& from, const IndexTask<T, N>& task);

template <Value T, int N>
ActiveTilesPtr<N> build_seed_index(const IndexTask<T, N>& task);
template <Value T, int N>
ActiveTilesPtr<N> read_seed_index(IndexReader& from, const IndexTask<T, N>& task);

}  // namespace tegl::detail
