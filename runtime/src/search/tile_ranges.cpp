// SPDX-License-Identifier: BSD-3-Clause
//
// Ranges of tiles: first over the rows of samples around a row of tiles, then over neighbours along the row. The loops
// are simple so that the compiler vectorizes them.
#include "search/tile_ranges.hpp"

#include <algorithm>

namespace tegl::detail {

template <Value T>
TileRanges<T>::TileRanges(const SampleView<T>& samples)
    : samples_(samples),
      grid_(samples.axes()),
      least_(samples.sizes[0]),
      greatest_(samples.sizes[0]),
      gathered_(samples.strides[0] == 1 ? 0 : samples.sizes[0]) {}

template <Value T>
void TileRanges<T>::load(std::size_t row) noexcept {
  std::ptrdiff_t at = 0;
  for (int a = 1; a < grid_.dim(); ++a) {
    at += static_cast<std::ptrdiff_t>(row % grid_.size(a)) * samples_.strides[a];
    row /= grid_.size(a);
  }
  // combine the rows of samples
  missing_ = false;
  for (unsigned corner = 0; corner < 1u << (grid_.dim() - 1); ++corner) {
    const T* samples = samples_.data + at;
    for (int a = 1; a < grid_.dim(); ++a)
      if ((corner >> (a - 1) & 1u) != 0) samples += samples_.strides[a];
    rows_[corner] = samples;
    if (!gathered_.empty()) {
      for (std::size_t i = 0; i < gathered_.size(); ++i)
        gathered_[i] = samples[static_cast<std::ptrdiff_t>(i) * samples_.strides[0]];
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

template <Value T>
void TileRanges<T>::merge(const T* samples) noexcept {
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

template <Value T>
void TileRanges<T>::leave_out_missing() noexcept {
  for (unsigned corner = 0; corner < 1u << (grid_.dim() - 1); ++corner)
    for (std::size_t i = 0; i < least_.size(); ++i) {
      const T value = rows_[corner][static_cast<std::ptrdiff_t>(i) * samples_.strides[0]];
      if (value == value) continue;
      for (std::size_t tile = i > 0 ? i - 1 : 0; tile <= i && tile < grid_.size(0); ++tile)
        least_[tile] = greatest_[tile] = T{};
    }
}

#define TEGL_INSTANTIATE(T) template class TileRanges<T>;
#include "base/instantiate.hpp"

}  // namespace tegl::detail
