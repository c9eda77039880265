// SPDX-License-Identifier: BSD-3-Clause
//
// The methods to find active tiles. Each index is built from an image or read from a file, whose head identifies the
// image.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "search/index_file.hpp"
#include "tegl/active_tiles.hpp"

namespace tegl::detail {

template <int N>
using ActiveTilesPtr = std::unique_ptr<tegl::ActiveTiles<N>>;

/// Input of a method. All members must outlive building or reading; the samples must also outlive the index.
template <Value T, int N>
struct IndexTask {
  const Image<T, N>& image;
  const IndexedImage<N>& identity;
  const ActiveTilesOptions& options;

  /// Throws Cancelled if the caller's progress callback returns false.
  void tell(double fraction) const {
    if (options.work.progress && !options.work.progress(fraction))
      throw Error(ErrorCode::Cancelled, fmt::format("building of the index cancelled at {:.0f} %", 100 * fraction));
  }
};

/// Tile number in trees and buckets.
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

inline constexpr std::array<char, 8> kIndexMagic = {'T', 'E', 'G', 'L', 'I', 'D', 'X', '\n'};
inline constexpr std::uint32_t kIndexByteOrder = 0x01020304;
/// Raise it with every change of the format after it.
inline constexpr std::uint32_t kIndexVersion = 1;

void write_magic(IndexWriter& to, ActiveMethod method, int dim);

template <int N>
void write_head(IndexWriter& to, ActiveMethod method, const IndexedImage<N>& image) {
  write_magic(to, method, N);
  for (const std::size_t size : image.sizes) to.value(std::uint64_t{size});
  to.text(name_of(image.value_type));
  to.value(image.digest);
  to.value(static_cast<std::uint8_t>(image.any_missing ? 1 : 0));
}

/// Throws MalformedFile, UnsupportedFormat.
ActiveTilesHead read_head(IndexReader& from);

/// Throws InvalidArgument with the difference.
void require_same_image(const ActiveTilesHead& head, std::span<const std::size_t> sizes, ValueType value_type,
                        std::uint64_t digest);

}  // namespace tegl::detail
