// SPDX-License-Identifier: BSD-3-Clause
//
// Files that appear whole or not at all: written under another name beside the target and renamed at the end.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tegl/error.hpp"

namespace tegl::io_detail {

/// The name beside the target: claimed on construction, removed on destruction unless committed.
/// Errors: WriteFailed, naming the target and the reason.
class PendingPath {
 public:
  explicit PendingPath(const std::filesystem::path& target);
  ~PendingPath();
  PendingPath(const PendingPath&) = delete;
  PendingPath& operator=(const PendingPath&) = delete;

  /// Where to write; the file exists and is empty.
  [[nodiscard]] const std::filesystem::path& path() const noexcept { return pending_; }
  /// The target as the user named it, for messages.
  [[nodiscard]] const std::filesystem::path& target() const noexcept { return named_; }
  /// Moves the file, written and closed, to the target.
  void commit();

 private:
  std::filesystem::path named_;
  std::filesystem::path target_;  ///< behind symbolic links
  std::filesystem::path pending_;
  bool done_ = false;
};

/// A pending file with buffered output.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& target);

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  template <class T>
  void write_range(std::span<const T> values) {
    write(values.data(), values.size_bytes());
  }
  /// Flushes, closes and moves the file to its target.
  void commit();
  [[nodiscard]] const std::filesystem::path& target() const noexcept { return pending_.target(); }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  PendingPath pending_;
  std::vector<char> buffer_;
  std::unique_ptr<std::FILE, CloseFile> file_;  ///< closed before the path is removed, hence declared after it
};

}  // namespace tegl::io_detail
