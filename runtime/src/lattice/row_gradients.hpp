// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at the samples beside a contour on a lattice, each computed once: a sample has up to 24 edges.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "lattice/lattice_gradients.hpp"
#include "lattice/lattice_rows.hpp"

namespace tegl::detail {

template <int N>
class RowGradients {
 public:
  using Gradient = typename LatticeGradients<N>::Gradient;

  /// At the ends of all edges with vertices. Errors: Cancelled.
  RowGradients(const LatticeRows& rows, const LatticePatterns& patterns, const LatticeGradients<N>& gradients,
               const WorkOptions& work)
      : words_(rows.words()), bits_(rows.row_count() * words_), before_(bits_.size()) {
    constexpr std::size_t kRows = 64;
    for_each_block(rows.row_count(), kRows, work.threads, part_of(work.progress, 0.0, 0.2),
                   [&](std::size_t, std::size_t from, std::size_t to) {
                     for (std::size_t r = from; r < to; ++r) add_ends(rows, patterns, r);
                   });
    std::uint32_t count = 0;
    for (std::size_t w = 0; w < bits_.size(); ++w) {
      before_[w] = count;
      count += count_bits(bits_[w]);
    }
    values_.resize(count);
    for_each_block(rows.row_count(), kRows, work.threads, part_of(work.progress, 0.2, 1.0),
                   [&](std::size_t, std::size_t from, std::size_t to) {
                     for (std::size_t r = from; r < to; ++r) compute(rows.at(r), r, gradients);
                   });
  }

  /// The gradient at sample i of row r, which is an end of an edge with a vertex.
  [[nodiscard]] const Gradient& at(std::size_t r, std::size_t i) const noexcept {
    const std::size_t w = r * words_ + i / kWordBits;
    return values_[before_[w] + count_bits(bits_[w] & ((Word{1} << (i % kWordBits)) - 1))];
  }

 private:
  /// Sets the bits of the samples of a row from which or to which there is a vertex.
  void add_ends(const LatticeRows& rows, const LatticePatterns& patterns, std::size_t r) noexcept {
    const LatticeRows::At at = rows.at(r);
    Word* const bits = bits_.data() + r * words_;
    for (const LayerPattern& pattern : patterns)
      for (std::size_t kind = 0; kind < pattern.edges.size(); ++kind) {
        const LatticePlace& to = pattern.edges[kind].to;
        if (&pattern == &rows.pattern(at) && rows.has_row(at, to)) add(rows, r, kind, 0, bits);
        LatticePlace back;
        for (std::size_t a = 0; a < 4; ++a) back[a] = -to[a];
        if (!rows.has_row(at, back)) continue;
        const std::size_t from = r + rows.steps(back);
        if (&rows.pattern(rows.at(from)) == &pattern) add(rows, from, kind, to[0], bits);
      }
  }
  /// Adds the crossed edges of row r, `along` samples further.
  void add(const LatticeRows& rows, std::size_t r, std::size_t kind, std::ptrdiff_t along, Word* bits) const noexcept {
    if (rows.row(r).first == rows.row(r).first_own) return;
    const Word* const crossed = rows.crossed(r, kind).bits;
    for (std::size_t w = 0; w < words_; ++w)
      if (along == 0)
        bits[w] |= crossed[w];
      else if (along > 0)
        bits[w] |= crossed[w] << 1 | (w == 0 ? 0 : crossed[w - 1] >> (kWordBits - 1));
      else
        bits[w] |= crossed[w] >> 1 | (w + 1 == words_ ? 0 : crossed[w + 1] << (kWordBits - 1));
  }
  void compute(const LatticeRows::At& row, std::size_t r, const LatticeGradients<N>& gradients) {
    typename LatticeGradients<N>::Sample sample;
    for (std::size_t a = 0; a < N; ++a) sample[a] = row[a];
    for (std::size_t w = 0; w < words_; ++w) {
      std::size_t next = before_[r * words_ + w];
      for (Word rest = bits_[r * words_ + w]; rest != 0; rest &= rest - 1) {
        sample[0] = w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest));
        values_[next++] = gradients.at(sample);
      }
    }
  }

  std::size_t words_;
  std::vector<Word> bits_;             ///< by row: the samples
  std::vector<std::uint32_t> before_;  ///< by word: number of the first gradient
  std::vector<Gradient> values_;
};

}  // namespace tegl::detail
