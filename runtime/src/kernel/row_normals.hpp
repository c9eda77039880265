// SPDX-License-Identifier: BSD-3-Clause
//
// Normals by differences on the edges of rows with many of them. The gradients of all samples of a row are computed at
// once and kept for a while: each serves the edges along the row and to the rows beside it that are processed
// meanwhile. In 2D, most are computed once, in 3D twice, in 4D three times; a sample has up to 2 N edges. The normals
// have the same bytes as NormalWriter's.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/row_gradients.hpp"
#include "image/row_source.hpp"
#include "kernel/extract_layers.hpp"
#include "kernel/extract_normals.hpp"

namespace tegl::detail {

/// One per thread. Memory is O(samples per row).
template <int N>
class RowNormals {
 public:
  using Index = std::array<std::size_t, N>;
  /// Longest row. Several rows are kept, so longer ones would leave the cache next to the core: in 3D, the gradients of
  /// 4096 samples take 4 x 3 x 16 KiB.
  static constexpr std::size_t kMostSamples = 4096;

  /// Whether the normals of an image can be computed here.
  static bool suits(const EdgeCrossings<N>& source, const NormalWriter<N, float>& writer,
                    const RowShape<N>& shape) noexcept {
    const bool are_floats = dynamic_cast<const RowSource<float, N>*>(&source) != nullptr;
    return are_floats && source.strides()[0] == 1 && has_room(shape.size(0)) && writer.is_by_equal_weights();
  }
  /// Bytes for rows of `samples` samples.
  static constexpr std::size_t bytes(std::size_t samples) noexcept {
    if (!has_room(samples)) return 0;
    const std::size_t entries = ((N + 1) * N + 1) * pitch_of(samples) + (N + 1) * kAlignment;
    return sizeof(RowNormals) + entries * sizeof(float) + (samples / kWordBits + 2) * sizeof(Word);
  }

  /// `suits` must be true. The arguments must outlive the object.
  RowNormals(const EdgeCrossings<N>& source, const NormalWriter<N, float>& writer, const RowShape<N>& shape)
      : source_(source),
        writer_(writer),
        shape_(shape),
        pitch_(pitch_of(shape.size(0))),
        positions_(pitch_),
        working_(N * pitch_ + kAlignment),
        left_(shape.words() + 1) {
    for (Row& row : rows_) {
      row.gradients.resize(N * pitch_ + kAlignment);
      RowDifferences<N>& around = row.around;
      around.weights[0] = writer.steps(0).inside();
      around.ends = {writer.steps(0).at(0), writer.steps(0).at(shape.size(0) - 1)};
      around.samples = shape.size(0);
      around.next = N > 2 ? source.strides()[1] : 0;
      around.out = aligned(row.gradients);
      around.pitch = pitch_;
    }
  }

