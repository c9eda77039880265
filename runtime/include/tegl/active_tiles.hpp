// SPDX-License-Identifier: BSD-3-Clause
//
// Search structures for active tiles: an index is built once and then finds the active tiles of an image at any
// isovalue without a scan of all tiles.
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
#include "tegl/value_type.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// A tile number: axis 0 fastest, (samples - 1) tiles along every axis.
using TileNumber = std::uint64_t;

/// The tiles between the samples of an image. A row is a line of tiles along axis 0.
template <int N>
requires DimensionBetween<N, 2, 5>
class TileGrid {
 public:
  using Index = std::array<std::size_t, N>;  ///< index of a tile's lowest corner, or sizes, by axis

  TileGrid() = default;
  /// The tiles of an image of `samples`. An axis of one sample or none leaves no tiles.
  explicit TileGrid(const Index& samples) noexcept {
    count_ = 1;
    for (int a = 0; a < N; ++a) {
      sizes_[a] = samples[a] > 0 ? samples[a] - 1 : 0;
      strides_[a] = count_;
      count_ *= sizes_[a];
    }
  }
  /// Number of tiles along an axis.
  [[nodiscard]] std::size_t size(int axis) const noexcept { return sizes_[axis]; }
  /// Difference of the numbers of two adjacent tiles along an axis.
  [[nodiscard]] TileNumber stride(int axis) const noexcept { return strides_[axis]; }
  [[nodiscard]] TileNumber count() const noexcept { return count_; }  ///< number of all tiles
  /// Number of rows: lines of tiles along axis 0.
  [[nodiscard]] std::size_t rows() const noexcept { return count_ == 0 ? 0 : count_ / sizes_[0]; }

  /// The number of a tile, given its lowest corner.
  [[nodiscard]] TileNumber number(const Index& index) const noexcept {
    TileNumber number = 0;
    for (int a = 0; a < N; ++a) number += index[a] * strides_[a];
    return number;
  }
  /// The index of a tile's lowest corner. Precondition: number < count().
  [[nodiscard]] Index index(TileNumber number) const noexcept {
    Index index;
    for (int a = 0; a < N; ++a, number /= sizes_[a - 1]) index[a] = number % sizes_[a];
    return index;
  }
  /// The row of a tile. Row r has tiles r * size(0) ... (r + 1) * size(0) - 1. Precondition: number < count().
  [[nodiscard]] std::size_t row(TileNumber number) const noexcept { return number / sizes_[0]; }

 private:
  Index sizes_{};
  std::array<TileNumber, N> strides_{};
  TileNumber count_ = 0;
};

/// A set of rows of tiles, one bit each.
class TileRowSet {
 public:
  /// An empty set for `rows` rows.
  explicit TileRowSet(std::size_t rows) : rows_(rows), words_((rows + 63) / 64) {}
  void add(std::size_t row) noexcept { words_[row / 64] |= std::uint64_t{1} << (row % 64); }  ///< adds a row
  /// Adds all rows.
  void add_all() noexcept;
  /// Adds the rows of `tiles`, in any order. O(tiles).
  template <int N>
  requires DimensionBetween<N, 2, 5>
  void add_rows_of(const TileGrid<N>& grid, const std::vector<TileNumber>& tiles) noexcept;
  /// Whether a row is in the set.
  [[nodiscard]] bool has(std::size_t row) const noexcept { return (words_[row / 64] >> (row % 64) & 1u) != 0; }
  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }  ///< number of rows, in the set or not
  [[nodiscard]] std::size_t count() const noexcept;                  ///< number of rows in the set
  /// ceil(rows / 64) words, lowest bit first; bits after the last row are 0.
  [[nodiscard]] const std::vector<std::uint64_t>& words() const& noexcept { return words_; }
  [[nodiscard]] std::vector<std::uint64_t> words() const&& { return words_; }  ///< a copy, for temporaries

 private:
  std::size_t rows_;
  std::vector<std::uint64_t> words_;
};

