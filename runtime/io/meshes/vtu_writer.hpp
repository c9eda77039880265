// SPDX-License-Identifier: BSD-3-Clause
//
// Writes VTU, VTK's XML format of unstructured grids, with arrays as raw bytes appended to the XML.
//
// Based on: Kitware, "VTK File Formats" (XML formats, appended data).
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/pending_path.hpp"
#include "tegl/io/write_options.hpp"

namespace tegl::io_detail {

/// Buffers values; `write` receives the bytes in blocks.
class ByteSink {
 public:
  static constexpr std::size_t kBlock = std::size_t{1} << 16;
  using Write = std::function<void(const void*, std::size_t)>;

  explicit ByteSink(Write write) : write_(std::move(write)) { buffer_.reserve(kBlock); }
  template <class T>
  void put(T value) {
    static_assert(kBlock % sizeof value == 0);  // all blocks except the last are full
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

/// An array of a VTU file, with the function that writes it.
struct VtuArray {
  std::string name;
  std::string type;    ///< "Float64", "Float32", "Int64", "Int32", "UInt8"
  unsigned columns;    ///< 1: scalars
  std::uint64_t rows;  ///< announced in the file; `put` must write as many
  unsigned bytes;      ///< size of a value
  std::size_t items;   ///< put(sink, i) is called for i = 0 ... items - 1
  std::function<void(ByteSink&, std::size_t)> put;
};

/// The arrays of a grid, and its axis names and units.
struct VtuGrid {
  std::uint64_t points = 0, cells = 0;
  std::vector<VtuArray> point_arrays, cell_arrays;
  std::string normals;  ///< name of the point array of normals; empty: none
  VtuArray coordinates;
  std::vector<VtuArray> topology;  ///< connectivity, offsets, types; for polyhedra faces and faceoffsets
  std::vector<std::string> axis_names, axis_units;
  std::vector<double> periods = {};  ///< written to the field array "periods", if not empty
};

/// Writes a VTU file to a pending file. With compression, the compressed arrays are held in memory. Errors:
/// WriteFailed, Cancelled.
void write_vtu(const VtuGrid& grid, const PendingPath& file, const WriteOptions& options);

}  // namespace tegl::io_detail
