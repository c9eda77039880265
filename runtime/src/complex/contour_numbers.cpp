// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers the vertices and simplices of a contour of a complex.
#include "complex/contour_numbers.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "ambiguity/face_estimator.hpp"
#include "base/progress.hpp"
#include "base/stopwatch.hpp"
#include "kernel/contour_output.hpp"
#include "prisms/solid_contours.hpp"
#include "tegl/error.hpp"
#include "tegl/generated/cells.hpp"
#include "tegl/normals.hpp"

namespace tegl::detail {

namespace {

CellTables tables_of(const CellGroups& cells, double isovalue, const ExtractOptions& options) {
  CellTables tables;
  for (const CellGroup& group : cells.groups) {
    const tables::CellTable& table = tables::cell_table(group.shape, options.triangulation);
    std::shared_ptr<const ResolvedCells> resolved;
    const bool is_decided = is_estimated(options.ambiguity);
    if (is_decided && table.dim < 4)
      resolved = std::make_shared<const ResolvedCells>(group.shape, table, options.triangulation,
                                                       face_rule(options.ambiguity), isovalue);
    std::shared_ptr<BuiltCells> built;
    const bool high_connected = options.ambiguity == Ambiguity::high;
    if (is_decided && table.dim == 4)
      built = std::make_shared<DecidedCells>(group.shape, options.triangulation, face_rule(options.ambiguity), isovalue,
                                             group.is_swept);
    else if (table.dim == 4 && options.triangulation == Triangulation::compact)
      built = std::make_shared<CompactCells>(group.shape, high_connected, group.is_swept);
    tables.of_group.emplace_back(table, high_connected, std::move(resolved), std::move(built));
  }
  return tables;
}

WorkOptions work_of(const ExtractOptions& options, const Progress& progress) {
  return {options.work.threads, progress};
}

/// The contours of polygons and polyhedra: of all, or of those in a list of cells.
std::vector<PolytopeBlock> polytope_blocks(const CellGroups& cells, std::span<const double> values, double isovalue,
                                           const ExtractOptions& options, const std::vector<Index>* active,
                                           const Progress& progress) {
  if (cells.polytopes.size() == 0) return {};
  const PolytopeRules rules = rules_of(options, isovalue);
  std::vector<Index> listed;
  if (active != nullptr) {
    const auto first = static_cast<Index>(cells.cell_count - cells.polytopes.size());
    for (auto at = std::lower_bound(active->begin(), active->end(), first); at != active->end(); ++at)
      listed.push_back(*at - first);
  }
  const auto* const of = active == nullptr ? nullptr : &listed;
  if (cells.polytopes.dim() == 4)
    return build_solid_contours(cells.polytopes, values, rules, of, work_of(options, progress));
  return build_polytope_contours(cells.polytopes, values, rules, of, work_of(options, progress));
}

}  // namespace

PolytopeRules rules_of(const ExtractOptions& options, double isovalue) {
  PolytopeRules rules;
  rules.is_compact = options.triangulation == Triangulation::compact;
  rules.joins_high = options.ambiguity == Ambiguity::high;
  if (is_estimated(options.ambiguity)) rules.rule = face_rule(options.ambiguity);
  rules.isovalue = isovalue;
  return rules;
}

void check_complex_options(double isovalue, const ExtractOptions& options) {
  check_arguments(isovalue, options);
  if (options.ambiguity == Ambiguity::custom)
    throw Error(
        ErrorCode::InvalidArgument,
        "ambiguity resolved by a custom estimator; expected another rule for meshes, lattices and divided cells");
  if (options.normals != Normals::none && options.normals != Normals::differences)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} normals; expected gradient, geometric or flat for meshes, lattices and divided cells",
                            name_of(options.normals)));
}

