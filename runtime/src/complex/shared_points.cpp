// SPDX-License-Identifier: BSD-3-Clause
//
// Sorts the shared barycentres by the vertices of their polygons.
#include "complex/shared_points.hpp"

#include <algorithm>
#include <bit>

#include "base/progress.hpp"
#include "base/radix_sort.hpp"
#include "base/workers.hpp"

namespace tegl::detail {

namespace {

struct SharedUse {
  PolygonKey key;
  std::uint64_t place;
};

/// The key of a polygon by its edges in a cell.
PolygonKey key_of(std::uint64_t edges, const Index* numbers) noexcept {
  PolygonKey key;
  key.fill(kNoPoint);
  std::size_t count = 0;
  for (; edges != 0; edges &= edges - 1) key[count++] = numbers[std::countr_zero(edges)];
  std::sort(key.begin(), key.end());  // kNoPoint is the largest
  return key;
}

}  // namespace

SharedPoints number_shared_points(const CellTables& tables, const std::vector<ActiveBlock>& blocks,
                                  const CrossingNumbers& crossings, const WorkOptions& work) {
  SharedPoints points;
  const auto first = sums_before(blocks, &ActiveBlock::shared);
  if (first.back() == 0) return points;
  // list
  std::vector<SharedUse> uses(first.back());
  for_each_block(blocks.size(), 1, work.threads, part_of(work.progress, 0.0, 0.5),
                 [&](std::size_t b, std::size_t, std::size_t) {
                   const CellCases& cases = tables.of_group[blocks[b].group];
                   std::uint64_t place = first[b];
                   std::size_t crossing = 0;
                   std::array<Index, 32> numbers{};
                   for (const ActiveCell& cell : blocks[b].cells) {
                     const CellContour contour = cases.of(cell.signature, cell.variant);
                     crossings.of_cell(b, cell, crossing, numbers.data());
                     for (unsigned j = 0; j < contour.list().shared_vertices; ++j, ++place)
                       uses[place] = {key_of(contour.mask(j) >> cases.table().corner_count, numbers.data()), place};
                   }
                 });
  // sort by the first vertex, then among equal ones by the others
  const auto bits = static_cast<unsigned>(std::bit_width(crossings.ends().size()));
  sort_by_bits(uses, bits, [](const SharedUse& use) { return std::uint64_t{use.key[0]}; });
  tell(work.progress, 0.8);
  for (auto at = uses.begin(); at != uses.end();) {
    const auto end = std::find_if(at, uses.end(), [&](const SharedUse& use) { return use.key[0] != at->key[0]; });
    std::sort(at, end, [](const SharedUse& a, const SharedUse& b) { return a.key < b.key; });
    at = end;
  }
  // number
  points.numbers.resize(uses.size());
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (i == 0 || uses[i].key != uses[i - 1].key) points.keys.push_back(uses[i].key);
    points.numbers[uses[i].place] = static_cast<Index>(points.keys.size() - 1);
  }
  tell(work.progress, 1.0);
  return points;
}

}  // namespace tegl::detail
