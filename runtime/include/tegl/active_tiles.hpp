// SPDX-License-Identifier: BSD-3-Clause
//
// The active tiles of an image at an isovalue, found without looking at all tiles: an index is built once, and then
// asked for as many isovalues as are wanted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/image.hpp"

namespace tegl {

/// Tiles by number: axis 0 fastest, (samples - 1) of them along every axis.
using TileNumber = std::uint64_t;

/// The tiles between the samples of an image. A row of them is a line along axis 0.
template <int N>
requires DimensionBetween<N, 2, 5>
class TileGrid {
 public:
  using Index = std::array<std::size_t, N>;  ///< of a tile's lowest corner, or sizes, by axis

  TileGrid() = default;
  /// Of an image of so many samples. An axis of one sample (or none) leaves no tiles.
  explicit TileGrid(const Index& samples) noexcept {
    count_ = 1;
    for (int a = 0; a < N; ++a) {
      sizes_[a] = samples[a] > 0 ? samples[a] - 1 : 0;
      strides_[a] = count_;
      count_ *= sizes_[a];
    }
  }
  /// Tiles along an axis.
  [[nodiscard]] std::size_t size(int axis) const noexcept { return sizes_[axis]; }
  /// How much the number grows from a tile to the next along an axis.
  [[nodiscard]] TileNumber stride(int axis) const noexcept { return strides_[axis]; }
  [[nodiscard]] TileNumber count() const noexcept { return count_; }  ///< all tiles
  /// All lines of tiles along axis 0.
  [[nodiscard]] std::size_t rows() const noexcept { return count_ == 0 ? 0 : count_ / sizes_[0]; }

  /// The number of a tile by its lowest corner.
  [[nodiscard]] TileNumber number(const Index& index) const noexcept {
    TileNumber number = 0;
    for (int a = 0; a < N; ++a) number += index[a] * strides_[a];
    return number;
  }
  /// Of the tile's lowest corner. Precondition: number < count().
  [[nodiscard]] Index index(TileNumber number) const noexcept {
    Index index;
    for (int a = 0; a < N; ++a, number /= sizes_[a - 1]) index[a] = number % sizes_[a];
    return index;
  }
  /// Rows by number: tiles row * size(0) ... (row + 1) * size(0) - 1. Precondition: number < count().
  [[nodiscard]] std::size_t row(TileNumber number) const noexcept { return number / sizes_[0]; }

 private:
  Index sizes_{};
  std::array<TileNumber, N> strides_{};
  TileNumber count_ = 0;
};

/// Rows of tiles, a bit each.
class TileRowSet {
 public:
  /// So many rows, none of them in the set.
  explicit TileRowSet(std::size_t rows) : rows_(rows), words_((rows + 63) / 64) {}
  void add(std::size_t row) noexcept { words_[row / 64] |= std::uint64_t{1} << (row % 64); }  ///< puts it in
  /// Puts all of them in.
  void add_all() noexcept;
  /// As `find` tells them, or in any other order. O(tiles).
  template <int N>
  void add_rows_of(const TileGrid<N>& grid, const std::vector<TileNumber>& tiles) noexcept;
  /// Is it in?.
  [[nodiscard]] bool has(std::size_t row) const noexcept { return (words_[row / 64] >> (row % 64) & 1u) != 0; }
  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }  ///< in it or not
  [[nodiscard]] std::size_t count() const noexcept;                  ///< how many are in
  /// ceil(rows / 64) words, lowest bit first; bits behind the last row are 0.
  [[nodiscard]] const std::vector<std::uint64_t>& words() const& noexcept { return words_; }
  [[nodiscard]] std::vector<std::uint64_t> words() const&& { return words_; }  ///< of a temporary: a copy

 private:
  std::size_t rows_;
  std::vector<std::uint64_t> words_;
};

