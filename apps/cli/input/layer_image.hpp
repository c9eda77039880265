// SPDX-License-Identifier: BSD-3-Clause
//
// An image of which only the layers are read that cuts across its last axis need.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "input/cuts.hpp"
#include "input/ranged_layers.hpp"
#include "tegl/contour.hpp"
#include "tegl/image.hpp"
#include "tegl/io/images.hpp"

namespace tegl::cli {

/// The layers [first, end) of an image along its last axis.
struct LayersOfCut {
  std::size_t first = 0;
  std::size_t end = 0;
};

/// The layers that slice_image reads for the cut by x_last = at, in coordinates of `Real`: those of the slabs that it
/// meets and, for normals along the gradient, their neighbours. Also the next slab if `at` is a layer's coordinate up
/// to rounding. The world map must not mix the last axis with others. Nullopt if `at` lies outside.
template <class Real, int N>
std::optional<LayersOfCut> layers_of_cut(const Grid<N>& grid, double at, bool normals) {
  constexpr double kOfCoordinate = 8.0 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  constexpr double kOfStep = 1e-6;
  const std::size_t size = grid.axes[N - 1].size();
  LayersOfCut layers{size, 0};
  Grid<N> slab = grid;
  for (std::size_t i = 0; i + 1 < size; ++i) {
    slab.axes[N - 1] = grid.axes[N - 1].part(i, 2);
    const CutAxis ends = space_of(slab).axes.back();
    const double slack =
        kOfStep * (ends.last - ends.first) + kOfCoordinate * std::max(std::abs(ends.first), std::abs(ends.last));
    if (at < ends.first - slack || at > ends.last + slack) continue;
    layers.first = std::min(layers.first, i);
    layers.end = i + 2;
  }
  if (layers.end == 0) return std::nullopt;
  if (normals)
    return LayersOfCut{layers.first - std::min<std::size_t>(layers.first, 1), std::min(layers.end + 1, size)};
  return layers;
}

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
  void read(const LayersOfCut& range) {
    for (std::size_t k = range.first; k < range.end; ++k) {
      if (is_read_[k]) continue;
      layers_.read(k, values_.data() + k * layers_.layer_size());
      is_read_[k] = true;
    }
  }
  /// Reads other layers for the range of values, without keeping them, until there are samples on both sides of the
  /// isovalue or all are read. Calls tell(fraction) before each.
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
  const std::string_view type = info.stored_type;
  return type.find("int") != std::string_view::npos && (type.ends_with("32") || type.ends_with("64"));
}

}  // namespace tegl::cli
