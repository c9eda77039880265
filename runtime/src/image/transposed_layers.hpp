// SPDX-License-Identifier: BSD-3-Clause
//
// Images whose rows are not contiguous in memory, such as arrays in Fortran order whose first axis is the time. Reading
// along axis 0 would use a separate cache line for each sample, and read all lines again for every layer. Layers are
// therefore transposed into rows before processing, as many at a time as share cache lines.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include "base/workers.hpp"
#include "tegl/image.hpp"
#include "tegl/layers.hpp"

namespace tegl::detail {

/// The axis with the smallest stride.
template <Value T, int N>
int nearest_axis(const Image<T, N>& image) {
  int nearest = 0;
  for (int a = 1; a < N; ++a)
    if (image.size(a) > 1 && std::abs(image.strides()[a]) < std::abs(image.strides()[nearest])) nearest = a;
  return nearest;
}

/// Whether transposing pays: the nearest axis is not axis 0, by a sufficient factor, and the image does not fit in
/// caches.
template <Value T, int N>
bool is_better_turned(const Image<T, N>& image) {
  constexpr std::ptrdiff_t kLine = 64 / static_cast<std::ptrdiff_t>(sizeof(T));
  constexpr std::size_t kInCache = std::size_t{1} << 18;
  const int nearest = nearest_axis(image);
  std::size_t samples = 1;
  for (int a = 0; a < N; ++a) samples *= image.size(a);
  return nearest != 0 && 2 * std::abs(image.strides()[nearest]) <= kLine && std::abs(image.strides()[0]) >= kLine &&
         samples * sizeof(T) > kInCache;
}

/// The layers of an image, transposed into rows. Memory: as many layers as there are samples in a cache line.
template <Value T, int N>
class TurnedLayers final : public LayerReader<T, N> {
 public:
  TurnedLayers(const Image<T, N>& image, unsigned threads)
      : image_(image), nearest_(nearest_axis(image)), workers_(threads, [] { return Nothing{}; }) {
    for (int a = 0; a < N - 1; ++a) layer_size_ *= image.size(a);
    if (nearest_ == N - 1) at_once_ = static_cast<std::size_t>(std::max<std::ptrdiff_t>(1, kLine / step(N - 1)));
  }

  [[nodiscard]] const Grid<N>& grid() const noexcept override { return image_.grid(); }

  void read(std::size_t k, T* to) override {
    if (at_once_ == 1) return turn(k, 1, to);
    if (k < first_ || k >= first_ + ready_) {
      first_ = k;
      ready_ = std::min(at_once_, image_.size(N - 1) - k);
      layers_.resize(at_once_ * layer_size_);
      turn(first_, ready_, layers_.data());
    }
    std::copy_n(layers_.data() + (k - first_) * layer_size_, layer_size_, to);
  }

 private:
  struct Nothing {};
  static constexpr std::ptrdiff_t kLine = 64 / static_cast<std::ptrdiff_t>(sizeof(T));
  static constexpr std::size_t kTile = 32;  ///< samples along each of two axes; fits in the first-level cache

  [[nodiscard]] std::ptrdiff_t step(int axis) const {
    return std::max<std::ptrdiff_t>(1, std::abs(image_.strides()[axis]));
  }

  /// Transposes layers first ... first + count - 1, which become contiguous. Works in tiles of axis 0 and the nearest
  /// axis, so that each cache line is read once.
  void turn(std::size_t first, std::size_t count, T* to) {
    std::array<std::size_t, N> size{};      // of the transposed layers
    std::array<std::ptrdiff_t, N> pitch{};  // of `to`
    std::ptrdiff_t next = 1;
    for (int a = 0; a < N; ++a) {
      size[a] = a == N - 1 ? count : image_.size(a);
      pitch[a] = next;
      next *= static_cast<std::ptrdiff_t>(size[a]);
    }
    std::size_t planes = 1;  // planes of axis 0 and the nearest axis
    for (int a = 1; a < N; ++a)
      if (a != nearest_) planes *= size[a];
    // planes in parallel
    const T* const from = image_.data() + static_cast<std::ptrdiff_t>(first) * image_.strides()[N - 1];
    workers_.for_range(planes, 16, [&](std::size_t begin, std::size_t end, Nothing&) {
      for (std::size_t plane = begin; plane < end; ++plane) {
        const T* source = from;
        T* target = to;
        std::size_t rest = plane;
        for (int a = 1; a < N; ++a) {
          if (a == nearest_) continue;
          const auto i = static_cast<std::ptrdiff_t>(rest % size[a]);
          rest /= size[a];
          source += i * image_.strides()[a];
          target += i * pitch[a];
        }
        turn_plane(source, target, size[0], size[nearest_], pitch[nearest_]);
      }
    });
  }

  void turn_plane(const T* source, T* target, std::size_t row, std::size_t rows, std::ptrdiff_t pitch) const {
    const std::ptrdiff_t along = image_.strides()[0];
    const std::ptrdiff_t across = image_.strides()[nearest_];
    for (std::size_t j = 0; j < rows; j += kTile)
      for (std::size_t i = 0; i < row; i += kTile)
        for (std::size_t y = j; y < std::min(rows, j + kTile); ++y)
          for (std::size_t x = i; x < std::min(row, i + kTile); ++x)
            target[static_cast<std::ptrdiff_t>(x) + static_cast<std::ptrdiff_t>(y) * pitch] =
                source[static_cast<std::ptrdiff_t>(x) * along + static_cast<std::ptrdiff_t>(y) * across];
  }

  const Image<T, N>& image_;
  int nearest_;
  Workers<Nothing> workers_;
  std::size_t layer_size_ = 1;
  std::size_t at_once_ = 1;
  std::size_t first_ = 0;
  std::size_t ready_ = 0;
  std::vector<T> layers_;
};

}  // namespace tegl::detail
