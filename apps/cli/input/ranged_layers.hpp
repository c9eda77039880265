// SPDX-License-Identifier: BSD-3-Clause
//
// Layers that report the range of the values read, for images that are never in memory as a whole.
#pragma once

#include <cstddef>
#include <span>

#include "base/statistics.hpp"
#include "tegl/layers.hpp"

namespace tegl::cli {

/// Layers that update the range of values read, until samples are on both sides of all isovalues from `least` to
/// `most`. The source must live as long.
template <class T, int N>
class RangedLayers final : public LayerReader<T, N> {
 public:
  RangedLayers(LayerReader<T, N>& layers, double least, double most) : layers_(layers), least_(least), most_(most) {
    for (int a = 0; a + 1 < N; ++a) layer_size_ *= grid().axes[static_cast<std::size_t>(a)].size();
  }

  [[nodiscard]] const Grid<N>& grid() const noexcept override { return layers_.grid(); }
  void read(std::size_t k, T* to) override {
    layers_.read(k, to);
    range_.read(std::span<const T>(to, layer_size_), least_, most_);
  }
  /// Whether samples on both sides of all isovalues were read.
  [[nodiscard]] bool has_both_sides() const noexcept { return range_.has_both_sides(least_, most_); }
  /// The range of the values read so far; complete if an isovalue lies outside of it.
  [[nodiscard]] const ValueRange& range() const noexcept { return range_; }
  /// Number of samples of a layer.
  [[nodiscard]] std::size_t layer_size() const noexcept { return layer_size_; }

 private:
  LayerReader<T, N>& layers_;
  double least_, most_;
  std::size_t layer_size_ = 1;
  ValueRange range_;
};

}  // namespace tegl::cli
