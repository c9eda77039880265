// SPDX-License-Identifier: BSD-3-Clause
//
// Lists the critical edges of an image (see critical_edges.hpp).
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
  high_.assign(rows_ * pitch + 1, 0);
  // rows along axis 1 together, up to a word; the bits of missing samples only if there are any
  std::atomic<bool> any_missing = false;
  const auto classify = [&](std::size_t from, std::size_t end, Word* missing, std::size_t missing_pitch) {
    for (std::size_t row = from; row < end;) {
      const Index index = index_of(row);
      const std::size_t rows = N > 2 ? std::min({end - row, sizes[1] - index[1], kWordBits}) : 1;
      if (samples.classify(index, rows, {high_.data() + first_word(row), pitch},
                           {missing + missing_pitch * row, missing_pitch}) != 0)
        any_missing = true;
      row += rows;
    }
  };
  for_each_part(rows_, threads, {}, [&](std::size_t from, std::size_t end) {
    std::vector<Word> missing(pitch);
    classify(from, end, missing.data(), 0);
  });
  if (any_missing) {
    missing_.assign(rows_ * pitch + 1, 0);
    for_each_part(rows_, threads, {},
                  [&](std::size_t from, std::size_t end) { classify(from, end, missing_.data() + 1, pitch); });
  }
}

template <int N>
CriticalEdges<N>::CriticalEdges(const SampleSigns<N>& signs, unsigned threads) {
  const std::size_t rows = signs.rows(), words = signs.words();
  const auto in_grid = [&](int axis, std::size_t row) {
    return axis == 0 || row / signs.stride(axis) % signs.sizes()[axis] + 1 < signs.sizes()[axis];
  };
  // count by row, then sum over all rows
  std::uint64_t total = 0;
  for (int a = 0; a < N; ++a) {
    first_[a].resize(rows + 1);
    for_each_part(rows, threads, {}, [&](std::size_t from, std::size_t end) {
      for (std::size_t row = from; row < end; ++row) {
        Number sum = 0;
        if (in_grid(a, row))
          for (std::size_t w = 0; w < words; ++w)
            if (const Word bits = signs.critical(a, row, w, true); bits != 0)
              sum += static_cast<Number>(std::popcount(bits));
        first_[a][row] = sum;
      }
    });
    for (Number& first : first_[a]) {
      const std::uint64_t before = total;
      total += first;
      first = static_cast<Number>(before);
      if (total > kMost)
        throw Error(ErrorCode::TooLarge, fmt::format("{} critical edges or more; expected at most {}", total, kMost));
    }
  }
  // list
  at_.resize(total);
  for (int a = 0; a < N; ++a)
    for_each_part(rows, threads, {}, [&](std::size_t from, std::size_t end) {
      for (std::size_t row = from; row < end; ++row) {
        if (!has_edges(a, row)) continue;
        std::uint32_t* at = at_.data() + first_[a][row];
        for (std::size_t w = 0; w < words; ++w)
          for (Word rest = signs.critical(a, row, w, true); rest != 0; rest &= rest - 1)
            *at++ = static_cast<std::uint32_t>(w * kWordBits) + static_cast<std::uint32_t>(std::countr_zero(rest));
      }
    });
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
