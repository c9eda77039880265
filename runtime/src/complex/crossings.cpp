// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers the crossed edges of a complex.
#include "complex/crossings.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>
#include <string>

#include "complex/edge_words.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

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
                                 const std::vector<ActiveBlock>& blocks, std::vector<PolytopeBlock>& polytopes,
                                 const ComplexEdges* edges, std::size_t points, const WorkOptions& work)
    : cells_(cells), tables_(tables), blocks_(blocks), edges_(edges), of_blocks_(blocks.size()) {
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    of_blocks_[b].reserve(blocks[b].crossings + kListedBeyond);
    of_blocks_[b].resize(blocks[b].crossings);
  }
  if (edges == nullptr)
    sort(points, polytopes, work);
  else
    count_bits(polytopes, work);
}

void CrossingNumbers::sort(std::size_t points, std::vector<PolytopeBlock>& polytopes, const WorkOptions& work) {
  // the distinct edges of each block: a few times fewer to sort
  std::vector<std::vector<EdgeEnds>> distinct(blocks_.size());
  for_each_block(
      blocks_.size(), 1, work.threads, part_of(work.progress, 0.0, 0.4), [] { return EdgeSet(); },
      [&](std::size_t b, std::size_t, std::size_t, EdgeSet& edges) {
        const CellGroup& group = cells_.groups[blocks_[b].group];
        const CellCases& cases = tables_.of_group[blocks_[b].group];
        const std::uint8_t* const ends = cases.table().edges;
        Index* next = of_blocks_[b].data();
        edges.clear(blocks_[b].crossings);
        const std::vector<ActiveCell>& active = blocks_[b].cells;
        for (std::size_t i = 0; i < active.size(); ++i) {
          constexpr std::size_t kAhead = 16;
          if (i + kAhead < active.size()) __builtin_prefetch(group.cell(active[i + kAhead].cell));
          const ActiveCell& cell = active[i];
          const Index* const corners = group.cell(cell.cell);
          cases.for_each_crossed(
              cell.signature, [&](unsigned e) { *next++ = edges.add(corners[ends[2 * e]], corners[ends[2 * e + 1]]); });
        }
        distinct[b] = edges.edges();
      });
  SortedEdges sorted(points, blocks_.size() + polytopes.size(),
                     [&](std::size_t b, const auto& add) {
                       const auto& edges = b < blocks_.size() ? distinct[b] : polytopes[b - blocks_.size()].edges;
                       for (const auto& [p, q] : edges) add(p, q);
                     },
                     {work.threads, part_of(work.progress, 0.4, 0.8)});
  require_numbers(sorted.ends().size());
  // from numbers in the block to numbers of the contour
  for_each_block(
      blocks_.size(), 1, work.threads, part_of(work.progress, 0.8, 1.0), [] { return std::vector<Index>(); },
      [&](std::size_t b, std::size_t, std::size_t, std::vector<Index>& numbers) {
        numbers.clear();
        for (const auto& [p, q] : distinct[b]) numbers.push_back(static_cast<Index>(sorted.number(p, q)));
        distinct[b] = {};
        for (Index& edge : of_blocks_[b]) edge = numbers[edge];
      });
  for_each_item(polytopes.size(), work.threads, nullptr, [&](std::size_t b) {
    polytopes[b].numbers.reserve(polytopes[b].edges.size());
    for (const auto& [p, q] : polytopes[b].edges)
      polytopes[b].numbers.push_back(static_cast<Index>(sorted.number(p, q)));
  });
  ends_ = sorted.take_ends();
}

namespace {

/// Sets the bits of crossed edges; other threads may do so at the same time unless `is_one`.
void set_bits(std::vector<EdgeWord>& words, const Index* edges, std::size_t count, bool is_one) {
  if (is_one) return set_crossed(words.data(), edges, count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint64_t bit = std::uint64_t{1} << (edges[i] & 63u);
    std::atomic_ref<std::uint64_t> word(words[edges[i] >> 6].crossed);
    if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
  }
}

}  // namespace

void CrossingNumbers::count_bits(std::vector<PolytopeBlock>& polytopes, const WorkOptions& work) {
  // set the bits of crossed edges
  std::vector<EdgeWord> words(block_count(edges_->ends.size(), 64));
  const bool is_one = work.threads == 1;
  for_each_block(
      blocks_.size(), 1, work.threads, part_of(work.progress, 0.0, 0.5), [&](std::size_t b, std::size_t, std::size_t) {
        const ActiveBlock& block = blocks_[b];
        Buffer<Index>& listed = of_blocks_[b];
        listed.resize(block.crossings + kListedBeyond);
        list_crossed(tables_.of_group[block.group], edges_->of_cells[block.group], block.cells, listed.data());
        listed.resize(block.crossings);
        set_bits(words, listed.data(), listed.size(), is_one);
      });
  for_each_item(polytopes.size(), work.threads, nullptr, [&](std::size_t b) {
    PolytopeBlock& block = polytopes[b];
    block.numbers.reserve(block.edges.size());
    auto found = edges_->ends.begin();
    for (const EdgeEnds& edge : block.edges) {  // ascending: each is searched from the one before, in growing steps
      std::ptrdiff_t step = 1;
      while (step < edges_->ends.end() - found && found[step] < edge) {
        found += step;
        step *= 2;
      }
      found = std::lower_bound(found, found + std::min(step + 1, edges_->ends.end() - found), edge);
      block.numbers.push_back(static_cast<Index>(found - edges_->ends.begin()));
    }
    set_bits(words, block.numbers.data(), block.numbers.size(), is_one);
  });
  // count
  const std::uint64_t count = count_before(words);
  require_numbers(count);
  // list
  ends_.resize(count);
  for_each_part(words.size(), work.threads, part_of(work.progress, 0.5, 0.7), [&](std::size_t from, std::size_t to) {
    constexpr std::size_t kAhead = 16;
    for (std::size_t w = from; w < to; ++w) {
      if (w + kAhead < to && words[w + kAhead].crossed != 0)
        __builtin_prefetch(
            &edges_->ends[(w + kAhead) * 64 + static_cast<std::size_t>(std::countr_zero(words[w + kAhead].crossed))]);
      std::uint64_t number = words[w].before;
      for (std::uint64_t word = words[w].crossed; word != 0; word &= word - 1)
        ends_[number++] = edges_->ends[w * 64 + static_cast<std::size_t>(std::countr_zero(word))];
    }
  });
  // from edges to their numbers among the crossed ones
  for_each_item(blocks_.size(), work.threads, part_of(work.progress, 0.7, 1.0),
                [&](std::size_t b) { number_edges(words.data(), of_blocks_[b].data(), of_blocks_[b].size()); });
  for_each_item(polytopes.size(), work.threads, nullptr, [&](std::size_t b) {
    number_edges(words.data(), polytopes[b].numbers.data(), polytopes[b].numbers.size());
  });
}

}  // namespace tegl::detail
