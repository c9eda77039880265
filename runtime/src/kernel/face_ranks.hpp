// SPDX-License-Identifier: BSD-3-Clause
//
// Vertex numbers of the faces of a grid, of many kinds, some with vertices of the contour and most without: one bit per
// face, ranks over the bits, and by rank the number of the face's first vertex.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "image/bitplanes.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Of one layer, or of one slab. Filled in three steps: `mark` all faces with vertices, `rank`, `tell` the count of
/// each, `number`. Cells may mark and tell side by side, and the same face many times: what they say of it is the same,
/// and of the cells that tell, the least one owns the face.
class FaceRanks {
 public:
  void reset(std::size_t words) {
    bits_.assign(words, 0);
    before_.resize(words);
  }

  void mark(std::size_t word, unsigned bit) noexcept {
    const std::atomic_ref<Word> bits(bits_[word]);
    const Word mask = Word{1} << bit;
    if ((bits.load(std::memory_order_relaxed) & mask) == 0) bits.fetch_or(mask, std::memory_order_relaxed);
  }

  void rank() {
    std::uint32_t count = 0;
    for (std::size_t w = 0; w < bits_.size(); ++w) {
      before_[w] = count;
      count += static_cast<std::uint32_t>(std::popcount(bits_[w]));
    }
    first_.assign(count, 0);
    owners_.assign(count, std::numeric_limits<std::uint32_t>::max());
  }

  void tell(std::size_t word, unsigned bit, std::uint32_t count, std::uint32_t cell) noexcept {
    const std::size_t at = ordinal(word, bit);
    std::atomic_ref(first_[at]).store(count, std::memory_order_relaxed);
    const std::atomic_ref<std::uint32_t> owner(owners_[at]);
    std::uint32_t known = owner.load(std::memory_order_relaxed);
    while (cell < known && !owner.compare_exchange_weak(known, cell, std::memory_order_relaxed)) {
    }
  }

  /// From counts to numbers, the first of which is `first`; returns what comes after the last.
  std::uint64_t number(std::uint64_t first) noexcept {
    for (Index& next : first_) {
      const Index count = next;
      next = static_cast<Index>(first);
      first += count;
    }
    end_ = static_cast<Index>(first);
    return first;
  }

  /// The first vertex of a face that is marked.
  [[nodiscard]] Index first(std::size_t word, unsigned bit) const noexcept { return first_[ordinal(word, bit)]; }
  /// How many vertices it has numbers for.
  [[nodiscard]] Index count(std::size_t word, unsigned bit) const noexcept {
    const std::size_t at = ordinal(word, bit);
    return (at + 1 < first_.size() ? first_[at + 1] : end_) - first_[at];
  }
  [[nodiscard]] std::uint32_t owner(std::size_t word, unsigned bit) const noexcept {
    return owners_[ordinal(word, bit)];
  }

 private:
  [[nodiscard]] std::size_t ordinal(std::size_t word, unsigned bit) const noexcept {
    return before_[word] + static_cast<std::size_t>(std::popcount(bits_[word] & ((Word{1} << bit) - 1)));
  }

  std::vector<Word> bits_;
  std::vector<std::uint32_t> before_;  ///< faces marked before this word
  std::vector<Index> first_;           ///< by rank; until they are numbered: how many vertices
  std::vector<std::uint32_t> owners_;  ///< by rank
  Index end_ = 0;                      ///< the number after the last
};

}  // namespace tegl::detail
