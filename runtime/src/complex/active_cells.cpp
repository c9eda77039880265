// SPDX-License-Identifier: BSD-3-Clause
//
// Compares values with the isovalue, and finds active cells from one bit per point.
#include "complex/active_cells.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <limits>
#include <utility>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "complex/cell_signatures.hpp"

namespace tegl::detail {

namespace {

/// Working memory of a thread.
struct Scratch {
  std::vector<std::uint16_t> signatures, missing;
};

/// Lists the active cells among cells from ... to - 1.
void scan(const CellGroup& group, std::size_t from, std::size_t to, const PointBits& bits, Scratch& scratch,
          ActiveBlock& block) {
  constexpr std::size_t kTogether = 4, kListed = 64;
  const std::size_t count = to - from;
  const auto full = static_cast<std::uint16_t>((1u << group.corner_count) - 1);
  scratch.signatures.resize(count + kTogether);
  std::fill_n(scratch.signatures.begin() + static_cast<std::ptrdiff_t>(count), kTogether, std::uint16_t{0});
  gather_signatures(group, from, to, bits.high.data(), scratch.signatures.data());
  if (!bits.missing.empty()) {
    scratch.missing.resize(count);
    gather_signatures(group, from, to, bits.missing.data(), scratch.missing.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (scratch.missing[i] == 0) continue;
      block.missing.push_back(static_cast<Index>(from + i));
      scratch.signatures[i] = 0;
    }
  }
  // four at a time, as most cells are not active; the four of those that are without a branch for each
  const std::uint64_t all_full = full * std::uint64_t{0x0001000100010001};
  std::array<ActiveCell, kListed> listed;
  std::size_t active = 0;
  const std::uint16_t* const signatures = scratch.signatures.data();
  for (std::size_t i = 0; i < count; i += kTogether) {
    std::uint64_t four = 0;
    std::memcpy(&four, signatures + i, sizeof(four));
    if (four == 0 || four == all_full) continue;
    for (std::size_t j = i; j < i + kTogether; ++j) {
      listed[active] = {static_cast<Index>(from + j), signatures[j], 0};
      active += signatures[j] != 0 && signatures[j] != full ? 1 : 0;
    }
    if (active + kTogether <= kListed) continue;
    block.cells.insert(block.cells.end(), listed.begin(), listed.begin() + static_cast<std::ptrdiff_t>(active));
    active = 0;
  }
  block.cells.insert(block.cells.end(), listed.begin(), listed.begin() + static_cast<std::ptrdiff_t>(active));
}

/// The same, passing over blocks whose points are all high or all low. `from` is the first cell of a block.
void scan_blocks(const CellBlocks& blocks, const CellGroup& group, std::size_t from, std::size_t to,
                 const PointBits& bits, Scratch& scratch, ActiveBlock& block) {
  constexpr std::size_t kCells = CellBlocks::kCells, kCacheLine = 64 / sizeof(Index);
  const auto scan_from = [&](std::size_t first) {
    scan(group, first, std::min(to, first + kCells), bits, scratch, block);
  };
  std::size_t waiting = to;  // a block whose corners have been requested
  for (std::size_t first = from; first < to; first += kCells) {
    if (blocks.is_uniform(first / kCells, bits.high.data())) continue;
    const Index* const corners = group.cell(first);
    const Index* const end = group.cell(std::min(to, first + kCells));
    for (const Index* line = corners; line < end; line += kCacheLine) __builtin_prefetch(line);
    if (waiting != to) scan_from(waiting);
    waiting = first;
  }
  if (waiting != to) scan_from(waiting);
}

/// Resolves ambiguous cells from the values.
void resolve(const CellGroup& group, const ResolvedCells& resolved, std::span<const double> values,
             ActiveBlock& block) {
  std::array<double, 16> at;
  for (ActiveCell& cell : block.cells) {
    if (!resolved.is_ambiguous(cell.signature)) continue;
    const Index* const corners = group.cell(cell.cell);
    for (std::size_t v = 0; v < group.corner_count; ++v) at[v] = values[corners[v]];
    cell.variant = resolved.variant(at.data(), cell.signature);
  }
}

/// Adds up the sizes of the cells' contours.
void add_sizes(const CellCases& cases, ActiveBlock& block) {
  if (cases.is_plain()) {
    for (const ActiveCell& cell : block.cells) {
      const CellCases::Case& of = cases.of_signature(cell.signature);
      block.crossings += of.crossings;
      block.simplices += of.simplices;
    }
    return;
  }
  for (const ActiveCell& cell : block.cells) {
    const tables::CellList& list = cases.of(cell.signature, cell.variant).list();
    block.crossings += cases.crossing_count(cell.signature);
    block.simplices += list.simplex_count;
    block.shared += list.shared_vertices;
    block.own += list.added() - list.shared_vertices;
  }
}

/// Adds up the sizes, or lists the keys of contours that are not built yet.
void finish(const CellGroup& group, const CellCases& cases, std::span<const double> values, ActiveBlock& block) {
  if (cases.resolved() != nullptr) resolve(group, *cases.resolved(), values, block);
  if (cases.built() == nullptr) return add_sizes(cases, block);
  block.keys.reserve(block.cells.size());
  for (const ActiveCell& cell : block.cells)
    block.keys.push_back(cases.built()->key(cell.signature, group.cell(cell.cell), values));
}

/// Keys in ascending order, each once.
void make_distinct(std::vector<CellKey>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// Builds the contours of 4D cells that are not in a table.
void build_contours(const CellTables& tables, std::vector<ActiveBlock>& blocks, const WorkOptions& work) {
  const auto of_block = [&](std::size_t b) { return tables.of_group[blocks[b].group].built(); };
  if (std::all_of(tables.of_group.begin(), tables.of_group.end(),
                  [](const CellCases& cases) { return cases.built() == nullptr; }))
    return;
  std::vector<std::vector<CellKey>> distinct(blocks.size());
  for_each_block(blocks.size(), 1, work.threads, part_of(work.progress, 0.0, 0.3),
                 [&](std::size_t b, std::size_t, std::size_t) {
                   distinct[b] = blocks[b].keys;
                   make_distinct(distinct[b]);
                 });
  for (std::size_t g = 0; g < tables.of_group.size(); ++g) {
    if (tables.of_group[g].built() == nullptr) continue;
    std::vector<CellKey> keys;
    for (std::size_t b = 0; b < blocks.size(); ++b)
      if (blocks[b].group == g) keys.insert(keys.end(), distinct[b].begin(), distinct[b].end());
    make_distinct(keys);
    const double groups = static_cast<double>(tables.of_group.size()), at = static_cast<double>(g);
    tables.of_group[g].built()->build(std::move(keys), {work.threads, part_of(work.progress, 0.3 + 0.5 * at / groups,
                                                                              0.3 + 0.5 * (at + 1) / groups)});
  }
  for_each_block(blocks.size(), 1, work.threads, part_of(work.progress, 0.8, 1.0),
                 [&](std::size_t b, std::size_t, std::size_t) {
                   ActiveBlock& block = blocks[b];
                   if (of_block(b) == nullptr) return;
                   for (std::size_t i = 0; i < block.cells.size(); ++i)
                     block.cells[i].variant = of_block(b)->variant(block.keys[i]);
                   block.keys = {};
                   add_sizes(tables.of_group[block.group], block);
                 });
}

}  // namespace

PointBits classify_points(std::span<const double> values, double isovalue, const WorkOptions& work) {
  PointBits bits;
  const std::size_t words = block_count(values.size(), 32);
  bits.high.resize(words);
  std::vector<std::uint32_t> missing(words);
  std::atomic<bool> any_missing = false;
  for_each_part(words, work.threads, work.progress, [&](std::size_t from, std::size_t to) {
    const std::size_t whole = std::clamp(values.size() / 32, from, to);
    compare_values(values.data() + from * 32, whole - from, isovalue, bits.high.data() + from, missing.data() + from);
    if (whole < to) {  // the last word
      std::array<double, 32> rest;
      rest.fill(-std::numeric_limits<double>::infinity());
      std::copy(values.begin() + static_cast<std::ptrdiff_t>(whole * 32), values.end(), rest.begin());
      compare_values(rest.data(), 1, isovalue, bits.high.data() + whole, missing.data() + whole);
    }
    if (std::any_of(missing.begin() + static_cast<std::ptrdiff_t>(from),
                    missing.begin() + static_cast<std::ptrdiff_t>(to), [](std::uint32_t word) { return word != 0; }))
      any_missing.store(true, std::memory_order_relaxed);
  });
  if (any_missing) bits.missing = std::move(missing);
  return bits;
}

std::vector<ActiveBlock> find_active_cells(const CellGroups& cells, const CellTables& tables, const PointBits& bits,
                                           const ComplexEdges* edges, std::span<const double> values,
                                           const WorkOptions& work) {
  const std::vector<CellRange> ranges = ranges_of(cells);
  std::vector<ActiveBlock> blocks(ranges.size());
  for_each_block(
      ranges.size(), 1, work.threads, part_of(work.progress, 0.0, 0.5), [] { return Scratch(); },
      [&](std::size_t b, std::size_t, std::size_t, Scratch& scratch) {
        const auto& [group, from, to] = ranges[b];
        blocks[b].group = group;
        if (edges == nullptr || !bits.missing.empty())
          scan(cells.groups[group], from, to, bits, scratch, blocks[b]);
        else
          scan_blocks(edges->blocks[group], cells.groups[group], from, to, bits, scratch, blocks[b]);
        finish(cells.groups[group], tables.of_group[group], values, blocks[b]);
      });
  build_contours(tables, blocks, {work.threads, part_of(work.progress, 0.5, 1.0)});
  return blocks;
}

std::vector<ActiveBlock> blocks_of_cells(const CellGroups& cells, const CellTables& tables,
                                         std::span<const Index> active, std::span<const double> values, double isovalue,
                                         const WorkOptions& work) {
  constexpr std::ptrdiff_t kCells = 4096;  // of a block
  struct Part {
    std::size_t group;
    std::uint64_t before;  // cells in groups before
    const Index *first, *end;
  };
  std::vector<Part> parts;
  std::uint64_t before = 0;
  const Index* at = active.data();
  for (std::size_t g = 0; g < cells.groups.size(); ++g, before += cells.groups[g - 1].size()) {
    const Index* const end = std::lower_bound(at, active.data() + active.size(), before + cells.groups[g].size(),
                                              [](Index cell, std::uint64_t bound) { return cell < bound; });
    for (; at != end; at = parts.back().end)
      parts.push_back({g, before, at, std::min(end, at + std::min(kCells, end - at))});
  }
  std::vector<ActiveBlock> blocks(parts.size());
  for_each_item(parts.size(), work.threads, part_of(work.progress, 0.0, 0.5), [&](std::size_t b) {
    const Part& part = parts[b];
    const CellGroup& group = cells.groups[part.group];
    const unsigned full = (1u << group.corner_count) - 1;
    blocks[b].group = part.group;
    for (const Index* number = part.first; number != part.end; ++number) {
      const auto cell = static_cast<Index>(*number - part.before);
      const Index* const corners = group.cell(cell);
      unsigned signature = 0;
      for (std::size_t c = 0; c < group.corner_count; ++c) signature |= (values[corners[c]] >= isovalue ? 1u : 0u) << c;
      if (signature != 0 && signature != full)
        blocks[b].cells.push_back({cell, static_cast<std::uint16_t>(signature), 0});
    }
    finish(group, tables.of_group[part.group], values, blocks[b]);
  });
  build_contours(tables, blocks, {work.threads, part_of(work.progress, 0.5, 1.0)});
  return blocks;
}

}  // namespace tegl::detail