/// Methods to find active tiles.
enum class ActiveMethod : std::uint8_t {
  full_scan,      ///< nothing is built; reads every sample for every isovalue
  interval_tree,  ///< Cignoni et al. 1997; O(log^2 n + k) for k active tiles, because lists are searched by bisection
  span_space,     ///< buckets of tiles by maximum, sorted by minimum; Livnat et al. 1996, Shen et al.
  min_max_tree,   ///< a pyramid of minima and maxima over bricks of tiles; Wilhelms, Van Gelder 1992
  seed_set,       ///< propagates from a few seed tiles (tegl/seed_set.hpp); reads values around active tiles
};
/// "full-scan", "interval-tree", ...
[[nodiscard]] std::string_view active_method_name(ActiveMethod method) noexcept;
/// All methods, in the order of the enumeration.
[[nodiscard]] std::vector<ActiveMethod> active_methods();

/// A fingerprint of the image that an index was built for.
template <int N>
requires DimensionBetween<N, 2, 5>
struct IndexedImage {
  std::array<std::size_t, N> sizes{};  ///< number of samples by axis
  ValueType value_type{};              ///< of the samples
  std::uint64_t digest = 0;            ///< hash of sizes, type and the bits of all values
  bool any_missing = false;            ///< whether any value is NaN

  bool operator==(const IndexedImage&) const = default;  ///< member by member
};

/// Computes the fingerprint of an image. Reads all values, at memory speed. Errors: Cancelled.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] IndexedImage<N> identify(const Image<T, N>& image, const WorkOptions& work = {});

/// A destination for saved indexes: a sequence of bytes. Its exceptions reach the caller.
class ByteSink {
 public:
  ByteSink() = default;
  ByteSink(const ByteSink&) = delete;
  ByteSink& operator=(const ByteSink&) = delete;
  virtual ~ByteSink() = default;
  /// Writes `bytes` bytes.
  virtual void write(const void* data, std::size_t bytes) = 0;
};
/// A source to load an index from. Its exceptions reach the caller.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;
  /// Reads up to `bytes` bytes, fewer only at the end. Returns the number of bytes read.
  virtual std::size_t read(void* data, std::size_t bytes) = 0;
};

/// The header of an index file.
struct ActiveTilesHead {
  std::uint32_t version = 0;                      ///< version of the format
  ActiveMethod method = ActiveMethod::full_scan;  ///< how tiles are found
  std::vector<std::uint64_t> sizes = {};          ///< of the image: 2 to 5 axes, axis 0 first
  ValueType value_type{};                         ///< as in IndexedImage
  std::uint64_t digest = 0;                       ///< as in IndexedImage
  bool any_missing = false;                       ///< as in IndexedImage
};
/// Reads the header of an index of any image. Errors: MalformedFile, UnsupportedFormat, as load_active_tiles.
[[nodiscard]] ActiveTilesHead read_active_tiles_head(ByteSource& from);

/// Reads a whole index, verifies that it is complete and undamaged, and returns its header. Needs no image. Errors: as
/// read_active_tiles_head; MalformedFile also for damaged or truncated data.
ActiveTilesHead check_active_tiles(ByteSource& from);

namespace detail {
class IndexWriter;
}

/// The active tiles of an image at any isovalue T: tiles with min < T <= max over their corners and no missing corner.
///
/// Thread-safe; results do not depend on the number of threads. `find`, `find_rows` and `extract` take finite isovalues
/// and throw InvalidIsovalue otherwise. Some methods read the image's values in queries (`needs_image`): then the
/// values must outlive the index, but the view need not. The values must not change.
template <int N>
requires DimensionBetween<N, 2, 5>
class ActiveTiles {
 public:
  virtual ~ActiveTiles() = default;
  ActiveTiles(const ActiveTiles&) = delete;
  ActiveTiles& operator=(const ActiveTiles&) = delete;

  /// The method of the index.
  [[nodiscard]] virtual ActiveMethod method() const noexcept = 0;
  [[nodiscard]] const IndexedImage<N>& image() const& noexcept { return image_; }  ///< the image it was built for
  [[nodiscard]] IndexedImage<N> image() const&& { return image_; }                 ///< a copy, for temporaries
  [[nodiscard]] const TileGrid<N>& grid() const& noexcept { return grid_; }        ///< the image's tiles
  [[nodiscard]] TileGrid<N> grid() const&& noexcept { return grid_; }              ///< a copy, for temporaries
  /// Size of the index in bytes, without the image.
  [[nodiscard]] virtual std::size_t memory_bytes() const noexcept = 0;
  /// Whether `find` reads the image's values.
  [[nodiscard]] virtual bool needs_image() const noexcept { return false; }
  /// Whether all active tiles are found. False for `choose_tiles`: `extract` then contours only the chosen tiles, as if
  /// there were no others.
  [[nodiscard]] virtual bool is_complete() const noexcept { return true; }

