// SPDX-License-Identifier: BSD-3-Clause
//
// Counts bits. Highway's foreach_target compiles this file once per instruction set.
#include "complex/edge_words.hpp"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "complex/edge_words.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

std::uint64_t bits_before(EdgeWord* words, std::size_t count) {
  std::uint64_t sum = 0;
  for (std::size_t w = 0; w < count; ++w) {
    words[w].before = sum;
    sum += static_cast<std::uint64_t>(std::popcount(words[w].crossed));
  }
  return sum;
}

void ranks(const EdgeWord* words, Index* edges, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const EdgeWord& word = words[edges[i] >> 6];
    const std::uint64_t below = word.crossed & ((std::uint64_t{1} << (edges[i] & 63u)) - 1);
    edges[i] = static_cast<Index>(word.before + static_cast<std::uint64_t>(std::popcount(below)));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(bits_before);
std::uint64_t count_before(std::vector<EdgeWord>& words) noexcept {
  return HWY_DYNAMIC_DISPATCH(bits_before)(words.data(), words.size());
}
HWY_EXPORT(ranks);
void number_edges(const EdgeWord* words, Index* edges, std::size_t count) noexcept {
  HWY_DYNAMIC_DISPATCH(ranks)(words, edges, count);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