  /// Writes the normals on edges along `axis`, all of the row with the number `row`; `start`: the row's first sample.
  /// Edges must be in ascending order, and have bits.
  void write(std::size_t row, const Index& start, int axis, const EdgesInRows& edges, const double* alphas,
             std::array<float, N>* out) noexcept {
    const Row& first = row_of(row, start);
    Index next = start;
    if (axis != 0) ++next[axis];
    const Row& second = axis == 0 ? first : row_of(shape_.shifted(row, 1u << axis), next);
    write_row_normals<N>({{first.around.out, second.around.out + (axis == 0 ? 1 : 0)},
                          pitch_,
                          shape_.size(0),
                          edges.critical,
                          edges.at,
                          alphas,
                          edges.count,
                          static_cast<float>(writer_.sign()),
                          positions_.data(),
                          aligned(working_),
                          out,
                          left_.data()});
    if (!writer_.ends_with_row()) leave_ends(axis, edges);
    for (std::size_t w = 0; w * kWordBits < edges.count; ++w)
      for (Word rest = left_[w]; rest != 0; rest &= rest - 1) {
        const std::size_t i = w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest));
        out[i] = on_edge(start, axis, edges.at[i], alphas[i], first.around, second.around);
      }
  }

 private:
  static constexpr bool has_room(std::size_t samples) noexcept {
    return samples >= kLeastRow && samples <= kMostSamples;
  }
  /// A register's, in floats.
  static constexpr std::size_t kAlignment = 16;
  static constexpr std::size_t pitch_of(std::size_t samples) noexcept {
    return (samples + kAlignment - 1) / kAlignment * kAlignment + kRowMargin;
  }
  /// The first aligned entry. There are kAlignment more entries than are used.
  static float* aligned(std::vector<float>& entries) noexcept {
    const auto at = reinterpret_cast<std::uintptr_t>(entries.data()) / sizeof(float);
    return entries.data() + (kAlignment - at % kAlignment) % kAlignment;
  }

  /// Marks edges at the ends of the row, beyond which there are neighbours.
  void leave_ends(int axis, const EdgesInRows& edges) noexcept {
    const std::size_t last = shape_.size(0) - (axis == 0 ? 2 : 1);
    if (edges.at[0] == 0) left_[0] |= 1;
    if (edges.at[edges.count - 1] == last)
      left_[(edges.count - 1) / kWordBits] |= Word{1} << ((edges.count - 1) % kWordBits);
  }

  /// Gradients of a row, which edges along several axes and of the next row need too.
  struct Row {
    std::size_t number = ~std::size_t{0};  ///< row of the image
    std::uint64_t used = 0;                ///< time of the last use
    std::vector<float> gradients;          ///< N x pitch
    RowDifferences<N> around{};
  };

  /// The row with the number `row` in its layer; `start`: its first sample.
  const Row& row_of(std::size_t row, const Index& start) noexcept {
    const std::size_t number = start[N - 1] * shape_.rows() + row;
    const auto is_it = [&](const Row& known) { return known.number == number; };
    auto found = std::find_if(rows_.begin(), rows_.end(), is_it);
    const bool is_known = found != rows_.end();
    if (!is_known)
      found = std::min_element(rows_.begin(), rows_.end(), [](auto& a, auto& b) { return a.used < b.used; });
    found->used = ++now_;
    if (is_known) return *found;
    found->number = number;
    surround(found->around, start);
    write_row_gradients<N>(found->around);
    return *found;
  }

  /// Sets the rows around a row. Entry by entry, because a struct that has been written in parts is slow to copy.
  void surround(RowDifferences<N>& row, const Index& start) const noexcept {
    const auto& strides = source_.strides();
    std::ptrdiff_t offset = 0;
    for (int a = 1; a + 1 < N; ++a) offset += static_cast<std::ptrdiff_t>(start[a]) * strides[a];
    const auto in_layer = [&](std::size_t k) {
      return reinterpret_cast<const float*>(source_.layer_in_memory(k).first) + offset;
    };
    const float* const here = in_layer(start[N - 1]);
    row.here = here;
    for (int a = 1; a < N; ++a) {
      const AxisSteps& steps = writer_.steps(a);
      const auto beside = [&](bool exists, bool ahead) {
        if (!exists) return here;
        if (a == N - 1) return in_layer(ahead ? start[a] + 1 : start[a] - 1);
        return ahead ? here + strides[a] : here - strides[a];
      };
      row.backward[a] = beside(steps.has_backward(start[a]), false);
      row.forward[a] = beside(steps.has_forward(start[a]), true);
      row.weights[a] = steps.at(start[a]);
    }
  }

  /// Normal on the edge from sample `at` of a row, at an end of the row or with an unusual gradient.
  [[nodiscard]] std::array<float, N> on_edge(Index start, int axis, std::size_t at, double alpha,
                                             const RowDifferences<N>& first,
                                             const RowDifferences<N>& second) const noexcept {
    start[0] = at;
    if (!writer_.ends_with_row()) return writer_.on_edge(start, axis, alpha);
    const std::size_t last = shape_.size(0) - 1;
    return writer_.on_edge_among(start, axis, alpha, [&](unsigned place) {
      const RowDifferences<N>& row = place % 4 < 2 ? first : second;
      const std::size_t x = axis == 0 && place % 4 >= 2 ? at + 1 : at;
      const bool ahead = place % 2 != 0;
      if (place < 4) return static_cast<double>(row.here[ahead ? std::min(x + 1, last) : x - (x != 0 ? 1 : 0)]);
      return static_cast<double>((ahead ? row.forward : row.backward)[place / 4][x]);
    });
  }

  const EdgeCrossings<N>& source_;  ///< a RowSource<float, N>
  const NormalWriter<N, float>& writer_;
  const RowShape<N>& shape_;
  std::size_t pitch_;
  std::vector<float> positions_, working_;
  std::array<Row, N> rows_;
  std::uint64_t now_ = 0;
  std::vector<Word> left_;
};

}  // namespace tegl::detail