/// How active tiles are found.
enum class ActiveMethod : std::uint8_t {
  full_scan,      ///< every sample is looked at for every isovalue; nothing is built
  interval_tree,  ///< Cignoni et al. 1997; O(log^2 n + k) for k active tiles, as lists are searched by bisection
  span_space,     ///< buckets of tiles by their greatest value, sorted by their least; Livnat et al. 1996, Shen et al.
  min_max_tree,   ///< a pyramid over bricks of tiles; Wilhelms, Van Gelder 1992
  seed_set,       ///< a few tiles, from which the others are reached (tegl/seed_set.hpp); looks at values around them
};
/// "full-scan", "interval-tree", ...
std::string_view active_method_name(ActiveMethod method) noexcept;
/// All methods, in the order of the enumeration.
std::vector<ActiveMethod> active_methods();

/// What is known of the image that an index was built for.
template <int N>
requires DimensionBetween<N, 2, 5>
struct IndexedImage {
  std::array<std::size_t, N> sizes{};  ///< samples
  std::string value_type = {};         ///< "uint8", "int8", "uint16", "int16", "int32", "float" or "double"
  std::uint64_t digest = 0;            ///< of sizes, type and the bits of all values
  bool any_missing = false;            ///< whether any value is NaN

  bool operator==(const IndexedImage&) const = default;  ///< member by member
};

/// What `image` is to an index. Reads all values: as fast as memory. Errors: Cancelled.
template <Value T, int N>
IndexedImage<N> identify(const Image<T, N>& image, unsigned threads = 0, const Progress& progress = {});

/// Where an index is saved to, and loaded from: bytes one after the other. What they throw reaches their caller.
class ByteSink {
 public:
  ByteSink() = default;
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;
  virtual ~ByteSink() = default;
  /// Takes so many bytes.
  virtual void write(const void* data, std::size_t bytes) = 0;
};
/// Where an index is loaded from.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;
  /// Reads up to so many bytes, fewer only at the end; returns how many.
  virtual std::size_t read(void* data, std::size_t bytes) = 0;
};

/// What the file of an index says of it.
struct ActiveTilesHead {
  std::uint32_t version = 0;                      ///< of the format
  ActiveMethod method = ActiveMethod::full_scan;  ///< how tiles are found
  std::vector<std::uint64_t> sizes = {};          ///< of the image: 2 to 5 axes, axis 0 first
  std::string value_type = {};                    ///< as in IndexedImage
  std::uint64_t digest = 0;                       ///< as in IndexedImage
  bool any_missing = false;                       ///< as in IndexedImage
};
/// Reads the beginning of an index, whatever its image. Errors: MalformedFile, UnsupportedFormat as load_active_tiles.
ActiveTilesHead read_active_tiles_head(ByteSource& from);

/// The same, and makes sure that nothing is missing behind it or has changed: reads all of the index, but needs no
/// image. Errors: as above, MalformedFile for a damaged or cut index among them.
ActiveTilesHead check_active_tiles(ByteSource& from);

namespace detail {
class IndexWriter;
}

/// The active tiles of an image at any isovalue T: those with min < T <= max over their corners, and no corner missing.
///
/// Thread-safe, and the answer does not depend on the number of threads. `find`, `find_rows` and `extract` take finite
/// isovalues; InvalidIsovalue otherwise. Some methods look at the image's values when asked (`needs_image`): then the
/// values must outlive the index; the view need not. The values must not change.
template <int N>
requires DimensionBetween<N, 2, 5>
class ActiveTiles {
 public:
  virtual ~ActiveTiles() = default;
  ActiveTiles(const ActiveTiles&) = delete;
  ActiveTiles& operator=(const ActiveTiles&) = delete;

  /// How tiles are found.
  [[nodiscard]] virtual ActiveMethod method() const noexcept = 0;
  [[nodiscard]] const IndexedImage<N>& image() const& noexcept { return image_; }  ///< what it was built for
  [[nodiscard]] IndexedImage<N> image() const&& { return image_; }                 ///< of a temporary: a copy
  [[nodiscard]] const TileGrid<N>& grid() const& noexcept { return grid_; }        ///< the image's tiles
  [[nodiscard]] TileGrid<N> grid() const&& noexcept { return grid_; }              ///< of a temporary: a copy
  /// Bytes that the index holds beside the image.
  [[nodiscard]] virtual std::size_t memory_bytes() const noexcept = 0;
  /// Whether `find` looks at the image's values.
  [[nodiscard]] virtual bool needs_image() const noexcept { return false; }
  /// Whether all active tiles are found. Otherwise (`choose_tiles`) `extract` makes the contour in those that are, as
  /// if there were no others.
  [[nodiscard]] virtual bool is_complete() const noexcept { return true; }

