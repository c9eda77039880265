// SPDX-License-Identifier: BSD-3-Clause
//
// Samples and tiles of an image whose dimension is a run-time value: code that takes them is compiled once per value
// type, not once per value type and dimension.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tegl/active_tiles.hpp"
#include "tegl/image.hpp"

namespace tegl::detail {

inline constexpr int kMostAxes = 5;

/// A view of the samples of an image. The value of index i is data[sum_a i_a * strides[a]]; strides count elements.
/// Entries of axes from `dim` on are 0.
template <Value T>
struct SampleView {
  template <int N>
  explicit SampleView(const Image<T, N>& image) : data(image.data()), dim(N) {
    for (int a = 0; a < N; ++a) {
      sizes[a] = image.size(a);
      strides[a] = image.strides()[a];
    }
  }
  [[nodiscard]] std::span<const std::size_t> axes() const noexcept {
    return {sizes.data(), static_cast<std::size_t>(dim)};
  }

  const T* data;
  int dim;
  std::array<std::size_t, kMostAxes> sizes{};
  std::array<std::ptrdiff_t, kMostAxes> strides{};
};

/// TileGrid with the dimension at run time. Entries of axes from dim() on are 0.
class TileShape {
 public:
  using Index = std::array<std::size_t, kMostAxes>;

  TileShape() = default;
  explicit TileShape(std::span<const std::size_t> samples) noexcept : dim_(static_cast<int>(samples.size())) {
    count_ = 1;
    for (int a = 0; a < dim_; ++a) {
      sizes_[a] = samples[a] > 0 ? samples[a] - 1 : 0;
      strides_[a] = count_;
      count_ *= sizes_[a];
    }
  }
  [[nodiscard]] int dim() const noexcept { return dim_; }
  [[nodiscard]] std::size_t size(int axis) const noexcept { return sizes_[axis]; }
  [[nodiscard]] TileNumber stride(int axis) const noexcept { return strides_[axis]; }
  [[nodiscard]] TileNumber count() const noexcept { return count_; }
  [[nodiscard]] std::size_t rows() const noexcept { return count_ == 0 ? 0 : count_ / sizes_[0]; }
  [[nodiscard]] std::span<const std::size_t> axes() const noexcept {
    return {sizes_.data(), static_cast<std::size_t>(dim_)};
  }

  [[nodiscard]] TileNumber number(const Index& index) const noexcept {
    TileNumber number = 0;
    for (int a = 0; a < dim_; ++a) number += index[a] * strides_[a];
    return number;
  }
  /// Precondition: number < count().
  [[nodiscard]] Index index(TileNumber number) const noexcept {
    Index index{};
    for (int a = 0; a + 1 < dim_; number /= sizes_[a++]) index[a] = number % sizes_[a];
    index[dim_ - 1] = number;
    return index;
  }
  /// The row of the tile with this index.
  [[nodiscard]] std::size_t row(const Index& index) const noexcept {
    std::size_t row = 0;
    for (int a = dim_; --a > 0;) row = row * sizes_[a] + index[a];
    return row;
  }

 private:
  int dim_ = 0;
  Index sizes_{};
  std::array<TileNumber, kMostAxes> strides_{};
  TileNumber count_ = 0;
};

}  // namespace tegl::detail
