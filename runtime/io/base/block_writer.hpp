// SPDX-License-Identifier: BSD-3-Clause
//
// Writes rows of vertices and simplices to a file in blocks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include "base/common.hpp"
#include "base/output_file.hpp"

namespace tegl::io_detail {

/// Collects the bytes of 65 536 rows, writes them, and reports progress. The file and `progress` must outlive this
/// object.
class BlockWriter {
 public:
  BlockWriter(OutputFile& file, const Progress& progress) : file_(file), progress_(progress) {}

  /// Calls put(row) for all rows; reports progress from `first` to `last`. Throws Cancelled.
  template <class Put>
  void write_rows(std::size_t rows, double first, double last, const Put& put) {
    constexpr std::size_t kBlock = std::size_t{1} << 16;
    for (std::size_t begin = 0; begin < rows; begin += kBlock) {
      tick(progress_, first + (last - first) * static_cast<double>(begin) / static_cast<double>(rows), file_.target());
      block_.clear();
      for (std::size_t row = begin; row < std::min(begin + kBlock, rows); ++row) put(row);
      file_.write(block_.data(), block_.size());
    }
  }

  /// Appends values in their memory representation.
  template <class T>
  void put(const T* values, std::size_t count) {
    const auto* const bytes = reinterpret_cast<const char*>(values);
    block_.insert(block_.end(), bytes, bytes + count * sizeof(T));
  }
  void put_byte(unsigned char byte) { block_.push_back(static_cast<char>(byte)); }
  void put_text(std::string_view text) { block_.insert(block_.end(), text.begin(), text.end()); }
  template <class... Args>
  void put_format(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(block_), format, std::forward<Args>(args)...);
  }

 private:
  OutputFile& file_;
  const Progress& progress_;
  std::vector<char> block_;
};

}  // namespace tegl::io_detail
