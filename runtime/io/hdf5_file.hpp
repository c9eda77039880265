// SPDX-License-Identifier: BSD-3-Clause
//
// The HDF5 C library with handles that close themselves and errors as tegl::Error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <hdf5.h>

#include "tegl/error.hpp"

namespace tegl::io_detail {

/// Closes what it holds; ids below 0 hold nothing.
class H5Handle {
 public:
  using Closer = herr_t (*)(hid_t);
  H5Handle(hid_t id, Closer closer) noexcept : id_(id), closer_(closer) {}
  H5Handle(H5Handle&& other) noexcept : id_(other.id_), closer_(other.closer_) { other.id_ = -1; }
  H5Handle(const H5Handle&) = delete;
  H5Handle& operator=(const H5Handle&) = delete;
  H5Handle& operator=(H5Handle&&) = delete;
  ~H5Handle() {
    if (id_ >= 0) closer_(id_);
  }
  [[nodiscard]] hid_t id() const noexcept { return id_; }
  /// Closes now and says whether that went well.
  bool close() noexcept;

 private:
  hid_t id_;
  Closer closer_;
};

/// Keeps HDF5 from printing its errors for its lifetime.
class H5Quiet {
 public:
  H5Quiet();
  ~H5Quiet();
  H5Quiet(const H5Quiet&) = delete;
  H5Quiet& operator=(const H5Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// A file being written or read; `path` is what messages name. All errors: `code`, with HDF5's innermost reason.
class H5File {
 public:
  /// Creates the file at `where`.
  static H5File create(const std::filesystem::path& where, const std::filesystem::path& path);
  static H5File open(const std::filesystem::path& path);

  /// Writes what is buffered and closes; a full disk may show only here.
  void close();

  [[nodiscard]] H5Handle create_group(const char* name) const;
  [[nodiscard]] H5Handle open_group(const char* name) const;
  [[nodiscard]] bool has(hid_t group, const char* name) const;

  void put_text(hid_t object, const char* name, const std::string& text) const;
  void put_numbers(hid_t object, const char* name, std::span<const std::int64_t> numbers) const;
  /// "" / empty if there is no such attribute or it is of another kind.
  [[nodiscard]] std::string get_text(hid_t object, const char* name) const;
  [[nodiscard]] std::vector<std::int64_t> get_numbers(hid_t object, const char* name) const;

  /// A dataset of rows x columns (columns 0: one-dimensional). `fill(first, count)` returns `count` rows from
  /// `first` as `memory_type`, converted by HDF5 to `file_type`; called in blocks of rows from first to last.
  void write_rows(hid_t group, const char* name, hid_t file_type, hid_t memory_type, std::uint64_t rows,
                  std::uint64_t columns,
                  const std::function<const void*(std::uint64_t first, std::uint64_t count)>& fill) const;

  /// The sizes of a dataset, checked to be no larger than the file can hold; MalformedFile if it is not there.
  [[nodiscard]] std::vector<std::uint64_t> sizes(hid_t group, const char* name) const;
  /// Reads a whole dataset as `memory_type` into room for all its values.
  void read(hid_t group, const char* name, hid_t memory_type, void* to) const;

 private:
  H5File(std::filesystem::path path, ErrorCode code, H5Handle handle)
      : path_(std::move(path)), code_(code), file_(std::move(handle)) {}
  H5Handle checked(hid_t id, H5Handle::Closer closer, const char* what) const;
  void checked(herr_t status, const char* what) const;

  std::filesystem::path path_;
  ErrorCode code_;
  H5Handle file_;
};

}  // namespace tegl::io_detail
