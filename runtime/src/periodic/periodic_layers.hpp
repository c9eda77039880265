// SPDX-License-Identifier: BSD-3-Clause
//
// Samples of an image with periodic axes, longer by one layer along each of them: the first samples are repeated after
// the last. For gradients there is a neighbour on both sides of every sample.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
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
    return AxisSteps(wrapped_axis(image_.grid().axes[axis], periods_[axis], 1, 2), 1);
  }

 protected:
  using typename RowSource<T, N>::Strides;
  PeriodicRows(const Image<T, N>& image, const AxisPeriods<N>& periods, const Grid<N>& longer, const Strides& strides,
               double isovalue, double epsilon, bool in_memory)
      : RowSource<T, N>(strides, longer.axes[0].size(), isovalue, epsilon, longer.axes[N - 1], 0, in_memory),
        image_(image),
        periods_(periods) {}

  [[nodiscard]] const Image<T, N>& image() const noexcept { return image_; }
  [[nodiscard]] bool is_periodic(int axis) const noexcept { return periods_[axis] != 0.0; }
  /// First sample of the image's layer at k, which may be one before the first one or up to two behind the last one.
  [[nodiscard]] const T* image_layer(std::size_t k) const noexcept {
    const std::size_t layers = image_.size(N - 1);
    return image_.data() + static_cast<std::ptrdiff_t>((k + layers) % layers) * image_.strides()[N - 1];
  }

 private:
  const Image<T, N>& image_;
  AxisPeriods<N> periods_;
};

/// Source for an image of which only the last axis is periodic. Nothing is copied.
template <Value T, int N>
class RepeatedSource final : public PeriodicRows<T, N> {
 public:
  RepeatedSource(const Image<T, N>& image, const AxisPeriods<N>& periods, const Grid<N>& longer,
                 const ExtractOptions& options, double isovalue)
      : PeriodicRows<T, N>(image, periods, longer, image.strides(), isovalue, options.epsilon, true) {}

 private:
  [[nodiscard]] const T* layer(std::size_t k) const noexcept override { return this->image_layer(k); }
};

/// Source for an image with any periodic axes. The layers in use are copied, longer along their periodic axes.
template <Value T, int N>
class CopiedSource final : public PeriodicRows<T, N> {
 public:
  CopiedSource(const Image<T, N>& image, const AxisPeriods<N>& periods, const Grid<N>& longer,
               const ExtractOptions& options, double isovalue)
      : CopiedSource(image, periods, longer, Layout(longer, periods, options.normals != Normals::none), options,
                     isovalue) {}

  void keep(std::size_t layers) override { ring_.resize(layers + 3); }
  void prepare(std::size_t k) override {
    const bool wraps = layout_.margin != 0 && this->is_periodic(N - 1);
    if (k == 0 && wraps) copy(k - 1);
    copy(k);
    if (k + 1 == layers_ && wraps) copy(k + 1);
  }

 private:
  using typename PeriodicRows<T, N>::Strides;
  /// Where the samples of a copied layer are. With normals, there is one more sample at both ends.
  struct Layout {
    Layout(const Grid<N>& longer, const AxisPeriods<N>& periods, bool normals) : margin(normals ? 1 : 0) {
      for (int a = 0; a < N - 1; ++a) {
        before[a] = periods[a] != 0.0 ? margin : 0;
        strides[a] = static_cast<std::ptrdiff_t>(size);
        first += before[a] * size;
        sizes[a] = longer.axes[a].size() + 2 * before[a];
        size *= sizes[a];
      }
    }
    std::size_t margin, size = 1, first = 0;
    Strides strides{};
    std::array<std::size_t, N> sizes{}, before{};
  };

  CopiedSource(const Image<T, N>& image, const AxisPeriods<N>& periods, const Grid<N>& longer, const Layout& layout,
               const ExtractOptions& options, double isovalue)
      : PeriodicRows<T, N>(image, periods, longer, layout.strides, isovalue, options.epsilon, false),
        layout_(layout),
        layers_(longer.axes[N - 1].size()) {}

  [[nodiscard]] const T* layer(std::size_t k) const noexcept override {
    return ring_[(k + 1) % ring_.size()].data() + layout_.first;
  }
  void copy(std::size_t k) {
    Buffer<T>& layer = ring_[(k + 1) % ring_.size()];
    layer.resize(layout_.size);
    const T* const samples = this->image_layer(k);
    const std::size_t row = layout_.sizes[0];
    for (std::size_t r = 0; r < layout_.size / row; ++r) {
      const T* from = samples;
      std::size_t rest = r;
      for (int a = 1; a < N - 1; ++a) {
        const std::size_t size = this->image().size(a);
        const std::size_t i = (rest % layout_.sizes[a] + size - layout_.before[a]) % size;
        rest /= layout_.sizes[a];
        from += static_cast<std::ptrdiff_t>(i) * this->image().strides()[a];
      }
      copy_row(from, layer.data() + r * row);
    }
  }
  void copy_row(const T* from, T* to) const {
    const std::size_t size = this->image().size(0), before = layout_.before[0];
    const std::ptrdiff_t step = this->image().strides()[0];
    const auto at = [&](std::size_t i) { return from[static_cast<std::ptrdiff_t>(i) * step]; };
    for (std::size_t i = 0; i < before; ++i) to[i] = at(size - before + i);
    if (step == 1)
      std::copy_n(from, size, to + before);
    else
      for (std::size_t i = 0; i < size; ++i) to[before + i] = at(i);
    for (std::size_t i = before + size; i < layout_.sizes[0]; ++i) to[i] = at(i - before - size);
  }

  Layout layout_;
  std::size_t layers_;
  std::vector<Buffer<T>> ring_;
};

}  // namespace tegl::detail
