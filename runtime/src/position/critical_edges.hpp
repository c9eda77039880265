// SPDX-License-Identifier: BSD-3-Clause
//
// The critical edges of an image (edges of the grid with one high and one low end), numbered without a list: bits of
// the samples and prefix sums of bit counts.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/bitplanes.hpp"
#include "image/sample_source.hpp"

namespace tegl::detail {

/// Which samples of an image are high, and which are missing. A row is a line of samples along axis 0; rows are
/// numbered through all layers. Memory: 1/8 byte per sample, and as much again if any is missing.
template <int N>
class SampleSigns {
 public:
  using Index = SampleIndex<N>;

  /// Classifies all samples. `samples` must have all layers in memory. `threads`: 0 for all of the machine.
  SampleSigns(const SampleClassifier<N>& samples, const Index& sizes, unsigned threads);

  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }
  [[nodiscard]] std::size_t words() const noexcept { return words_; }
  [[nodiscard]] const Index& sizes() const noexcept { return sizes_; }
  /// Rows between neighbours along axis a > 0.
  [[nodiscard]] std::size_t stride(int a) const noexcept { return strides_[a]; }
  /// Index of the first sample of a row.
  [[nodiscard]] Index index_of(std::size_t row) const noexcept {
    Index index{};
    for (int a = 1; a < N; ++a) index[a] = row / strides_[a] % sizes_[a];
    return index;
  }
  [[nodiscard]] std::size_t row_of(const Index& index) const noexcept {
    std::size_t row = 0;
    for (int a = 1; a < N; ++a) row += index[a] * strides_[a];
    return row;
  }

  [[nodiscard]] bool is_high(std::size_t row, std::size_t i) const noexcept { return bit(high_, row, i); }
  [[nodiscard]] bool is_missing(std::size_t row, std::size_t i) const noexcept {
    return !missing_.empty() && bit(missing_, row, i);
  }
  /// Bits of the critical edges along `axis` that start at the 64 samples of a word. `in_grid`: whether the row has a
  /// neighbour along the axis (ignored for axis 0).
  [[nodiscard]] Word critical(int axis, std::size_t row, std::size_t w, bool in_grid) const noexcept {
    const std::size_t at = row * (words_ + 1) + w;
    if (axis == 0) {
      const Word differ = high_[at] ^ (high_[at] >> 1 | high_[at + 1] << (kWordBits - 1));
      Word unusable = ~edges_in_word(w);
      if (!missing_.empty()) unusable |= missing_[at] | missing_[at] >> 1 | missing_[at + 1] << (kWordBits - 1);
      return differ & ~unusable;
    }
    if (!in_grid) return 0;
    const std::size_t next = at + strides_[axis] * (words_ + 1);
    const Word differ = high_[at] ^ high_[next];
    return missing_.empty() ? differ : differ & ~(missing_[at] | missing_[next]);
  }

 private:
  [[nodiscard]] bool bit(const std::vector<Word>& bits, std::size_t row, std::size_t i) const noexcept {
    return (bits[row * (words_ + 1) + i / kWordBits] >> (i % kWordBits) & 1u) != 0;
  }
  /// Edges along axis 0 that start at the samples of word w.
  [[nodiscard]] Word edges_in_word(std::size_t w) const noexcept {
    const std::size_t edges = sizes_[0] - 1;
    if (edges >= (w + 1) * kWordBits) return ~Word{0};
    return edges <= w * kWordBits ? 0 : (Word{1} << (edges - w * kWordBits)) - 1;
  }

  Index sizes_;
  std::array<std::size_t, N> strides_{};
  std::size_t rows_ = 1;
  std::size_t words_;
  std::vector<Word> high_;     ///< rows x (words + 1); the last word of a row is 0
  std::vector<Word> missing_;  ///< as high_; empty if no sample is missing
};

/// The critical edges of an image without missing ends. Edges are numbered by axis, then by row, then along the row.
/// Memory: N/16 bytes per sample beside those of SampleSigns.
template <int N>
class CriticalEdges : public SampleSigns<N> {
 public:
  using typename SampleSigns<N>::Index;
  using Number = std::uint32_t;

  /// As SampleSigns. Throws TooLarge for more than kMost edges.
  CriticalEdges(const SampleClassifier<N>& samples, const Index& sizes, unsigned threads);

  static constexpr Number kMost = Number{1} << 30;

  [[nodiscard]] Number count() const noexcept { return count_; }
  /// Number of the first edge along `axis`; `axis` = N: the number of edges.
  [[nodiscard]] Number first(int axis) const noexcept { return axis < N ? first_[axis] : count_; }
  /// Number of the critical edge along `axis` from sample i of a row.
  [[nodiscard]] Number number(int axis, std::size_t row, std::size_t i) const noexcept {
    const std::size_t w = i / kWordBits;
    const Word below = (Word{1} << (i % kWordBits)) - 1;
    return prefix_[axis][row * this->words() + w] +
           static_cast<Number>(std::popcount(this->critical(axis, row, w, true) & below));
  }

 private:
  std::array<std::vector<Number>, N> prefix_;  ///< by axis, row and word: number of the first edge
  std::array<Number, N> first_{};
  Number count_ = 0;
};

}  // namespace tegl::detail
