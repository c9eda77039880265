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
#include <vector>

#include <fmt/format.h>

#include "search/index_file.hpp"
#include "search/sample_view.hpp"
#include "tegl/active_tiles.hpp"

namespace tegl::detail {

/// The data of an index and how tiles are found in it. The dimension is a run-time value; active_tiles_build.cpp makes
/// ActiveTiles<N> of it.
class IndexMethod {
 public:
  IndexMethod() = default;
  IndexMethod(const IndexMethod&) = delete;
  IndexMethod& operator=(const IndexMethod&) = delete;
  virtual ~IndexMethod() = default;

  // as in ActiveTiles
  [[nodiscard]] virtual std::size_t memory_bytes() const noexcept = 0;
  [[nodiscard]] virtual bool needs_image() const noexcept { return false; }
  virtual void collect(double isovalue, std::vector<TileNumber>& tiles) const = 0;
  virtual void write(IndexWriter& to) const = 0;
  /// Adds the rows that have active tiles, and possibly more. Returns false if the method finds rows only by `collect`.
  virtual bool collect_rows(double /*isovalue*/, TileRowSet& /*rows*/) const { return false; }
};
using IndexMethodPtr = std::unique_ptr<IndexMethod>;

/// Input of a method. `options` must outlive building or reading; the samples must also outlive the index.
template <Value T>
struct IndexTask {
  SampleView<T> samples;
  TileShape tiles;
  const ActiveTilesOptions& options;

  /// Throws Cancelled if the caller's progress callback returns false.
  void tell(double fraction) const {
    if (options.work.progress && !options.work.progress(fraction))
      throw Error(ErrorCode::Cancelled, fmt::format("building of the index cancelled at {:.0f} %", 100 * fraction));
  }
};

/// Tile number in trees and buckets.
using TileId = std::uint32_t;

template <Value T>
IndexMethodPtr make_full_scan(const IndexTask<T>& task);

template <Value T>
IndexMethodPtr build_interval_tree(const IndexTask<T>& task);
template <Value T>
IndexMethodPtr read_interval_tree(IndexReader& from, const IndexTask<T>& task);

template <Value T>
IndexMethodPtr build_span_space(const IndexTask<T>& task);
template <Value T>
IndexMethodPtr read_span_space(IndexReader& from, const IndexTask<T>& task);

template <Value T>
IndexMethodPtr build_min_max_tree(const IndexTask<T>& task);
template <Value T>
IndexMethodPtr read_min_max_tree(IndexReader& from, const IndexTask<T>& task);

template <Value T>
IndexMethodPtr build_seed_index(const IndexTask<T>& task);
template <Value T>
IndexMethodPtr read_seed_index(IndexReader& from, const IndexTask<T>& task);

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
