// SPDX-License-Identifier: BSD-3-Clause
//
// HDF5 files and datasets with errors as tegl::Error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <hdf5.h>

#include "base/hdf5_driver.hpp"
#include "base/hdf5_handle.hpp"
#include "tegl/error.hpp"
#include "tegl/io.hpp"

namespace tegl::io_detail {

/// A dataset that grows by rows at its end: chunked, so that memory holds a few chunks whatever its length.
class H5Table {
 public:
  /// `rows` rows, given as `memory_type`, converted by HDF5 to the file's type.
  void append(hid_t memory_type, const void* values, std::uint64_t rows);
  /// One value of a row that is there already.
  void replace(hid_t memory_type, const void* value, std::uint64_t row, std::uint64_t column);
  [[nodiscard]] std::uint64_t rows() const noexcept { return rows_; }
  [[nodiscard]] hid_t id() const noexcept { return dataset_.id(); }

 private:
  friend class H5File;
  H5Table(std::filesystem::path path, std::shared_ptr<const H5WriteStatus> status, H5Handle dataset,
          std::uint64_t columns)
      : path_(std::move(path)), status_(std::move(status)), dataset_(std::move(dataset)), columns_(columns) {}
  void write(hid_t memory_type, const void* values, std::span<const std::uint64_t> start,
             std::span<const std::uint64_t> count) const;

  std::filesystem::path path_;
  std::shared_ptr<const H5WriteStatus> status_;
  H5Handle dataset_;
  std::uint64_t columns_;  ///< 0: one-dimensional
  std::uint64_t rows_ = 0;
};

/// A file being written or read; `path` is what messages name. Errors: WriteFailed or MalformedFile, with the system's
/// reason or HDF5's innermost one.
class H5File {
 public:
  /// Creates the file at `where`.
  static H5File create(const std::filesystem::path& where, const std::filesystem::path& path);
  /// Opens a file to be read, after a check of the files that it leads to (hdf5_links.hpp).
  static H5File open(const std::filesystem::path& path, bool allow_outside_paths);

  /// Writes what is buffered and closes; a full disk may show only here.
  void close();

  [[nodiscard]] H5Handle create_group(const char* name) const;
  [[nodiscard]] H5Handle open_group(const char* name) const;
  [[nodiscard]] bool has(hid_t group, const char* name) const;
  [[nodiscard]] H5Handle open_dataset(hid_t group, const char* name) const;
  /// The names of a group's datasets of numbers, in alphabetical order.
  [[nodiscard]] std::vector<std::string> number_datasets(hid_t group) const;

  void put_text(hid_t object, const char* name, const std::string& text) const;
  void put_numbers(hid_t object, const char* name, std::span<const std::int64_t> numbers) const;
  /// "" / empty if there is no such attribute or it is of another kind.
  [[nodiscard]] std::string get_text(hid_t object, const char* name) const;
  [[nodiscard]] std::vector<std::int64_t> get_numbers(hid_t object, const char* name) const;

  /// An empty dataset of rows of `columns` values (0: one-dimensional), to be appended to: `expected` rows, or however
  /// many. Must not outlive the file.
  [[nodiscard]] H5Table create_table(hid_t group, const char* name, hid_t file_type, std::uint64_t columns,
                                     std::uint64_t expected, Compression compression = Compression::none) const;

  /// How many dimensions a dataset has.
  [[nodiscard]] int rank(hid_t group, const char* name) const;
  /// The sizes of a dataset, checked to be no larger than what the file stores of it, and not in larger chunks than can
  /// be read in about its own memory; MalformedFile if it is not there.
  [[nodiscard]] std::vector<std::uint64_t> sizes(hid_t group, const char* name) const;
  /// The same for a dataset that memory is taken for: what the file stores of all of them together cannot be more than
  /// the file and those that it leads to.
  std::vector<std::uint64_t> claim(hid_t group, const char* name);
  /// Reads a whole dataset, of one or two dimensions, as `memory_type` into room for all its values: some rows at a
  /// time, after which `done` is called with the number of bytes in memory that they take.
  void read(hid_t group, const char* name, hid_t memory_type, void* to,
            const std::function<void(std::uint64_t)>& done = {}) const;

 private:
  H5File(std::filesystem::path path, ErrorCode code, std::shared_ptr<const H5WriteStatus> status, H5Handle handle)
      : path_(std::move(path)), code_(code), status_(std::move(status)), file_(std::move(handle)) {}
  H5Handle checked(hid_t id, H5Handle::Closer closer, const char* what) const;
  void checked(herr_t status, const char* what) const;
  struct StoredSizes {
    std::vector<std::uint64_t> sizes;
    std::uint64_t bytes = 0;   ///< of all values
    std::uint64_t stored = 0;  ///< of these, in the file; 0 for a view of other datasets
  };
  [[nodiscard]] StoredSizes stored(hid_t group, const char* name) const;

  std::filesystem::path path_;
  ErrorCode code_;
  std::shared_ptr<const H5WriteStatus>
      status_;  ///< null for files that are read; outlives the file, which reports to it
  H5Handle file_;
  std::uint64_t bytes_ = 0;  ///< of a file that is read and of those that it leads to
  StoredSizes claimed_;      ///< sums over the datasets that are read
};

/// How many bytes a filter makes of one at most: deflate kMostInflation; others are limited by choice.
[[nodiscard]] std::uint64_t most_expansion_by(H5Z_filter_t filter);

/// Memory that a chunk of a dataset takes, which is decompressed whole: at most twice that of the dataset, or 16 MiB
/// (the largest default of netCDF-4).
inline constexpr std::uint64_t kMostChunkBytes = std::uint64_t{1} << 24;
[[nodiscard]] inline bool is_chunk_too_large(std::uint64_t chunk_bytes, std::uint64_t dataset_bytes) {
  return chunk_bytes > kMostChunkBytes && chunk_bytes / 2 > dataset_bytes;
}

}  // namespace tegl::io_detail
