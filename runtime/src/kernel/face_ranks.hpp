// SPDX-License-Identifier: BSD-3-Clause
//
// Vertex numbers of a grid's faces of many kinds, of which few have contour vertices: one bit per face, prefix sums
// over the bits, and by rank the number of the face's first vertex.
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

/// Faces of one layer or slab. Filled in four steps: `mark` all faces with vertices, `rank`, `tell` the vertex count of
/// each, `number`. Cells may call mark and tell concurrently, and several times for one face with the same count. The
/// cell with the lowest number owns the face.
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

  /// Replaces counts by numbers, starting at `first`. Returns one past the last number.
  std::uint64_t number(std::uint64_t first) noexcept {
    for (Index& next : first_) {
      const Index count = next;
      next = static_cast<Index>(first);
      first += count;
    }
    end_ = static_cast<Index>(first);
    return first;
  }

  /// First vertex of a marked face.
  [[nodiscard]] Index first(std::size_t word, unsigned bit) const noexcept { return first_[ordinal(word, bit)]; }
  /// Number of vertices of a marked face.
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
  std::vector<std::uint32_t> before_;  ///< marked faces before each word
  std::vector<Index> first_;           ///< by rank; before `number`: vertex counts
  std::vector<std::uint32_t> owners_;  ///< by rank
  Index end_ = 0;                      ///< one past the last number
};

}  // namespace tegl::detail
