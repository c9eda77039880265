// SPDX-License-Identifier: BSD-3-Clause
//
// The formats of image files that are written.
#pragma once

#include <cstdint>
#include <memory>

#include "base/pending_path.hpp"
#include "tegl/io/image_writer.hpp"

namespace tegl::io_detail {

/// An image to be written: everything except the samples.
struct ImageHead {
  detail::StoredGrid grid;
  ValueType type = ValueType::float32;
  ImageInfo info;
  std::uint64_t layer_bytes = 0;

  [[nodiscard]] std::size_t axes() const noexcept { return grid.axes.size(); }
  [[nodiscard]] double linear(std::size_t row, std::size_t column) const noexcept {
    return grid.linear[row * axes() + column];
  }
  /// Whether the world map keeps an axis separate from the others.
  [[nodiscard]] bool is_separate(std::size_t axis) const noexcept;
  [[nodiscard]] bool has_world_map() const noexcept;
  /// The name of an axis; x, y, z, t, u for axes without.
  [[nodiscard]] std::string axis_name(std::size_t axis) const;
};

/// Writes the samples of a file whose head is written.
class LayerWriter {
 public:
  LayerWriter() = default;
  LayerWriter(const LayerWriter&) = delete;
  LayerWriter& operator=(const LayerWriter&) = delete;
  virtual ~LayerWriter() = default;
  virtual void add(const void* layer) = 0;
  virtual void close() = 0;
};

std::unique_ptr<LayerWriter> write_nrrd(const PendingPath& file, const ImageHead& head);
std::unique_ptr<LayerWriter> write_vti(const PendingPath& file, const ImageHead& head);
std::unique_ptr<LayerWriter> write_netcdf(const PendingPath& file, const ImageHead& head);

}  // namespace tegl::io_detail
