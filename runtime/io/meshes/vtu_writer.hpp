// SPDX-License-Identifier: BSD-3-Clause
//
// VTU: VTK's XML files of unstructured grids, here with their arrays as raw bytes behind the XML.
//
// Based on: Kitware, "VTK File Formats" (XML formats, appended data).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/output_file.hpp"
#include "tegl/io.hpp"

namespace tegl::io_detail {

/// Values on their way into a file, which `write` gets a block of bytes at a time.
class ByteSink {
 public:
  static constexpr std::size_t kBlock = std::size_t{1} << 16;
  using Write = std::function<void(const void*, std::size_t)>;

  explicit ByteSink(Write write) : write_(std::move(write)) { buffer_.reserve(kBlock); }
  template <class T>
  void put(T value) {
    static_assert(kBlock % sizeof value == 0);  // so that all blocks but the last are full
    if (buffer_.size() == kBlock) flush();
    const auto* const bytes = reinterpret_cast<const char*>(&value);
    buffer_.insert(buffer_.end(), bytes, bytes + sizeof value);
    bytes_ += sizeof value;
  }
  void flush() {
    if (!buffer_.empty()) write_(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }

 private:
  Write write_;
  std::vector<char> buffer_;
  std::uint64_t bytes_ = 0;
};

/// An array of a VTU file.
struct VtuArray {
  std::string name;
  std::string type;    ///< "Float64", "Float32", "Int64", "Int32", "UInt8"
  unsigned columns;    ///< 1: no columns
  std::uint64_t rows;  ///< as they are announced; `put` writes as many
  unsigned bytes;      ///< of a value
  std::size_t items;   ///< put(sink, i) is called for i = 0 ... items - 1
  std::function<void(ByteSink&, std::size_t)> put;
};

/// The arrays of a grid, and words about its axes.
struct VtuGrid {
  std::uint64_t points = 0, cells = 0;
  std::vector<VtuArray> point_arrays, cell_arrays;
  std::string normals;  ///< the name of the point array that is the normals; empty: none
  VtuArray coordinates;
  std::vector<VtuArray> topology;  ///< connectivity, offsets, types; of polyhedra faces and faceoffsets
  std::vector<std::string> axis_names, axis_units;
};

/// With compression the file's arrays are in memory, compressed. Errors: WriteFailed, Cancelled.
void write_vtu(const VtuGrid& grid, const std::filesystem::path& path, const Progress& progress,
               Compression compression);

}  // namespace tegl::io_detail
