// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers the crossed edges of a complex.
#include "complex/crossings.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <limits>
#include <string>

#include "base/progress.hpp"
#include "base/radix_sort.hpp"
#include "base/workers.hpp"
#include "complex/cell_contour.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

namespace {

/// A crossed edge of a cell.
struct Crossing {
  std::uint64_t key;    ///< smaller end, then larger end, in as many bits as the points need
  std::uint64_t place;  ///< number of crossings in the cells before
};

/// Calls visit(edge) for the set bits of a set of edges, ascending.
template <class Visit>
void for_each_bit(std::uint32_t edges, const Visit& visit) {
  for (; edges != 0; edges &= edges - 1) visit(static_cast<unsigned>(std::countr_zero(edges)));
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
    : tables_(tables), edges_(edges) {
  if (edges == nullptr)
    sort_crossings(cells, tables, blocks, points, work);
  else
    count_bits(tables, blocks, work);
}

void CrossingNumbers::sort_crossings(const CellGroups& cells, const CellTables& tables,
                                     const std::vector<ActiveBlock>& blocks, std::size_t points,
                                     const WorkOptions& work) {
  const auto bits = static_cast<unsigned>(std::bit_width(std::max<std::size_t>(points, 1) - 1));
  const std::vector<std::uint64_t> first = sums_before(blocks, &ActiveBlock::crossings);
  // list
  std::vector<Crossing> crossings(first.back());
  const Progress listing = part_of(work.progress, 0.0, 0.5);
  for_each_block(blocks.size(), 1, work.threads, listing, [&](std::size_t b, std::size_t, std::size_t) {
    const CellGroup& group = cells.groups[blocks[b].group];
    const tables::CellTable& table = *tables.of_group[blocks[b].group];
    std::uint64_t place = first[b];
    for (const ActiveCell& cell : blocks[b].cells) {
      const Index* const corners = group.cell(cell.cell);
      for_each_bit(crossed_edges(table, cell.signature), [&](unsigned e) {
        const std::uint64_t p = corners[table.edges[2 * e]], q = corners[table.edges[2 * e + 1]];
        crossings[place] = {std::min(p, q) << bits | std::max(p, q), place};
        ++place;
      });
    }
  });
  // sort, then number
  sort_by_bits(crossings, 2 * bits, [](const Crossing& crossing) { return crossing.key; });
  tell(work.progress, 0.8);
  numbers_.resize(crossings.size());
  const std::uint64_t low = (std::uint64_t{1} << bits) - 1;
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const auto [key, place] = crossings[i];
    if (i == 0 || key != crossings[i - 1].key)
      ends_.push_back({static_cast<Index>(key >> bits), static_cast<Index>(key & low)});
    numbers_[place] = static_cast<Index>(ends_.size() - 1);
  }
  require_numbers(ends_.size());
  tell(work.progress, 1.0);
}

void CrossingNumbers::count_bits(const CellTables& tables, const std::vector<ActiveBlock>& blocks,
                                 const WorkOptions& work) {
  // set the bits of crossed edges
  bits_.assign(block_count(edges_->ends.size(), 64), 0);
  const Progress setting = part_of(work.progress, 0.0, 0.7);
  for_each_block(blocks.size(), 1, work.threads, setting, [&](std::size_t b, std::size_t, std::size_t) {
    const tables::CellTable& table = *tables.of_group[blocks[b].group];
    const std::vector<Index>& of_cells = edges_->of_cells[blocks[b].group];
    for (const ActiveCell& cell : blocks[b].cells)
      for_each_bit(crossed_edges(table, cell.signature), [&](unsigned e) {
        const Index edge = of_cells[std::size_t{cell.cell} * table.edge_count + e];
        std::atomic_ref<std::uint64_t> word(bits_[edge >> 6]);
        const std::uint64_t bit = std::uint64_t{1} << (edge & 63u);
        if ((word.load(std::memory_order_relaxed) & bit) == 0) word.fetch_or(bit, std::memory_order_relaxed);
      });
  });
  // count
  before_.resize(bits_.size());
  std::uint64_t count = 0;
  for (std::size_t w = 0; w < bits_.size(); ++w) {
    before_[w] = count;
    count += static_cast<std::uint64_t>(std::popcount(bits_[w]));
  }
  require_numbers(count);
  // list
  ends_.resize(count);
  for_each_part(bits_.size(), work.threads, part_of(work.progress, 0.7, 1.0), [&](std::size_t from, std::size_t to) {
    for (std::size_t w = from; w < to; ++w) {
      std::uint64_t number = before_[w];
      for (std::uint64_t word = bits_[w]; word != 0; word &= word - 1)
        ends_[number++] = edges_->ends[w * 64 + static_cast<std::size_t>(std::countr_zero(word))];
    }
  });
}

void CrossingNumbers::of_cell(const ActiveBlock& block, const ActiveCell& cell, std::uint32_t crossed,
                              std::uint64_t first, Index* numbers) const noexcept {
  if (edges_ == nullptr) {
    for_each_bit(crossed, [&](unsigned e) { numbers[e] = numbers_[first++]; });
    return;
  }
  const Index* const edges =
      edges_->of_cells[block.group].data() + std::size_t{cell.cell} * tables_.of_group[block.group]->edge_count;
  for_each_bit(crossed, [&](unsigned e) {
    const Index edge = edges[e];
    const std::uint64_t below = bits_[edge >> 6] & ((std::uint64_t{1} << (edge & 63u)) - 1);
    numbers[e] = static_cast<Index>(before_[edge >> 6] + static_cast<std::uint64_t>(std::popcount(below)));
  });
}

}  // namespace tegl::detail
