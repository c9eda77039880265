// SPDX-License-Identifier: BSD-3-Clause
//
// Layers of an image with periodic axes, read one by one. Those that follow the last one again stay in memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "periodic/periodic_layers.hpp"
#include "tegl/layers.hpp"

namespace tegl::detail {

/// The current layers of a reader, longer along their periodic axes, for one extraction or several that advance by the
/// same batches. If the last axis is periodic, the first two layers stay in memory. With normals, the last layer is
/// then read first and stays, too: the gradients in layer 0 need it.
template <Value T, int N>
class PeriodicRing {
 public:
  PeriodicRing(LayerReader<T, N>& reader, const AxisPeriods<N>& periods, bool normals)
      : reader_(reader),
        layout_(reader.grid(), periods, normals),
        layers_(reader.grid().axes[N - 1].size()),
        repeats_(periods[N - 1] != 0.0),
        reads_last_first_(repeats_ && normals) {
    std::size_t stride = 1;
    for (int a = 0; a < N - 1; ++a) {
      stored_strides_[a] = static_cast<std::ptrdiff_t>(stride);
      stride *= reader.grid().axes[a].size();
    }
    stored_.resize(stride == layout_.size() ? 0 : stride);
  }

  [[nodiscard]] const Grid<N>& grid() const noexcept { return reader_.grid(); }
  [[nodiscard]] const LongerLayers<N>& layout() const noexcept { return layout_; }
  /// Call before the first layer is read.
  void keep(std::size_t layers) { ring_.resize(std::max(ring_.size(), layers)); }
  /// Reads layer k of the longer image, the next one, unless another extraction already did.
  void prepare(std::size_t k) {
    if (k < read_) return;
    read_ = k + 1;
    if (k == 0 && reads_last_first_) read(layers_ - 1, last_);
    if (k >= layers_ || (reads_last_first_ && k + 1 == layers_)) return;
    read(k, stays(k) ? first_[k] : ring_[k % ring_.size()]);
  }
  /// First sample of layer k of the longer image. Also of one layer before the first one, and of one behind the last
  /// one.
  [[nodiscard]] const T* layer(std::size_t k) const noexcept { return buffer(k).data() + layout_.first(); }

 private:
  [[nodiscard]] bool stays(std::size_t k) const noexcept { return repeats_ && k < first_.size(); }
  [[nodiscard]] const Buffer<T>& buffer(std::size_t k) const noexcept {
    if (reads_last_first_ && (k + 1 == 0 || k + 1 == layers_)) return last_;
    if (repeats_ && k >= layers_) return first_[k - layers_];
    return stays(k) ? first_[k] : ring_[k % ring_.size()];
  }
  void read(std::size_t k, Buffer<T>& to) {
    to.resize(layout_.size());
    if (stored_.empty()) return reader_.read(k, to.data());
    reader_.read(k, stored_.data());
    layout_.copy(stored_.data(), stored_strides_, to.data());
  }

  LayerReader<T, N>& reader_;
  LongerLayers<N> layout_;
  std::size_t layers_;
  bool repeats_;  ///< the last axis is periodic
  bool reads_last_first_;
  std::size_t read_ = 0;  ///< number of layers of the longer image that were prepared
  typename LongerLayers<N>::Strides stored_strides_{};
  Buffer<T> stored_;  ///< a layer of the reader, if it has fewer samples than ours
  Buffer<T> last_;
  std::array<Buffer<T>, 2> first_;
  std::vector<Buffer<T>> ring_;
};

/// Sample source for these layers, with an isovalue.
template <Value T, int N>
class PeriodicLayerSource final : public PeriodicRows<T, N> {
 public:
  PeriodicLayerSource(PeriodicRing<T, N>& ring, const AxisPeriods<N>& periods, const Grid<N>& longer, double isovalue,
                      double epsilon)
      : PeriodicRows<T, N>(ring.grid(), periods, longer, ring.layout().strides(), isovalue, epsilon, false),
        ring_(ring) {}

  void keep(std::size_t layers) override { ring_.keep(layers); }
  void prepare(std::size_t k) override { ring_.prepare(k); }

 private:
  [[nodiscard]] const T* layer(std::size_t k) const noexcept override { return ring_.layer(k); }

  PeriodicRing<T, N>& ring_;
};

}  // namespace tegl::detail
