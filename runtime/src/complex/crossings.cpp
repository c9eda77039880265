// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers the crossed edges of a complex.
#include "complex/crossings.hpp"

#include <atomic>
#include <bit>
#include <limits>
#include <string>

#include "tegl/error.hpp"

namespace tegl::detail {

namespace {

/// Number of set bits, inline: without the processor's instruction std::popcount is a call.
std::uint64_t bit_count(std::uint64_t word) noexcept {
  word -= word >> 1 & 0x5555555555555555u;
  word = (word & 0x3333333333333333u) + (word >> 2 & 0x3333333333333333u);
  return ((word + (word >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u >> 56;
}

}  // namespace

void require_numbers(std::uint64_t vertices) {
  constexpr std::uint64_t kMost = std::numeric_limits<Index>::max();
  if (vertices > kMost)
    throw Error(ErrorCode::TooLarge, "the contour has " + std::to_string(vertices) + " vertices; expected at most " +
                                         std::to_string(kMost) + ": contour parts of the complex instead");
}

std::vector<std::uint64_t> sums_before(const std::vector<ActiveBlock>& blocks, std::uint64_t ActiveBlock::*size) {
  std::vector<std::uint64_t> sums{0};
  for (const ActiveBlock& block : blocks) sums.push_back(sums.back() + block.*size);
  return sums;
}

CrossingNumbers::CrossingNumbers(const CellGroups& cells, const CellTables& tables,
                                 const std::vector<ActiveBlock>& blocks, const ComplexEdges* edges, std::size_t points,
                                 const WorkOptions& work)
    : cells_(cells), tables_(tables), blocks_(blocks), edges_(edges) {
  if (edges != nullptr) {
    count_bits(work);
    return;
  }
  sorted_ = SortedEdges(
      points, blocks.size(),
      [&](std::size_t b, const auto& add) {
        const CellGroup& group = cells.groups[blocks[b].group];
        const CellCases& cases = tables.of_group[blocks[b].group];
        const std::uint8_t* const ends = cases.table().edges;
        for (const ActiveCell& cell : blocks[b].cells) {
          const Index* const corners = group.cell(cell.cell);
          cases.for_each_crossed(cell.signature,
                                 [&](unsigned e) { add(corners[ends[2 * e]], corners[ends[2 * e + 1]]); });
        }
      },
      work);
  require_numbers(sorted_.ends().size());
}

void CrossingNumbers::count_bits(const WorkOptions& work) {
  // set the bits of crossed edges
  of_blocks_.resize(blocks_.size());
  words_.assign(block_count(edges_->ends.size(), 64), {});
  const bool is_one = work.threads == 1;
  for_each_block(blocks_.size(), 1, work.threads, part_of(work.progress, 0.0, 0.7),
                 [&](std::size_t b, std::size_t, std::size_t) {
                   const CellCases& cases = tables_.of_group[blocks_[b].group];
                   const Index* const of_cells = edges_->of_cells[blocks_[b].group].data();
                   std::vector<Index>& crossed = of_blocks_[b];
                   crossed.reserve(4 * blocks_[b].cells.size());
                   for (const ActiveCell& cell : blocks_[b].cells)
                     cases.for_each_crossed(cell.signature, [&](unsigned e) {
                       const Index edge = of_cells[std::size_t{cell.cell} * cases.table().edge_count + e];
                       crossed.push_back(edge);
                       const std::uint64_t bit = std::uint64_t{1} << (edge & 63u);
                       if (is_one) {
                         words_[edge >> 6].crossed |= bit;
                         return;
                       }
                       std::atomic_ref<std::uint64_t> word(words_[edge >> 6].crossed);
                       if ((word.load(std::memory_order_relaxed) & bit) == 0)
                         word.fetch_or(bit, std::memory_order_relaxed);
                     });
                 });
  // count
  std::uint64_t count = 0;
  for (EdgeWord& word : words_) {
    word.before = count;
    count += bit_count(word.crossed);
  }
  require_numbers(count);
  // list
  ends_.resize(count);
  for_each_part(words_.size(), work.threads, part_of(work.progress, 0.7, 1.0), [&](std::size_t from, std::size_t to) {
    for (std::size_t w = from; w < to; ++w) {
      std::uint64_t number = words_[w].before;
      for (std::uint64_t word = words_[w].crossed; word != 0; word &= word - 1)
        ends_[number++] = edges_->ends[w * 64 + static_cast<std::size_t>(std::countr_zero(word))];
    }
  });
}

void CrossingNumbers::of_cell(std::size_t b, const ActiveCell& cell, std::size_t& crossing,
                              Index* numbers) const noexcept {
  const CellCases& cases = tables_.of_group[blocks_[b].group];
  if (edges_ == nullptr) {
    const Index* const corners = cells_.groups[blocks_[b].group].cell(cell.cell);
    const std::uint8_t* const ends = cases.table().edges;
    cases.for_each_crossed(cell.signature, [&](unsigned e) {
      numbers[e] = static_cast<Index>(sorted_.number(corners[ends[2 * e]], corners[ends[2 * e + 1]]));
    });
    return;
  }
  const Index* edges = of_blocks_[b].data() + crossing;
  cases.for_each_crossed(cell.signature, [&](unsigned e) {
    const Index edge = *edges++;
    const EdgeWord& word = words_[edge >> 6];
    numbers[e] = static_cast<Index>(word.before + bit_count(word.crossed & ((std::uint64_t{1} << (edge & 63u)) - 1)));
  });
  crossing = static_cast<std::size_t>(edges - of_blocks_[b].data());
}

}  // namespace tegl::detail
