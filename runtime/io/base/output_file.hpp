// SPDX-License-Identifier: BSD-3-Clause
//
// Buffered output to files that appear complete or not at all.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "tegl/error.hpp"
#include "tegl/io/pending_path.hpp"

namespace tegl::io_detail {

/// A PendingPath with buffered output.
class OutputFile {
 public:
  explicit OutputFile(const std::filesystem::path& target);

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  template <class T>
  void write_range(std::span<const T> values) {
    write(values.data(), values.size_bytes());
  }
  /// Flushes, closes and renames the file to its target.
  void commit();
  [[nodiscard]] const std::filesystem::path& target() const noexcept { return pending_.target(); }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  PendingPath pending_;
  std::vector<char> buffer_;
  std::unique_ptr<std::FILE, CloseFile> file_;  ///< after pending_: closed before that removes the file
};

}  // namespace tegl::io_detail
