// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the edges of a complex, then looks up the edges of each cell.
#include "complex/complex_edges.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "tegl/error.hpp"

namespace tegl::detail {

namespace {

/// The blocks of cells from ... to - 1 of a group. `from` is the first cell of a block.
CellBlocks find_blocks(const CellGroup& group, std::size_t from, std::size_t to) {
  CellBlocks blocks;
  std::vector<Index> points;
  for (; from < to; from += CellBlocks::kCells) {
    points.assign(group.cell(from), group.cell(std::min(to, from + CellBlocks::kCells)));
    std::sort(points.begin(), points.end());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i == 0 || points[i] >> 5 != points[i - 1] >> 5) blocks.words.push_back({points[i] >> 5, 0});
      blocks.words.back().mask |= std::uint32_t{1} << (points[i] & 31u);
    }
    blocks.first.push_back(blocks.words.size());
  }
  return blocks;
}

/// Appends the blocks of the next cells.
void append(const CellBlocks& from, CellBlocks& to) {
  const std::size_t words = to.words.size();
  to.words.insert(to.words.end(), from.words.begin(), from.words.end());
  for (std::size_t b = 1; b < from.first.size(); ++b) to.first.push_back(words + from.first[b]);
}

}  // namespace

ComplexEdges find_complex_edges(std::size_t points, const CellGroups& cells, const WorkOptions& work) {
  const std::vector<CellRange> ranges = ranges_of(cells);
  SortedEdges sorted(points, ranges.size() + cells.polytopes.part_count(),
                     [&](std::size_t part, const auto& add) {
                       if (part >= ranges.size()) return cells.polytopes.for_each_edge(part - ranges.size(), add);
                       const CellGroup& group = cells.groups[ranges[part].group];
                       const tables::CellTable& table = table_of(group.shape);
                       for (std::size_t c = ranges[part].from; c < ranges[part].to; ++c)
                         for (std::uint32_t e = 0; e < table.edge_count; ++e)
                           add(group.cell(c)[table.edges[2 * e]], group.cell(c)[table.edges[2 * e + 1]]);
                     },
                     {work.threads, part_of(work.progress, 0.0, 0.7)});
  constexpr std::size_t kMost = std::numeric_limits<Index>::max();
  if (sorted.ends().size() > kMost)
    throw Error(ErrorCode::TooLarge, std::to_string(sorted.ends().size()) + " edges; expected at most " +
                                         std::to_string(kMost) + "; extract without find_edges");
  ComplexEdges edges;
  for (const CellGroup& group : cells.groups)
    edges.of_cells.emplace_back(group.size() * table_of(group.shape).edge_count);
  std::vector<CellBlocks> blocks(ranges.size());
  for_each_block(ranges.size(), 1, work.threads, part_of(work.progress, 0.7, 0.8),
                 [&](std::size_t part, std::size_t, std::size_t) {
                   const auto [g, from, to] = ranges[part];
                   blocks[part] = find_blocks(cells.groups[g], from, to);
                 });
  edges.blocks.resize(cells.groups.size());
  for (std::size_t part = 0; part < ranges.size(); ++part) {
    append(blocks[part], edges.blocks[ranges[part].group]);
    blocks[part] = {};
  }
  for_each_block(ranges.size(), 1, work.threads, part_of(work.progress, 0.8, 1.0),
                 [&](std::size_t part, std::size_t, std::size_t) {
                   const auto [g, from, to] = ranges[part];
                   const CellGroup& group = cells.groups[g];
                   const tables::CellTable& table = table_of(group.shape);
                   Index* number = edges.of_cells[g].data() + from * table.edge_count;
                   for (std::size_t c = from; c < to; ++c)
                     for (std::uint32_t e = 0; e < table.edge_count; ++e)
                       *number++ = static_cast<Index>(
                           sorted.number(group.cell(c)[table.edges[2 * e]], group.cell(c)[table.edges[2 * e + 1]]));
                 });
  edges.ends = sorted.take_ends();
  return edges;
}

}  // namespace tegl::detail
