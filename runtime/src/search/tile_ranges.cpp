// SPDX-License-Identifier: BSD-3-Clause
//
// Ranges of tiles: first over the rows of samples around a row of tiles, then over neighbours along the row. The loops
// are simple so that the compiler vectorizes them.
#include "search/tile_ranges.hpp"

#include <algorithm>

namespace tegl::detail {

template <Value T, int N>
TileRanges<T, N>::TileRanges(const Image<T, N>& image)
    : image_(image),
      grid_(image.grid().sizes()),
      least_(image.size(0)),
      greatest_(image.size(0)),
      gathered_(image.strides()[0] == 1 ? 0 : image.size(0)) {}

template <Value T, int N>
void TileRanges<T, N>::load(std::size_t row) noexcept {
  std::ptrdiff_t at = 0;
  for (int a = 1; a < N; ++a) {
    at += static_cast<std::ptrdiff_t>(row % grid_.size(a)) * image_.strides()[a];
    row /= grid_.size(a);
  }
  // combine the rows of samples
  missing_ = false;
  for (unsigned corner = 0; corner < kRows; ++corner) {
    const T* samples = image_.data() + at;
    for (int a = 1; a < N; ++a)
      if ((corner >> (a - 1) & 1u) != 0) samples += image_.strides()[a];
    rows_[corner] = samples;
    if (!gathered_.empty()) {
      for (std::size_t i = 0; i < gathered_.size(); ++i)
        gathered_[i] = samples[static_cast<std::ptrdiff_t>(i) * image_.strides()[0]];
      samples = gathered_.data();
    }
    if (corner == 0) {
      std::copy_n(samples, least_.size(), least_.data());
      std::copy_n(samples, greatest_.size(), greatest_.data());
    }
    merge(samples);
  }
  const std::size_t tiles = grid_.size(0);
  // combine neighbours along the row
  for (std::size_t i = 0; i < tiles; ++i) {
    least_[i] = least_[i + 1] < least_[i] ? least_[i + 1] : least_[i];
    greatest_[i] = greatest_[i] < greatest_[i + 1] ? greatest_[i + 1] : greatest_[i];
  }
  if (missing_) leave_out_missing();
}

template <Value T, int N>
void TileRanges<T, N>::merge(const T* samples) noexcept {
  T* const least = least_.data();
  T* const greatest = greatest_.data();
  const std::size_t count = least_.size();
  unsigned missing = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const T value = samples[i];
    least[i] = value < least[i] ? value : least[i];
    greatest[i] = greatest[i] < value ? value : greatest[i];
    if constexpr (std::is_floating_point_v<T>) missing |= value != value ? 1u : 0u;
  }
  missing_ = missing_ || missing != 0;
}

template <Value T, int N>
void TileRanges<T, N>::leave_out_missing() noexcept {
  for (const T* const samples : rows_)
    for (std::size_t i = 0; i < least_.size(); ++i) {
      const T value = samples[static_cast<std::ptrdiff_t>(i) * image_.strides()[0]];
      if (value == value) continue;
      for (std::size_t tile = i > 0 ? i - 1 : 0; tile <= i && tile < grid_.size(0); ++tile)
        least_[tile] = greatest_[tile] = T{};
    }
}

#define TEGL_INSTANTIATE_DIMENSIONS(T, N) template class TileRanges<T, N>;
#include "base/instantiate.hpp"

}  // namespace tegl::detail
