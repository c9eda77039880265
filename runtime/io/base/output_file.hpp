// SPDX-License-Identifier: BSD-3-Clause
//
// Buffered output to a pending file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "base/pending_path.hpp"

namespace tegl::io_detail {

/// Buffered output to the temporary file of a PendingPath, which must live as long. Errors: WriteFailed, with the
/// target and the reason.
class OutputFile {
 public:
  explicit OutputFile(const PendingPath& pending);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(const void* data, std::size_t bytes);
  void write(std::string_view text) { write(text.data(), text.size()); }
  template <class T>
  void write_range(std::span<const T> values) {
    write(values.data(), values.size_bytes());
  }
  /// Flushes and closes the file. The caller commits the PendingPath.
  void close();
  [[nodiscard]] const std::filesystem::path& target() const noexcept { return target_; }

 private:
  void flush();
  void write_through(const char* from, std::size_t bytes);

  std::filesystem::path target_;
  std::vector<char> buffer_;
  int descriptor_ = -1;
};

}  // namespace tegl::io_detail
