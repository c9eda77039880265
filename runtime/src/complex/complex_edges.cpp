// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the edges of a complex by buckets of their smaller ends.
#include "complex/complex_edges.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

namespace {

/// Calls visit(smaller end, larger end) for all edges of the cells from ... to - 1 of a group.
template <class Visit>
void for_each_edge(const CellGroup& group, std::size_t from, std::size_t to, const Visit& visit) {
  const tables::CellTable& table = table_of(group.shape);
  for (std::size_t c = from; c < to; ++c) {
    const Index* const corners = group.cell(c);
    for (std::uint32_t e = 0; e < table.edge_count; ++e) {
      const Index a = corners[table.edges[2 * e]], b = corners[table.edges[2 * e + 1]];
      visit(std::min(a, b), std::max(a, b));
    }
  }
}

/// The larger ends of edges in buckets of their smaller ends.
struct Buckets {
  std::vector<std::uint64_t> first;  ///< by point, and the end
  std::vector<Index> others;
};

Buckets fill_buckets(std::size_t points, const CellGroups& cells, const Progress& progress) {
  Buckets buckets;
  buckets.first.assign(points + 1, 0);
  // count, exclusive scan, write
  for (const CellGroup& group : cells.groups)
    for_each_edge(group, 0, group.size(), [&](Index a, Index) { ++buckets.first[a + std::size_t{1}]; });
  for (std::size_t p = 0; p < points; ++p) buckets.first[p + 1] += buckets.first[p];
  buckets.others.resize(buckets.first.back());
  std::vector<std::uint64_t> next(buckets.first.begin(), buckets.first.end() - 1);
  std::size_t done = 0;
  for (const CellGroup& group : cells.groups) {
    const std::size_t before = done;
    in_parts(group.size(),
             part_of(progress, static_cast<double>(before) / static_cast<double>(cells.cell_count),
                     static_cast<double>(before + group.size()) / static_cast<double>(cells.cell_count)),
             [&](std::size_t from, std::size_t to) {
               for_each_edge(group, from, to, [&](Index a, Index b) { buckets.others[next[a]++] = b; });
             });
    done += group.size();
  }
  return buckets;
}

}  // namespace

ComplexEdges find_complex_edges(std::size_t points, const CellGroups& cells, const WorkOptions& work) {
  ComplexEdges edges;
  Buckets buckets = fill_buckets(points, cells, part_of(work.progress, 0.0, 0.4));
  // sort each bucket and drop duplicates
  std::vector<std::uint64_t> first(points + 1, 0);  // first edge of each point
  for_each_item(points, work.threads, part_of(work.progress, 0.4, 0.6), [&](std::size_t p) {
    const auto begin = buckets.others.begin() + static_cast<std::ptrdiff_t>(buckets.first[p]);
    const auto end = buckets.others.begin() + static_cast<std::ptrdiff_t>(buckets.first[p + 1]);
    std::sort(begin, end);
    first[p + 1] = static_cast<std::uint64_t>(std::unique(begin, end) - begin);
  });
  for (std::size_t p = 0; p < points; ++p) first[p + 1] += first[p];
  if (first.back() > std::numeric_limits<Index>::max())
    throw Error(ErrorCode::TooLarge, std::to_string(first.back()) + " edges; expected at most " +
                                         std::to_string(std::numeric_limits<Index>::max()) +
                                         "; extract without find_edges");
  edges.ends.resize(first.back());
  for_each_item(points, work.threads, part_of(work.progress, 0.6, 0.7), [&](std::size_t p) {
    for (std::uint64_t i = first[p]; i < first[p + 1]; ++i)
      edges.ends[i] = {static_cast<Index>(p), buckets.others[buckets.first[p] + (i - first[p])]};
  });
  // look up the edges of each cell
  for (std::size_t g = 0; g < cells.groups.size(); ++g) {
    const CellGroup& group = cells.groups[g];
    std::vector<Index>& numbers = edges.of_cells.emplace_back(group.size() * table_of(group.shape).edge_count);
    const double share = 0.3 / static_cast<double>(cells.groups.size()), begin = 0.7 + share * static_cast<double>(g);
    for_each_part(group.size(), work.threads, part_of(work.progress, begin, begin + share),
                  [&](std::size_t from, std::size_t to) {
                    Index* number = numbers.data() + from * table_of(group.shape).edge_count;
                    for_each_edge(group, from, to, [&](Index a, Index b) {
                      std::uint64_t i = first[a];
                      while (edges.ends[i][1] != b) ++i;  // a few edges per point
                      *number++ = static_cast<Index>(i);
                    });
                  });
  }
  return edges;
}

}  // namespace tegl::detail