  /// The active tiles, in ascending order, each once.
  [[nodiscard]] std::vector<TileNumber> find(double isovalue) const;
  /// A superset of the rows that have active tiles: the rows that an extraction reads.
  [[nodiscard]] TileRowSet find_rows(double isovalue) const;

  /// Writes the index; `load_active_tiles` reads it. docs/file-formats.md describes the format. Errors: those of the
  /// sink; InvalidArgument for an index that cannot be saved (`choose_tiles`).
  void save(ByteSink& to) const;

 protected:
  /// For derived classes.
  explicit ActiveTiles(IndexedImage<N> image) : image_(std::move(image)), grid_(image_.sizes) {}

  /// Appends the active tiles, each once, in any order. `isovalue` is finite.
  virtual void collect(double isovalue, std::vector<TileNumber>& tiles) const = 0;
  /// Adds the rows that have active tiles, and possibly more. By default the rows of `collect`.
  virtual void collect_rows(double isovalue, TileRowSet& rows) const;
  /// Writes the data after the header.
  virtual void write(detail::IndexWriter& to) const = 0;

 private:
  IndexedImage<N> image_;
  TileGrid<N> grid_;
};

enum class SeedMethod : std::uint8_t;  // tegl/seed_set.hpp

/// Options of build_active_tiles.
struct ActiveTilesOptions {
  WorkOptions work = {};  ///< number of threads and progress
  /// Only for `seed_set`, as in SeedSetOptions: the method to find seeds (`cover` by default) and the scan order.
  /// Neighbours are tiles that share a face.
  SeedMethod seed_method{};
  std::vector<int> scan_order = {};  ///< all axes, fastest first
};

/// Builds an index. Time and temporary memory are about linear in the number of tiles. Errors: Cancelled; TooLarge for
/// an interval tree or a span space of more than 2^32 tiles; those of find_seeds.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::unique_ptr<ActiveTiles<N>> build_active_tiles(const Image<T, N>& image, ActiveMethod method,
                                                                 const ActiveTilesOptions& options = {});

/// Loads a saved index and verifies that it belongs to the image, by sizes, value type and hash of the values. Errors:
/// MalformedFile (not an index, damaged, or truncated), UnsupportedFormat (another version or byte order),
/// InvalidArgument (an index of another image), Cancelled.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::unique_ptr<ActiveTiles<N>> load_active_tiles(ByteSource& from, const Image<T, N>& image,
                                                                const ActiveTilesOptions& options = {});

/// A fixed set of tiles, independent of the isovalue, to contour a part of an image with `extract`. They should include
/// all tiles of a component of the contour; otherwise the contour is open where they end. Tiles with a missing corner
/// are left out. Errors: InvalidArgument unless the numbers are ascending and in range.
template <Value T, int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::unique_ptr<ActiveTiles<N>> choose_tiles(const Image<T, N>& image, std::vector<TileNumber> tiles);

/// As `extract` with an index, with counts and times.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Extraction<N, Real> extract_with_stats(const Image<T, N>& image, double isovalue,
                                                     const ActiveTiles<N>& active, const ExtractOptions& options = {});

/// As `extract` without an index: the same contour, byte by byte. Reads the samples only in rows with active tiles, and
/// about one sample for every 32 other rows, so the time is proportional to the active rows. The index is trusted: only
/// sizes and value type are compared. If it is not complete, the result is the contour in the tiles that it finds, as
/// if all others had missing corners. With `close` and missing values all samples are read, and the index saves no
/// time. ExtractStats::find_seconds has the query time of the index. Errors: those of `extract`; InvalidArgument for an
/// index of an image of other sizes or value type, or for `close` with an index that is not complete.
template <Coordinate Real = float, Value T, int N>
requires DimensionBetween<N, 2, 4>
[[nodiscard]] Contour<N, Real> extract(const Image<T, N>& image, double isovalue, const ActiveTiles<N>& active,
                                       const ExtractOptions& options = {}) {
  return extract_with_stats<Real>(image, isovalue, active, options).contour;
}

}  // namespace tegl
