// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of set bits, compiled for several instruction sets: without the processor's instruction, counting is slow.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tegl/contour.hpp"

namespace tegl::detail {

/// 64 edges: which are crossed, and how many before them are. Together, so that a look-up meets one cache line.
struct EdgeWord {
  std::uint64_t crossed = 0;
  std::uint64_t before = 0;
};

/// Counts the crossed edges before each word. Returns their number.
std::uint64_t count_before(std::vector<EdgeWord>& words) noexcept;

/// Replaces each of `count` edges, all crossed, by the number of crossed edges before it.
void number_edges(const EdgeWord* words, Index* edges, std::size_t count) noexcept;

}  // namespace tegl::detail
