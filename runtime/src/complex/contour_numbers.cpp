// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers the vertices and simplices of a contour of a complex.
#include "complex/contour_numbers.hpp"

#include <algorithm>

#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "kernel/contour_output.hpp"
#include "tegl/error.hpp"
#include "tegl/generated/cells.hpp"

namespace tegl::detail {

namespace {

CellTables tables_of(const CellGroups& cells, const ExtractOptions& options) {
  CellTables tables;
  for (const CellGroup& group : cells.groups)
    tables.of_group.emplace_back(tables::cell_table(group.shape, options.triangulation),
                                 options.ambiguity == Ambiguity::high);
  return tables;
}

WorkOptions work_of(const ExtractOptions& options, const Progress& progress) {
  return {options.work.threads, progress};
}

}  // namespace

void check_complex_options(double isovalue, const ExtractOptions& options) {
  check_arguments(isovalue, options);
  if (options.ambiguity != Ambiguity::low && options.ambiguity != Ambiguity::high)
    throw Error(ErrorCode::InvalidArgument,
                "ambiguity resolved from the data; expected low or high for the contour of a complex");
  if (options.close)
    throw Error(ErrorCode::InvalidArgument, "close is set; expected false for the contour of a complex");
  if (options.normals != Normals::none)
    throw Error(ErrorCode::InvalidArgument, "normals are requested; expected none for the contour of a complex");
}

ContourNumbers::ContourNumbers(const CellGroups& cells, const ComplexEdges* edges, std::span<const double> values,
                               double isovalue, const ExtractOptions& options, const Progress& progress,
                               ExtractStats& stats, const std::vector<Index>* active)
    : tables_(tables_of(cells, options)),
      bits_([&] {
        if (active != nullptr) return PointBits();
        Stopwatch watch;
        PointBits bits = classify_points(values, isovalue, work_of(options, part_of(progress, 0.0, 0.2)));
        watch.add_to(stats.classify_seconds);
        return bits;
      }()),
      blocks_(active == nullptr
                  ? find_active_cells(cells, tables_, bits_, edges, work_of(options, part_of(progress, 0.2, 0.5)))
                  : blocks_of_cells(cells, tables_, *active, values, isovalue,
                                    work_of(options, part_of(progress, 0.2, 0.5)))),
      crossings_(cells, tables_, blocks_, edges, values.size(), work_of(options, part_of(progress, 0.5, 0.8))),
      shared_(number_shared_points(tables_, blocks_, crossings_, work_of(options, part_of(progress, 0.8, 1.0)))),
      first_shared_(sums_before(blocks_, &ActiveBlock::shared)),
      first_own_(sums_before(blocks_, &ActiveBlock::own)),
      first_simplex_(sums_before(blocks_, &ActiveBlock::simplices)),
      own_base_(crossings_.ends().size() + shared_.keys.size()),
      vertex_count_(own_base_ + first_own_.back()) {
  require_numbers(vertex_count_);
  stats.tiles = cells.cell_count;
  for (const ActiveBlock& block : blocks_) stats.active_tiles += block.cells.size();
}

std::vector<Index> ContourNumbers::vertices_at_missing(const CellGroups& cells) const {
  std::vector<Index> vertices;
  const std::vector<EdgeEnds>& ends = edge_ends();
  for (const ActiveBlock& block : blocks_) {
    const CellGroup& group = cells.groups[block.group];
    const tables::CellTable& table = this->table(block.group);
    for (const Index c : block.missing)
      for (std::uint32_t e = 0; e < table.edge_count; ++e) {
        const Index p = group.cell(c)[table.edges[2 * e]], q = group.cell(c)[table.edges[2 * e + 1]];
        if (bits_.is_missing(p) || bits_.is_missing(q) || bits_.is_high(p) == bits_.is_high(q)) continue;
        const EdgeEnds edge{std::min(p, q), std::max(p, q)};
        const auto found = std::lower_bound(ends.begin(), ends.end(), edge);
        if (found != ends.end() && *found == edge) vertices.push_back(static_cast<Index>(found - ends.begin()));
      }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace tegl::detail