  /// The active tiles, ascending, each once.
  [[nodiscard]] std::vector<TileNumber> find(double isovalue) const;
  /// The rows that have active tiles, and perhaps more: those that are worth looking at.
  [[nodiscard]] TileRowSet find_rows(double isovalue) const;

  /// Writes the index; `load_active_tiles` reads it. The format is described in docs/file-formats.md. Errors: those of
  /// the sink; InvalidArgument where nothing can be saved (`choose_tiles`).
  void save(ByteSink& to) const;

 protected:
  /// For methods: of this image.
  explicit ActiveTiles(IndexedImage<N> image) : image_(std::move(image)), grid_(image_.sizes) {}

  /// Appends the active tiles, each once, in any order. `isovalue` is finite.
  virtual void collect(double isovalue, std::vector<TileNumber>& tiles) const = 0;
  /// Adds at least the rows that have active tiles. By default: those of `collect`.
  virtual void collect_rows(double isovalue, TileRowSet& rows) const;
  /// What follows the head of the file.
  virtual void write(detail::IndexWriter& to) const = 0;

 private:
  IndexedImage<N> image_;
  TileGrid<N> grid_;
};

enum class SeedMethod : std::uint8_t;  // tegl/seed_set.hpp

/// How an index is built.
struct ActiveTilesOptions {
  /// How many threads build; 0, or more than there are: all that the machine has.
  unsigned threads = 0;
  Progress progress = {};  ///< see Progress
  /// Of `seed_set` alone, as in SeedSetOptions: how seeds are found (`cover` unless said otherwise), and in which order
  /// of the axes. Neighbours are those that share a face.
  SeedMethod seed_method{};
  std::vector<int> scan_order = {};  ///< all axes, the one that a scan runs along first
};

/// Builds an index. About linear in the number of tiles, in time and in memory while it is built. Errors: Cancelled;
/// TooLarge for an interval tree or a span space of an image of more than 2^32 tiles; those of find_seeds.
template <Value T, int N>
std::unique_ptr<ActiveTiles<N>> build_active_tiles(const Image<T, N>& image, ActiveMethod method,
                                                   const ActiveTilesOptions& options = {});

/// Reads an index that was saved, and makes sure that it belongs to the image: sizes, value type and digest of the
/// values. Errors: MalformedFile (no index, damaged, or cut short), UnsupportedFormat (written by another version, or
/// on a machine of another byte order), InvalidArgument (an index of another image), Cancelled.
template <Value T, int N>
std::unique_ptr<ActiveTiles<N>> load_active_tiles(ByteSource& from, const Image<T, N>& image,
                                                  const ActiveTilesOptions& options = {});

/// These tiles and no others, whatever the isovalue: for `extract` to make the contour of a part. They should be all
/// tiles that a component of the contour passes, or it is cut open where they end. Tiles with a missing corner are left
/// out. Errors: InvalidArgument unless the numbers are ascending and those of tiles.
template <Value T, int N>
std::unique_ptr<ActiveTiles<N>> choose_tiles(const Image<T, N>& image, std::vector<TileNumber> tiles);

/// As `extract` without an index: the same contour, byte by byte, with the same numbers. Looks at the samples in rows
/// with active tiles alone, and at one for every 32 other rows or so: the time is that of the active rows. The index is
/// trusted: only sizes and value type are compared. If it is not complete, the contour is the one in the tiles that it
/// finds, as if all others had missing corners. Where the border is closed (`close`) next to missing values, all
/// samples are looked at, and the index is of no use. ExtractStats::find_seconds has the time that the index took.
/// Errors: those of `extract`; InvalidArgument for an index of an image of other sizes or value type, or for `close`
/// with one that is not complete.
template <class Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4> Contour<N, Real> extract(const Image<T, N>& image, double isovalue,
                                                            const ExtractOptions& options, const ActiveTiles<N>& active,
                                                            ExtractStats* stats = nullptr);

}  // namespace tegl
