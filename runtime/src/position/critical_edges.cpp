// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers the critical edges of an image (see critical_edges.hpp).
#include "position/critical_edges.hpp"

#include <algorithm>
#include <atomic>

#include <fmt/format.h>

#include "base/workers.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

template <int N>
SampleSigns<N>::SampleSigns(const SampleClassifier<N>& samples, const Index& sizes, unsigned threads)
    : sizes_(sizes), words_((sizes[0] + kWordBits - 1) / kWordBits) {
  for (int a = 1; a < N; ++a) {
    strides_[a] = rows_;
    rows_ *= sizes[a];
  }
  const std::size_t pitch = words_ + 1;
  high_.assign(rows_ * pitch, 0);
  // classify
  std::atomic<bool> any_missing = false;
  for_each_part(rows_, threads, {}, [&](std::size_t from, std::size_t end) {
    std::vector<Word> missing(pitch);
    for (std::size_t row = from; row < end; ++row)
      if (samples.classify(index_of(row), 1, {high_.data() + row * pitch, pitch}, {missing.data(), pitch}) != 0)
        any_missing = true;
  });
  if (any_missing) {
    missing_.assign(rows_ * pitch, 0);
    for_each_part(rows_, threads, {}, [&](std::size_t from, std::size_t end) {
      for (std::size_t row = from; row < end; ++row)
        samples.classify(index_of(row), 1, {high_.data() + row * pitch, pitch}, {missing_.data() + row * pitch, pitch});
    });
  }
}

template <int N>
CriticalEdges<N>::CriticalEdges(const SampleClassifier<N>& samples, const Index& sizes, unsigned threads)
    : SampleSigns<N>(samples, sizes, threads) {
  const std::size_t rows = this->rows(), words = this->words();
  // count by word, then sum over the words of a row and over all rows
  std::uint64_t total = 0;
  for (int a = 0; a < N; ++a) {
    prefix_[a].resize(rows * words);
    std::vector<std::uint64_t> of_row(rows);
    for_each_part(rows, threads, {}, [&](std::size_t from, std::size_t end) {
      for (std::size_t row = from; row < end; ++row) {
        const bool in_grid = a == 0 || row / this->stride(a) % sizes[a] + 1 < sizes[a];
        Number sum = 0;
        for (std::size_t w = 0; w < words; ++w) {
          prefix_[a][row * words + w] = sum;
          sum += static_cast<Number>(std::popcount(this->critical(a, row, w, in_grid)));
        }
        of_row[row] = sum;
      }
    });
    first_[a] = static_cast<Number>(total);
    for (std::uint64_t& count : of_row) {
      const std::uint64_t before = total;
      total += count;
      count = before;
    }
    if (total > kMost)
      throw Error(ErrorCode::TooLarge, fmt::format("{} critical edges or more; expected at most {}", total, kMost));
    for_each_part(rows, threads, {}, [&](std::size_t from, std::size_t end) {
      for (std::size_t row = from; row < end; ++row)
        for (std::size_t w = 0; w < words; ++w) prefix_[a][row * words + w] += static_cast<Number>(of_row[row]);
    });
  }
  count_ = static_cast<Number>(total);
}

template class SampleSigns<2>;
template class CriticalEdges<2>;
template class SampleSigns<3>;
template class CriticalEdges<3>;
template class SampleSigns<4>;
template class CriticalEdges<4>;
template class SampleSigns<5>;
template class CriticalEdges<5>;

}  // namespace tegl::detail
