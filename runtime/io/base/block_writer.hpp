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

/// Collects the bytes of many rows, writes them, and reports progress. The file and `progress` must outlive this
/// object.
class BlockWriter {
 public:
  BlockWriter(OutputFile& file, const Progress& progress) : file_(file), progress_(progress) {}

  /// For rows of `row_bytes` bytes: calls fill(begin, end, to) for blocks of rows, to write the bytes of these rows to
  /// `to`; reports progress from `first` to `last`. Throws Cancelled.
  template <class Fill>
  void write_blocks(std::size_t rows, std::size_t row_bytes, double first, double last, const Fill& fill) {
    constexpr std::size_t kBytes = std::size_t{1} << 19;  // fits in the processor's cache
    const std::size_t most = std::max<std::size_t>(1, kBytes / row_bytes);
    block_.resize(std::min(most, rows) * row_bytes);
    for (std::size_t begin = 0; begin < rows; begin += most) {
      report(begin, rows, first, last);
      const std::size_t end = std::min(begin + most, rows);
      fill(begin, end, block_.data());
      file_.write(block_.data(), (end - begin) * row_bytes);
    }
  }

  /// For rows of text: calls put(row) for all rows; otherwise as write_blocks.
  template <class Put>
  void write_rows(std::size_t rows, double first, double last, const Put& put) {
    constexpr std::size_t kBlock = std::size_t{1} << 16;
    for (std::size_t begin = 0; begin < rows; begin += kBlock) {
      report(begin, rows, first, last);
      block_.clear();
      for (std::size_t row = begin; row < std::min(begin + kBlock, rows); ++row) put(row);
      file_.write(block_.data(), block_.size());
    }
  }

  void put_text(std::string_view text) { block_.insert(block_.end(), text.begin(), text.end()); }
  template <class... Args>
  void put_format(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(block_), format, std::forward<Args>(args)...);
  }

 private:
  void report(std::size_t row, std::size_t rows, double first, double last) const {
    tick(progress_, first + (last - first) * static_cast<double>(row) / static_cast<double>(rows), file_.target());
  }

  OutputFile& file_;
  const Progress& progress_;
  std::vector<char> block_;
};

}  // namespace tegl::io_detail
