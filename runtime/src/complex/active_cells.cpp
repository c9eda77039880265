// SPDX-License-Identifier: BSD-3-Clause
//
// Compares values with the isovalue, and finds active cells from one bit per point.
#include "complex/active_cells.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "base/workers.hpp"
#include "complex/cell_contour.hpp"

namespace tegl::detail {

namespace {

constexpr std::size_t kBlockCells = std::size_t{1} << 14;

/// The signatures of cells, compiled for each number of corners so that the loop over corners unrolls.
template <std::size_t kCorners>
void scan(const CellGroup& group, std::size_t from, std::size_t to, const PointBits& bits, ActiveBlock& block) {
  constexpr unsigned kFull = (1u << kCorners) - 1;
  for (std::size_t c = from; c < to; ++c) {
    const Index* const corners = group.corners.data() + c * kCorners;
    unsigned signature = 0;
    for (std::size_t v = 0; v < kCorners; ++v) signature |= PointBits::at(bits.high, corners[v]) << v;
    if (!bits.missing.empty()) {
      unsigned missing = 0;
      for (std::size_t v = 0; v < kCorners; ++v) missing |= PointBits::at(bits.missing, corners[v]);
      if (missing != 0) {
        block.missing.push_back(static_cast<Index>(c));
        continue;
      }
    }
    if (signature == 0 || signature == kFull) continue;
    block.cells.push_back({static_cast<Index>(c), static_cast<std::uint16_t>(signature)});
  }
}

void scan(const CellGroup& group, std::size_t from, std::size_t to, const PointBits& bits, ActiveBlock& block) {
  switch (group.corner_count) {
    case 3:
      return scan<3>(group, from, to, bits, block);
    case 4:
      return scan<4>(group, from, to, bits, block);
    case 5:
      return scan<5>(group, from, to, bits, block);
    case 6:
      return scan<6>(group, from, to, bits, block);
    case 8:
      return scan<8>(group, from, to, bits, block);
    case 10:
      return scan<10>(group, from, to, bits, block);
    case 12:
      return scan<12>(group, from, to, bits, block);
    default:
      return scan<16>(group, from, to, bits, block);
  }
}

void add_sizes(const tables::CellTable& table, bool high_connected, ActiveBlock& block) {
  for (const ActiveCell& cell : block.cells) {
    const tables::CellList& list = CellContour(table, cell.signature, high_connected).list();
    block.crossings += static_cast<std::uint64_t>(std::popcount(crossed_edges(table, cell.signature)));
    block.simplices += list.simplex_count;
    block.shared += list.shared_vertices;
    block.own += list.added() - list.shared_vertices;
  }
}

}  // namespace

PointBits classify_points(std::span<const double> values, double isovalue, const WorkOptions& work) {
  PointBits bits;
  const std::size_t words = block_count(values.size(), 64);
  bits.high.resize(words);
  std::vector<std::uint64_t> missing(words);
  std::atomic<bool> any_missing = false;
  for_each_part(words, work.threads, work.progress, [&](std::size_t from, std::size_t to) {
    for (std::size_t w = from; w < to; ++w) {
      std::uint64_t high = 0, none = 0;
      const std::size_t end = std::min(values.size(), (w + 1) * 64);
      for (std::size_t p = w * 64; p < end; ++p) {
        high |= std::uint64_t{values[p] >= isovalue} << (p & 63u);
        none |= std::uint64_t{std::isnan(values[p])} << (p & 63u);
      }
      bits.high[w] = high;
      missing[w] = none;
      if (none != 0) any_missing.store(true, std::memory_order_relaxed);
    }
  });
  if (any_missing) bits.missing = std::move(missing);
  return bits;
}

std::vector<ActiveBlock> find_active_cells(const CellGroups& cells, const CellTables& tables, const PointBits& bits,
                                           const WorkOptions& work) {
  struct Range {
    std::size_t group, from, to;
  };
  std::vector<Range> ranges;
  for (std::size_t g = 0; g < cells.groups.size(); ++g)
    for (std::size_t from = 0; from < cells.groups[g].size(); from += kBlockCells)
      ranges.push_back({g, from, std::min(cells.groups[g].size(), from + kBlockCells)});
  std::vector<ActiveBlock> blocks(ranges.size());
  for_each_block(ranges.size(), 1, work.threads, work.progress, [&](std::size_t b, std::size_t, std::size_t) {
    const auto& [group, from, to] = ranges[b];
    blocks[b].group = group;
    scan(cells.groups[group], from, to, bits, blocks[b]);
    add_sizes(*tables.of_group[group], tables.high_connected, blocks[b]);
  });
  return blocks;
}

}  // namespace tegl::detail
