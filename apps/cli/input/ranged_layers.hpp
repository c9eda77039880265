// SPDX-License-Identifier: BSD-3-Clause
//
// Layers that report the range of the values read, for images that are never in memory as a whole.
#pragma once

#include <cmath>
#include <cstddef>

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
    if (has_both_sides()) return;
    for (std::size_t i = 0; i < layer_size_; ++i) {
      const auto value = static_cast<double>(to[i]);
      if (std::isnan(value)) continue;
      range_.min = std::fmin(range_.min, value);
      range_.max = std::fmax(range_.max, value);
    }
  }
  /// Whether samples on both sides of all isovalues were read.
  [[nodiscard]] bool has_both_sides() const noexcept { return range_.min < least_ && most_ <= range_.max; }
  /// The range of the values read so far; complete if an isovalue lies outside of it.
  [[nodiscard]] const ValueRange& range() const noexcept { return range_; }
  /// Number of samples of a layer.
  [[nodiscard]] std::size_t layer_size() const noexcept { return layer_size_; }

 private:
  LayerReader<T, N>& layers_;
  double least_, most_;
  std::size_t layer_size_ = 1;
  ValueRange range_{static_cast<double>(NAN), static_cast<double>(NAN)};
};

}  // namespace tegl::cli
