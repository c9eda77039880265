// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers for the vertices of a few simplices, in a small table that stays in the cache. Marks in a table for the whole
// contour would be read from memory.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// Use one per thread.
class FewVertices {
 public:
  static constexpr std::uint32_t kNew = std::numeric_limits<std::uint32_t>::max();

  /// Removes all. At most `most` vertices are used until the next call.
  void clear(std::size_t most) {
    const std::size_t size = std::bit_ceil(2 * most + 2);
    if (size > slots_.size() || ++round_ == 0) {
      slots_.assign(std::max(size, slots_.size()), Slot{});
      shift_ = 32 - std::countr_zero(slots_.size());
      round_ = 1;
    }
  }

  /// The number of a vertex; kNew until another one is assigned to it.
  std::uint32_t& operator[](Index vertex) {
    std::size_t at = (vertex * kHash) >> shift_;
    for (; slots_[at].round == round_; at = (at + 1) & (slots_.size() - 1))
      if (slots_[at].vertex == vertex) return slots_[at].number;
    slots_[at] = {vertex, round_, kNew};
    return slots_[at].number;
  }

 private:
  static constexpr std::uint32_t kHash = 0x9E3779B9u;
  struct Slot {
    Index vertex = 0;
    std::uint32_t round = 0;  ///< which call of `clear` was before it was used
    std::uint32_t number = 0;
  };
  std::vector<Slot> slots_;
  int shift_ = 0;
  std::uint32_t round_ = 0;
};

}  // namespace tegl::detail
