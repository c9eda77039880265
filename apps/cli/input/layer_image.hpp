// SPDX-License-Identifier: BSD-3-Clause
//
// An image of which a program reads only the layers that cuts across its last axis need.
#pragma once

#include <cstddef>
#include <vector>

#include "input/ranged_layers.hpp"
#include "tegl/contour.hpp"
#include "tegl/image.hpp"
#include "tegl/io/images.hpp"
#include "tegl/slice.hpp"

namespace tegl::cli {

/// Whether there are addresses for all samples of this grid.
template <int N>
bool fits_address_space(const Grid<N>& grid, std::size_t sample_bytes) {
  constexpr double kMostBytes = 0x1p45;
  auto bytes = static_cast<double>(sample_bytes);
  for (const Axis& axis : grid.axes) bytes *= static_cast<double>(axis.size());
  return bytes <= kMostBytes;
}

/// An image in memory for all its layers, of which only some are read. The memory of the others is not touched: it
/// costs address space only.
template <Value T, int N>
class LayerImage {
 public:
  explicit LayerImage(RangedLayers<T, N>& layers) : grid(layers.grid()), layers_(layers) {
    values_.resize(layers.layer_size() * grid.axes[N - 1].size());
    is_read_.resize(grid.axes[N - 1].size(), false);
  }

  /// Reads the layers that were not read before. Call it in ascending order for compressed files.
  void read(const LayerRange& range) {
    for (std::size_t k = range.first; k < range.end; ++k) {
      if (is_read_[k]) continue;
      layers_.read(k, values_.data() + k * layers_.layer_size());
      is_read_[k] = true;
    }
  }
  /// Reads other layers for the range of values, without keeping them, until there are samples on both sides of the
  /// isovalue or all are read. Calls tell with the fraction that is done before each layer.
  template <class Tell>
  void complete_range(const Tell& tell) {
    std::vector<T> layer(layers_.layer_size());
    for (std::size_t k = 0; k < is_read_.size() && !layers_.has_both_sides(); ++k) {
      if (is_read_[k]) continue;
      tell(static_cast<double>(k) / static_cast<double>(is_read_.size()));
      layers_.read(k, layer.data());
    }
  }
  /// The range of the values read so far; complete if the isovalue lies outside of it.
  [[nodiscard]] const ValueRange& range() const noexcept { return layers_.range(); }

  /// The image; only layers that were read have their values.
  [[nodiscard]] Image<T, N> view() const& { return Image<T, N>(values_.data(), grid); }
  Image<T, N> view() const&& = delete;  ///< a view of a temporary would dangle

  Grid<N> grid;  ///< of the whole image

 private:
  RangedLayers<T, N>& layers_;
  Buffer<T> values_;
  std::vector<bool> is_read_;
};

/// Whether read_image may give other values than layers of type double: integers of 32 or 64 bits in the file, which
/// become int32 there if all of them fit.
inline bool may_be_whole_numbers(const ImageInfo& info) {
  switch (info.stored_type.value_or(ValueType::float64)) {
    case ValueType::int32:
    case ValueType::uint32:
    case ValueType::int64:
    case ValueType::uint64:
      return true;
    default:
      return false;
  }
}

}  // namespace tegl::cli
