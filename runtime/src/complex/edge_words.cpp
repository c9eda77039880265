// SPDX-License-Identifier: BSD-3-Clause
//
// Lists, marks and counts crossed edges. Highway's foreach_target compiles this file once per instruction set.
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

namespace hn = hwy::HWY_NAMESPACE;

void list(const CellCases& cases, const Index* edges, std::size_t edge_total, const ActiveCell* cells,
          std::size_t count, Index* listed) {
  const hn::CappedTag<Index, kListedBeyond> d;
  const std::size_t edge_count = cases.table().edge_count;
  // cells whose edges are in one register
  const bool is_together = hn::Lanes(d) == kListedBeyond && cases.picks() != nullptr;
  for (std::size_t i = 0; i < count; ++i) {
    constexpr std::size_t kAhead = 16;
    if (i + kAhead < count) __builtin_prefetch(edges + cells[i + kAhead].cell * edge_count);
    const std::size_t first = cells[i].cell * edge_count;
    const unsigned signature = cells[i].signature;
    if (is_together && first + kListedBeyond <= edge_total) {
      const auto picks = hn::SetTableIndices(d, cases.picks()[signature].data());
      hn::StoreU(hn::TableLookupLanes(hn::LoadU(d, edges + first), picks), d, listed);
      listed += cases.of_signature(signature).crossings;
    } else {
      cases.for_each_crossed(signature, [&](unsigned e) { *listed++ = edges[first + e]; });
    }
  }
}

void set(EdgeWord* words, const Index* edges, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) words[edges[i] >> 6].crossed |= std::uint64_t{1} << (edges[i] & 63u);
}

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

HWY_EXPORT(list);
void list_crossed(const CellCases& cases, std::span<const Index> edges, std::span<const ActiveCell> cells,
                  Index* listed) noexcept {
  HWY_DYNAMIC_DISPATCH(list)(cases, edges.data(), edges.size(), cells.data(), cells.size(), listed);
}
HWY_EXPORT(set);
void set_crossed(EdgeWord* words, const Index* edges, std::size_t count) noexcept {
  HWY_DYNAMIC_DISPATCH(set)(words, edges, count);
}
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
