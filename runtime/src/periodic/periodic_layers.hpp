// SPDX-License-Identifier: BSD-3-Clause
//
// An image with periodic axes, longer by one layer along each of them: the first samples are repeated after the last.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "image/row_source.hpp"
#include "tegl/image.hpp"
#include "tegl/layers.hpp"
#include "tegl/periodic.hpp"

namespace tegl::detail {

/// The axis with one more sample, at a period from the first one.
[[nodiscard]] inline Axis longer_axis(const Axis& axis, double period) {
  std::vector<double> coordinates(axis.size());
  for (std::size_t i = 0; i < axis.size(); ++i) coordinates[i] = axis[i];
  coordinates.push_back(axis[0] + (axis.is_descending() ? -period : period));
  const bool is_even =
      axis.is_uniform() && axis[0] + static_cast<double>(axis.size()) * axis.step() == coordinates.back();
  Axis longer =
      is_even ? Axis::uniform(axis.size() + 1, axis[0], axis.step()) : Axis::rectilinear(std::move(coordinates));
  longer.name = axis.name;
  longer.unit = axis.unit;
  return longer;
}

template <int N>
Grid<N> longer_grid(const Grid<N>& grid, const AxisPeriods<N>& periods) {
  Grid<N> longer = grid;
  for (int a = 0; a < N; ++a)
    if (periods[a] != 0.0) longer.axes[a] = longer_axis(grid.axes[a], periods[a]);
  return longer;
}

/// Source for an image in memory of which only the last axis is periodic.
template <Value T, int N>
class RepeatedSource final : public RowSource<T, N> {
 public:
  RepeatedSource(const Image<T, N>& image, const Grid<N>& longer, double isovalue, double epsilon)
      : RowSource<T, N>(image.strides(), image.size(0), isovalue, epsilon, longer.axes[N - 1], 0, true),
        image_(image) {}

 private:
  [[nodiscard]] const T* layer(std::size_t k) const noexcept override {
    return image_.data() + static_cast<std::ptrdiff_t>(k % image_.size(N - 1)) * image_.strides()[N - 1];
  }

  const Image<T, N>& image_;
};

/// The layers of an image that is longer along any axes.
template <Value T, int N>
class PeriodicLayers final : public LayerReader<T, N> {
 public:
  PeriodicLayers(const Image<T, N>& image, const Grid<N>& longer) : image_(image), grid_(longer) {}

  [[nodiscard]] const Grid<N>& grid() const noexcept override { return grid_; }
  void read(std::size_t k, T* to) override {
    const std::size_t row = grid_.axes[0].size();
    const std::ptrdiff_t step = image_.strides()[0];
    std::size_t rows = 1;
    for (int a = 1; a < N - 1; ++a) rows *= grid_.axes[a].size();
    for (std::size_t r = 0; r < rows; ++r, to += row) {
      const T* from = image_.data() + static_cast<std::ptrdiff_t>(k % image_.size(N - 1)) * image_.strides()[N - 1];
      std::size_t rest = r;
      for (int a = 1; a < N - 1; ++a) {
        const std::size_t i = rest % grid_.axes[a].size() % image_.size(a);
        rest /= grid_.axes[a].size();
        from += static_cast<std::ptrdiff_t>(i) * image_.strides()[a];
      }
      const std::size_t samples = image_.size(0);
      if (step == 1)
        std::copy_n(from, samples, to);
      else
        for (std::size_t i = 0; i < samples; ++i) to[i] = from[static_cast<std::ptrdiff_t>(i) * step];
      if (row > samples) to[samples] = from[0];
    }
  }

 private:
  const Image<T, N>& image_;
  Grid<N> grid_;
};

}  // namespace tegl::detail
