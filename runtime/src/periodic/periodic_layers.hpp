// SPDX-License-Identifier: BSD-3-Clause
//
// Samples of an image with periodic axes, longer by one layer along each of them: the first samples are repeated after
// the last. For gradients there is a neighbour on both sides of every sample.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "image/row_source.hpp"
#include "tegl/image.hpp"
#include "tegl/periodic.hpp"

namespace tegl::detail {

/// The coordinates of an axis from `before` samples before its first one, which are the last ones a period away, to
/// `behind` samples after its last one.
[[nodiscard]] inline Axis wrapped_axis(const Axis& axis, double period, std::size_t before, std::size_t behind) {
  const std::size_t count = axis.size();
  const double turn = axis.is_descending() ? -period : period;
  std::vector<double> coordinates;
  for (std::size_t i = count - before; i < count; ++i) coordinates.push_back(axis[i] - turn);
  for (std::size_t i = 0; i < count; ++i) coordinates.push_back(axis[i]);
  for (std::size_t i = 0; i < behind; ++i) coordinates.push_back(axis[i] + turn);
  const bool is_even = axis.is_uniform() && axis[0] + static_cast<double>(count) * axis.step() == axis[0] + turn;
  Axis result = is_even ? Axis::uniform(coordinates.size(), coordinates[0], axis.step())
                        : Axis::rectilinear(std::move(coordinates));
  result.name = axis.name;
  result.unit = axis.unit;
  return result;
}

template <int N>
Grid<N> longer_grid(const Grid<N>& grid, const AxisPeriods<N>& periods) {
  Grid<N> longer = grid;
  for (int a = 0; a < N; ++a)
    if (periods[a] != 0.0) longer.axes[a] = wrapped_axis(grid.axes[a], periods[a], 0, 1);
  return longer;
}

/// Base of the sources: rows with neighbours across the seam.
template <Value T, int N>
class PeriodicRows : public RowSource<T, N> {
 public:
  [[nodiscard]] AxisSteps steps(int axis, const Axis& here) const override {
    if (!is_periodic(axis)) return AxisSteps(here);
    return AxisSteps(wrapped_axis(grid_.axes[axis], periods_[axis], 1, 2), 1);
  }

 protected:
  using typename RowSource<T, N>::Strides;
  /// `grid`: of the image.
  PeriodicRows(const Grid<N>& grid, const AxisPeriods<N>& periods, const Grid<N>& longer, const Strides& strides,
               double isovalue, double epsilon, bool in_memory)
      : RowSource<T, N>(strides, longer.axes[0].size(), isovalue, epsilon, longer.axes[N - 1], 0, in_memory),
        grid_(grid),
        periods_(periods) {}

  [[nodiscard]] bool is_periodic(int axis) const noexcept { return periods_[axis] != 0.0; }

 private:
  const Grid<N>& grid_;
  AxisPeriods<N> periods_;
};

/// First sample of the image's layer at k, which may be one before the first one or up to two behind the last one.
template <Value T, int N>
const T* repeated_layer(const Image<T, N>& image, std::size_t k) noexcept {
  const std::size_t layers = image.size(N - 1);
  return image.data() + static_cast<std::ptrdiff_t>((k + layers) % layers) * image.strides()[N - 1];
}

/// Source for an image of which only the last axis is periodic. Nothing is copied.
template <Value T, int N>
class RepeatedSource final : public PeriodicRows<T, N> {
 public:
  RepeatedSource(const Image<T, N>& image, const AxisPeriods<N>& periods, const Grid<N>& longer,
                 const ExtractOptions& options, double isovalue)
      : PeriodicRows<T, N>(image.grid(), periods, longer, image.strides(), isovalue, options.epsilon, true),
        image_(image) {}

 private:
  [[nodiscard]] const T* layer(std::size_t k) const noexcept override { return repeated_layer(image_, k); }

  const Image<T, N>& image_;
};

/// Layers that are longer along their periodic axes: where their samples are, and how they are copied. With normals,
/// there is one more sample at both ends.
template <int N>
class LongerLayers {
 public:
  using Strides = std::array<std::ptrdiff_t, N>;  ///< of a layer; that of the last axis is not used

