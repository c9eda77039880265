// SPDX-License-Identifier: BSD-3-Clause
//
// HDF5 files and datasets, with errors as tegl::Error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <hdf5.h>

#include "base/hdf5_driver.hpp"
#include "base/hdf5_handle.hpp"
#include "tegl/error.hpp"
#include "tegl/io/write_options.hpp"

namespace tegl::io_detail {

/// A dataset that rows are appended to: chunked, so memory holds a few chunks for any length. A file stores chunks
/// whole. So a dataset of an unknown number of rows is created when the first chunk is full, or by `complete` with a
/// chunk of as many rows as there are.
class H5Table {
 public:
  /// Appends `rows` rows of `memory_type`; HDF5 converts them to the file's type.
  void append(hid_t memory_type, const void* values, std::uint64_t rows);
  /// Replaces one value of an existing row.
  void replace(hid_t memory_type, const void* value, std::uint64_t row, std::uint64_t column);
  /// Creates the dataset unless it exists. To be called before the file is closed, if the number of rows was unknown.
  void complete();
  [[nodiscard]] std::uint64_t rows() const noexcept { return rows_; }
  /// Of the dataset, whose number of rows was known.
  [[nodiscard]] hid_t id() const noexcept { return dataset_->id(); }

 private:
  friend class H5File;
  using Create = std::function<H5Handle(std::uint64_t rows)>;
  H5Table(std::filesystem::path path, std::shared_ptr<const H5WriteStatus> status, Create create, std::uint64_t columns,
          std::uint64_t rows_of_chunk)
      : path_(std::move(path)),
        status_(std::move(status)),
        create_(std::move(create)),
        columns_(columns),
        rows_of_chunk_(rows_of_chunk) {}
  /// Creates the dataset, for at least `rows` rows, and writes those that were kept.
  void create(std::uint64_t rows);
  void extend(std::uint64_t rows) const;
  void write(hid_t memory_type, const void* values, std::span<const std::uint64_t> start,
             std::span<const std::uint64_t> count) const;

  std::filesystem::path path_;
  std::shared_ptr<const H5WriteStatus> status_;
  Create create_;  ///< empty after it was called
  std::optional<H5Handle> dataset_;
  std::uint64_t columns_;  ///< 0: one-dimensional
  std::uint64_t rows_of_chunk_;
  std::uint64_t rows_ = 0;
  std::vector<unsigned char> kept_;  ///< rows before the dataset is created
  hid_t kept_type_ = -1;             ///< memory type of these
};

/// An HDF5 file being written or read; messages name `path`. Errors: WriteFailed or MalformedFile, with the system's
/// reason or the innermost reason of HDF5.
class H5File {
 public:
  /// Creates the file `where`.
  static H5File create(const std::filesystem::path& where, const std::filesystem::path& path);
  /// Opens a file for reading, after a check of the files that it refers to (hdf5_links.hpp).
  static H5File open(const std::filesystem::path& path, bool allow_outside_paths);

  /// Flushes and closes; a full disk may only be reported here.
  void close();

  [[nodiscard]] H5Handle create_group(const char* name) const;
  [[nodiscard]] H5Handle open_group(const char* name) const;
  [[nodiscard]] bool has(hid_t group, const char* name) const;
  [[nodiscard]] H5Handle open_dataset(hid_t group, const char* name) const;
  /// The names of a group's numeric datasets, in alphabetical order.
  [[nodiscard]] std::vector<std::string> number_datasets(hid_t group) const;

  void put_text(hid_t object, const char* name, const std::string& text) const;
  void put_numbers(hid_t object, const char* name, std::span<const std::int64_t> numbers) const;
  /// Empty if the attribute does not exist or has another type.
  [[nodiscard]] std::string get_text(hid_t object, const char* name) const;
  [[nodiscard]] std::vector<std::int64_t> get_numbers(hid_t object, const char* name) const;

  /// Creates an empty dataset with rows of `columns` values (0: one-dimensional), for appending. `expected` is a hint
  /// of the number of rows; kUnknownRows: none. Must not outlive the file.
  [[nodiscard]] H5Table create_table(hid_t group, const char* name, hid_t file_type, std::uint64_t columns,
                                     std::uint64_t expected, Compression compression = Compression::none) const;
  static constexpr std::uint64_t kUnknownRows = ~std::uint64_t{0};

  /// Number of dimensions of a dataset.
  [[nodiscard]] int rank(hid_t group, const char* name) const;
  /// The sizes of a dataset. MalformedFile if it does not exist, if it is larger than the bytes stored for it can
  /// expand to, or if its chunks need much more memory than the dataset.
  [[nodiscard]] std::vector<std::uint64_t> sizes(hid_t group, const char* name) const;
  /// As sizes(), for a dataset that will be read into memory: also checks that the stored bytes of all claimed datasets
  /// together do not exceed the file and those that it refers to.
  std::vector<std::uint64_t> claim(hid_t group, const char* name);
  /// Reads a whole dataset of one or two dimensions as `memory_type`; `to` has room for all values. Reads some rows at
  /// a time and then calls `done` with the number of bytes that they take in memory.
  void read(hid_t group, const char* name, hid_t memory_type, void* to,
            const std::function<void(std::uint64_t)>& done = {}) const;

 private:
  H5File(std::filesystem::path path, ErrorCode code, std::shared_ptr<const H5WriteStatus> status, H5Handle handle)
      : path_(std::move(path)), code_(code), status_(std::move(status)), file_(std::move(handle)) {}
  H5Handle checked(hid_t id, H5Handle::Closer closer, const char* what) const;
  void checked(herr_t status, const char* what) const;
  struct StoredSizes {
    std::vector<std::uint64_t> sizes;
    std::uint64_t bytes = 0;   ///< size of all values
    std::uint64_t stored = 0;  ///< bytes of them in the file; 0 for a view of other datasets
  };
  [[nodiscard]] StoredSizes stored(hid_t group, const char* name) const;

  std::filesystem::path path_;
  ErrorCode code_;
  std::shared_ptr<const H5WriteStatus> status_;  ///< null for reading; outlives the file, which reports to it
  H5Handle file_;
  std::uint64_t bytes_ = 0;  ///< size of the file being read and those it refers to
  StoredSizes claimed_;      ///< sums over the claimed datasets
};

/// Maximum expansion ratio of a filter: for deflate kMostInflation, for others a chosen limit.
[[nodiscard]] std::uint64_t most_expansion_by(H5Z_filter_t filter);

/// Maximum memory of a chunk, which HDF5 decompresses as a whole: twice the dataset, or 16 MiB (the largest default of
/// netCDF-4).
inline constexpr std::uint64_t kMostChunkBytes = std::uint64_t{1} << 24;
[[nodiscard]] inline bool is_chunk_too_large(std::uint64_t chunk_bytes, std::uint64_t dataset_bytes) {
  return chunk_bytes > kMostChunkBytes && chunk_bytes / 2 > dataset_bytes;
}

}  // namespace tegl::io_detail
