// SPDX-License-Identifier: BSD-3-Clause
//
// The critical edges of an image: edges of the grid with one high and one low end.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/bitplanes.hpp"
#include "image/sample_source.hpp"
#include "tegl/contour.hpp"

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
  /// The bits of the high samples of a row, and a word of zeros after them.
  [[nodiscard]] const Word* high(std::size_t row) const noexcept { return high_.data() + first_word(row); }
  /// The same as bytes, from one word before the row on, which can be read.
  [[nodiscard]] const std::byte* bytes_before(std::size_t row) const noexcept {
    return reinterpret_cast<const std::byte*>(high(row) - 1);
  }
  [[nodiscard]] std::size_t row_bytes() const noexcept { return (words_ + 1) * sizeof(Word); }
  [[nodiscard]] bool any_missing() const noexcept { return !missing_.empty(); }
  /// Bits of the missing samples of a word.
  [[nodiscard]] Word missing(std::size_t row, std::size_t w) const noexcept {
    return missing_.empty() ? 0 : missing_[first_word(row) + w];
  }
  /// Bits of the critical edges along `axis` that start at the 64 samples of a word. `in_grid`: whether the row has a
  /// neighbour along the axis (ignored for axis 0).
  [[nodiscard]] Word critical(int axis, std::size_t row, std::size_t w, bool in_grid) const noexcept {
    const std::size_t at = first_word(row) + w;
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
  [[nodiscard]] std::size_t first_word(std::size_t row) const noexcept { return 1 + row * (words_ + 1); }
  [[nodiscard]] bool bit(const Buffer<Word>& bits, std::size_t row, std::size_t i) const noexcept {
    return (bits[first_word(row) + i / kWordBits] >> (i % kWordBits) & 1u) != 0;
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
  Buffer<Word> high_;     ///< a word of 0, then rows x (words + 1); the last word of a row is 0
  Buffer<Word> missing_;  ///< as high_; empty if no sample is missing
};

/// The critical edges of an image without missing ends, listed by axis, then by row, then along the row. Memory: 4 N
/// bytes per row and 4 bytes per edge.
template <int N>
class CriticalEdges {
 public:
  using Number = std::uint32_t;

  /// Throws TooLarge for more than kMost edges. `threads`: 0 for all of the machine.
  CriticalEdges(const SampleSigns<N>& signs, unsigned threads);

  static constexpr Number kMost = Number{1} << 30;

  [[nodiscard]] Number count() const noexcept { return static_cast<Number>(at_.size()); }
  /// Number of the first edge along `axis`; `axis` = N: the number of edges.
  [[nodiscard]] Number first(int axis) const noexcept { return axis < N ? first_[axis].front() : count(); }
  /// Number of the first edge along `axis` in a row.
  [[nodiscard]] Number first_in_row(int axis, std::size_t row) const noexcept { return first_[axis][row]; }
  /// First sample of an edge in its row.
  [[nodiscard]] std::uint32_t at(Number number) const noexcept { return at_[number]; }
  [[nodiscard]] bool has_edges(int axis, std::size_t row) const noexcept {
    return first_[axis][row] != first_[axis][row + 1];
  }
  /// Number of the edge along `axis` from sample i of a row, which must be critical.
  [[nodiscard]] Number number(int axis, std::size_t row, std::uint32_t i) const noexcept {
    const auto from = at_.begin() + first_[axis][row], end = at_.begin() + first_[axis][row + 1];
    return static_cast<Number>(std::lower_bound(from, end, i) - at_.begin());
  }
  /// As `number`, if the edge comes after edge `before` of the same row.
  [[nodiscard]] Number number_after(Number before, std::uint32_t i) const noexcept {
    do ++before;
    while (at_[before] != i);
    return before;
  }

 private:
  std::array<std::vector<Number>, N> first_;  ///< by axis and row, and the end of the last row
  Buffer<std::uint32_t> at_;                  ///< by edge: its first sample in its row
};

}  // namespace tegl::detail