  LongerLayers(const Grid<N>& grid, const AxisPeriods<N>& periods, bool normals) : of_image_(grid.sizes()) {
    for (int a = 0; a < N - 1; ++a) {
      before_[a] = periods[a] != 0.0 && normals ? 1 : 0;
      strides_[a] = static_cast<std::ptrdiff_t>(size_);
      first_ += before_[a] * size_;
      sizes_[a] = of_image_[a] + (periods[a] != 0.0 ? 1 : 0) + 2 * before_[a];
      size_ *= sizes_[a];
    }
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }  ///< samples of a copied layer
  [[nodiscard]] const Strides& strides() const noexcept { return strides_; }
  /// Place of the first sample of the image's layer.
  [[nodiscard]] std::size_t first() const noexcept { return first_; }

  /// Copies a layer of the image.
  template <class T>
  void copy(const T* samples, const Strides& strides, T* to) const {
    const std::size_t row = sizes_[0];
    for (std::size_t r = 0; r < size_ / row; ++r) {
      const T* from = samples;
      std::size_t rest = r;
      for (int a = 1; a < N - 1; ++a) {
        const std::size_t i = (rest % sizes_[a] + of_image_[a] - before_[a]) % of_image_[a];
        rest /= sizes_[a];
        from += static_cast<std::ptrdiff_t>(i) * strides[a];
      }
      copy_row(from, strides[0], to + r * row);
    }
  }

 private:
  template <class T>
  void copy_row(const T* from, std::ptrdiff_t step, T* to) const {
    const std::size_t size = of_image_[0], before = before_[0];
    const auto at = [&](std::size_t i) { return from[static_cast<std::ptrdiff_t>(i) * step]; };
    for (std::size_t i = 0; i < before; ++i) to[i] = at(size - before + i);
    if (step == 1) {
      request_next_page(from, size);
      std::copy_n(from, size, to + before);
    } else
      for (std::size_t i = 0; i < size; ++i) to[before + i] = at(i);
    for (std::size_t i = before + size; i < sizes_[0]; ++i) to[i] = at(i - before - size);
  }

  /// Requests the samples 4 KiB behind those of a row: processors fetch ahead by themselves, but not across the end of
  /// a page, and rows of a layer mostly follow one another in memory. The address may be past the end of the image.
  template <class T>
  static void request_next_page(const T* from, std::size_t size) noexcept {
    constexpr std::size_t kLine = 64, kPage = 4096;
    const auto address = reinterpret_cast<std::uintptr_t>(from) + kPage;
    for (std::size_t byte = 0; byte < size * sizeof(T); byte += kLine)
      __builtin_prefetch(reinterpret_cast<const char*>(address + byte), 0, 0);
  }

  std::array<std::size_t, N> of_image_;
  std::size_t size_ = 1, first_ = 0;
  Strides strides_{};
  std::array<std::size_t, N> sizes_{}, before_{};
};

/// Source for an image with any periodic axes. The layers in use are copied, longer along their periodic axes.
template <Value T, int N>
class CopiedSource final : public PeriodicRows<T, N> {
 public:
  CopiedSource(const Image<T, N>& image, const AxisPeriods<N>& periods, const Grid<N>& longer,
               const ExtractOptions& options, double isovalue)
      : CopiedSource(image, periods, longer, LongerLayers<N>(image.grid(), periods, options.normals != Normals::none),
                     options, isovalue) {}

  void keep(std::size_t layers) override { ring_.resize(layers + 3); }
  void prepare(std::size_t k) override {
    const bool wraps = normals_ && this->is_periodic(N - 1);
    if (k == 0 && wraps) copy(k - 1);
    copy(k);
    if (k + 1 == layers_ && wraps) copy(k + 1);
  }

 private:
  CopiedSource(const Image<T, N>& image, const AxisPeriods<N>& periods, const Grid<N>& longer,
               const LongerLayers<N>& layout, const ExtractOptions& options, double isovalue)
      : PeriodicRows<T, N>(image.grid(), periods, longer, layout.strides(), isovalue, options.epsilon, false),
        image_(image),
        layout_(layout),
        normals_(options.normals != Normals::none),
        layers_(longer.axes[N - 1].size()) {}

  [[nodiscard]] const T* layer(std::size_t k) const noexcept override {
    return ring_[(k + 1) % ring_.size()].data() + layout_.first();
  }
  void copy(std::size_t k) {
    Buffer<T>& layer = ring_[(k + 1) % ring_.size()];
    layer.resize(layout_.size());
    layout_.copy(repeated_layer(image_, k), image_.strides(), layer.data());
  }

  const Image<T, N>& image_;
  LongerLayers<N> layout_;
  bool normals_;
  std::size_t layers_;
  std::vector<Buffer<T>> ring_;
};

}  // namespace tegl::detail
