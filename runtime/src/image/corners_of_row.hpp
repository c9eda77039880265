// SPDX-License-Identifier: BSD-3-Clause
//
// Samples around the tiles of one row of a 4D image. If many of a row's tiles need the samples at their corners, it is
// faster to convert the samples of the whole row once, as adjacent tiles share half of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "image/sample_source.hpp"

namespace tegl::detail {

class CornersOfRow {
 public:
  /// Distance between the values of corners that differ along axis 1, 2 or 3: kPitch times 1, 2 or 4.
  static constexpr std::size_t kPitch = kWordBits + 8;
  /// Where the value at corner v of a tile is, from `tile` on.
  static constexpr std::size_t offset(std::size_t v) noexcept { return kPitch * (v / 2) + v % 2; }

  /// Starts the row of tiles of `base`; index 0 is ignored. `size`: samples of a row. `samples` must outlive it.
  void start(const CornerValues<4>& samples, const SampleIndex<4>& base, std::size_t size) noexcept {
    samples_ = &samples;
    base_ = base;
    size_ = size;
    word_ = ~std::size_t{0};
  }
  void finish() noexcept { samples_ = nullptr; }
  [[nodiscard]] bool has_row() const noexcept { return samples_ != nullptr; }
  [[nodiscard]] const SampleIndex<4>& base() const noexcept { return base_; }

  /// The values around the tile at `at` on axis 0 (offset). Valid until the next call with another word of tiles.
  [[nodiscard, gnu::always_inline]] const double* tile(std::size_t at) noexcept {
    if (at / kWordBits != word_) load(at / kWordBits);
    return values_.data() + at % kWordBits;
  }

 private:
  [[gnu::noinline]] void load(std::size_t word) noexcept {
    word_ = word;
    base_[0] = word * kWordBits;
    samples_->corner_rows(base_, std::min(kWordBits + 1, size_ - base_[0]), values_.data(), kPitch);
  }

  const CornerValues<4>* samples_ = nullptr;
  SampleIndex<4> base_{};
  std::size_t size_ = 0, word_ = 0;
  alignas(64) std::array<double, 8 * kPitch> values_{};
};

}  // namespace tegl::detail