ContourNumbers::ContourNumbers(const CellGroups& cells, const ComplexEdges* edges, std::span<const double> values,
                               double isovalue, const ExtractOptions& options, const Progress& progress,
                               ExtractStats& stats, const std::vector<Index>* active)
    : tables_(tables_of(cells, isovalue, options)),
      bits_([&] {
        if (active != nullptr) return PointBits();
        Stopwatch watch;
        PointBits bits = classify_points(values, isovalue, work_of(options, part_of(progress, 0.0, 0.2)));
        watch.add_to(stats.classify_seconds);
        return bits;
      }()),
      blocks_(active == nullptr ? find_active_cells(cells, tables_, bits_, edges, values,
                                                    work_of(options, part_of(progress, 0.2, 0.4)))
                                : blocks_of_cells(cells, tables_, *active, values, isovalue,
                                                  work_of(options, part_of(progress, 0.2, 0.4)))),
      polytopes_(polytope_blocks(cells, values, isovalue, options, active, part_of(progress, 0.4, 0.5))),
      crossings_(cells, tables_, blocks_, polytopes_, edges, values.size(),
                 work_of(options, part_of(progress, 0.5, 0.8))),
      shared_(number_shared_points(cells, tables_, blocks_, polytopes_, crossings_,
                                   work_of(options, part_of(progress, 0.8, 1.0)))),
      first_shared_(sums_before(blocks_, &ActiveBlock::shared)),
      first_own_(sums_before(blocks_, &ActiveBlock::own)),
      first_simplex_(sums_before(blocks_, &ActiveBlock::simplices)),
      own_base_(crossings_.ends().size() + shared_.keys.size()),
      vertex_count_(own_base_ + first_own_.back()),
      simplex_count_(first_simplex_.back()) {
  if (cells.polytopes.dim() != 4) separate_diagonals(polytopes_, options.work.threads);
  std::uint64_t shared = first_shared_.back();
  for (const PolytopeBlock& block : polytopes_) {
    polytope_shared_.push_back(std::exchange(shared, shared + block.shared.size()));
    polytope_own_.push_back(std::exchange(vertex_count_, vertex_count_ + block.own));
    polytope_simplex_.push_back(std::exchange(simplex_count_, simplex_count_ + block.simplices));
    stats.active_tiles += block.active;
  }
  require_numbers(vertex_count_);
  stats.tiles = cells.cell_count;
  for (const ActiveBlock& block : blocks_) stats.active_tiles += block.cells.size();
}

Index ContourNumbers::polygon(std::span<const Index> vertices) const {
  PolygonKey key;
  key.fill(kNoPoint);
  if (vertices.size() > key.size()) return kNoPoint;
  std::copy(vertices.begin(), vertices.end(), key.begin());
  std::sort(key.begin(), key.end());
  return number_of(key);
}

Index ContourNumbers::polygon_in(const std::array<Index, 4>& facet, std::span<const Index> vertices) const {
  return number_of(key_of_loop(*std::min_element(vertices.begin(), vertices.end()), facet));
}

Index ContourNumbers::in_cube(const CubePoint& point, Index crossing) const {
  return number_of(key_of(point, crossing));
}

Index ContourNumbers::number_of(const PolygonKey& key) const {
  const auto found = std::lower_bound(shared_.keys.begin(), shared_.keys.end(), key);
  if (found == shared_.keys.end() || *found != key) return kNoPoint;
  return static_cast<Index>(edge_ends().size() + static_cast<std::size_t>(found - shared_.keys.begin()));
}

std::vector<CellSimplices> ContourNumbers::simplices_by_cell(const CellGroups& cells) const {
  std::vector<CellSimplices> all;
  std::vector<Index> first_cell;  // by group, then of the polytopes
  Index count = 0;
  for (const CellGroup& group : cells.groups) first_cell.push_back(std::exchange(count, count + group.size()));
  std::uint32_t end = 0;
  for (const ActiveBlock& block : blocks_)
    for (const ActiveCell& cell : block.cells) {
      end += tables_.of_group[block.group].of(cell.signature, cell.variant).list().simplex_count;
      all.push_back({first_cell[block.group] + cell.cell, static_cast<std::uint16_t>(cell.signature), end});
    }
  for (const PolytopeBlock& block : polytopes_) {
    std::uint32_t from = 0;
    for (const PolytopeBlock::Piece& piece : block.pieces) {
      const std::uint32_t size = piece.end - std::exchange(from, piece.end);
      end += cells.polytopes.dim() == 4 ? size : size == 2 ? 1 : (piece.is_coned ? size : size - 2);
      const Index cell = count + piece.cell;
      if (all.empty() || all.back().cell != cell) all.push_back({cell, 0, end});
      all.back().end = end;
    }
  }
  return all;
}

std::vector<Index> ContourNumbers::vertices_at_missing(const CellGroups& cells) const {
  std::vector<Index> vertices;
  const std::vector<EdgeEnds>& ends = edge_ends();
  const auto add = [&](Index p, Index q) {
    if (bits_.is_missing(p) || bits_.is_missing(q) || bits_.is_high(p) == bits_.is_high(q)) return;
    const EdgeEnds edge{std::min(p, q), std::max(p, q)};
    const auto found = std::lower_bound(ends.begin(), ends.end(), edge);
    if (found != ends.end() && *found == edge) vertices.push_back(static_cast<Index>(found - ends.begin()));
  };
  for (const ActiveBlock& block : blocks_) {
    const CellGroup& group = cells.groups[block.group];
    const tables::CellTable& table = this->table(block.group);
    for (const Index c : block.missing)
      for (std::uint32_t e = 0; e < table.edge_count; ++e)
        add(group.cell(c)[table.edges[2 * e]], group.cell(c)[table.edges[2 * e + 1]]);
  }
  for (const PolytopeBlock& block : polytopes_)
    for (const Index c : block.missing)
      for (const auto& [a, b] : cells.polytopes.shape(c).edges())
        add(cells.polytopes.cell(c)[a], cells.polytopes.cell(c)[b]);
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace tegl::detail
