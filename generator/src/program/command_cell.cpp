// SPDX-License-Identifier: BSD-3-Clause
//
// `gen --tile CELL` without a command and with `--certify`: figures of one mesh cell.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "cells/cell.hpp"
#include "cells/cell_tables.hpp"
#include "filling/resolutions.hpp"
#include "program/commands.hpp"
#include "program/print_figures.hpp"

namespace tegl::gen {

namespace {

/// The tables of a cell, in both triangulations where it has two.
std::vector<CellTables> tables_of(const Cell& cell) {
  std::vector<CellTables> tables{make_cell_tables(cell, Triangulation::barycentric)};
  if (cell.tile.dim < 4) tables.push_back(make_cell_tables(cell, Triangulation::compact));
  return tables;
}

/// The figures of all signatures, low and high alternative.
using BothAlternatives = std::array<ResolutionFigures, 2>;

constexpr std::array kAlternatives{Alternative::low, Alternative::high};

/// Certifies every signature one by one. Throws if the barycentric table, made by class in 4D, has other figures.
BothAlternatives certify_signatures(const Cell& cell, const CellTables& table) {
  BothAlternatives figures;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    figures[i] = certify_all_signatures(cell.lattice, kAlternatives[i], 0);
    if (figures[i].simplices != table.total_simplices || figures[i].non_spherical != table.others)
      throw Error(
          ErrorCode::CountMismatch,
          fmt::format("{}, {} alternative: {} simplices and {} signatures with a component that is no sphere, one "
                      "by one; {} and {} in the table: expected the same",
                      cell.name, alternative_name(kAlternatives[i]), figures[i].simplices, figures[i].non_spherical,
                      table.total_simplices, table.others));
  }
  return figures;
}

void print_signatures(const Options& options, const BothAlternatives& all) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ResolutionFigures& f = all[i];
    fmt::print("{}-{}, {} alternative, barycentric triangulation\n", options.dim, options.cell->given,
               alternative_name(kAlternatives[i]));
    fmt::print("  certified    all {} signatures, one by one\n", f.tiles);
    fmt::print("  filled by    simplex {}, cone {}, side {}\n", f.by_filling[0], f.by_filling[1], f.by_filling[2]);
    if (options.dim == 4) fmt::print("  tori         in {} signatures\n", f.non_spherical);
    fmt::print("  simplices    {}: {:.2f} per signature, at most {}\n", f.simplices,
               static_cast<double>(f.simplices) / static_cast<double>(f.tiles), f.max_simplices);
  }
}

void print_tables(const std::vector<CellTables>& tables) {
  fmt::print("\n{:<13} {:>10} {:>7} {:>9} {:>13} {:>9} {:>7} {:>8} {:>8}\n", "table", "signatures", "classes",
             "certified", "non-spherical", "simplices", "at most", "proved", "searched");
  for (const CellTables& t : tables)
    fmt::print("{:<13} {:>10} {:>7} {:>9} {:>13} {:>9} {:>7} {:>8} {:>8}\n", triangulation_name(t.triangulation),
               t.list_of.size(), t.classes, t.certified, t.others, t.total_simplices, t.max_simplices, t.proved,
               t.list_of.size() - t.proved);
}

std::string json_of(const std::vector<CellTables>& tables) {
  std::vector<std::string> parts;
  for (const CellTables& t : tables)
    parts.push_back(
        fmt::format("{{\"triangulation\": \"{}\", \"signatures\": {}, \"classes\": {}, \"certified\": {}, "
                    "\"signatures_with_non_spherical\": {}, \"simplices\": {}, \"max_simplices\": {}, "
                    "\"embedded_proved\": {}, \"embedded_searched\": {}}}",
                    triangulation_name(t.triangulation), t.list_of.size(), t.classes, t.certified, t.others,
                    t.total_simplices, t.max_simplices, t.proved, t.list_of.size() - t.proved));
  return fmt::format("[\n  {}\n]", fmt::join(parts, ",\n  "));
}

}  // namespace

int run_cell_certify(const Options& options) {
  const Cell cell = mesh_cell(options.cell->shape);
  const std::vector<CellTables> tables = tables_of(cell);
  const BothAlternatives all = certify_signatures(cell, tables.front());
  if (!options.json) {
    print_signatures(options, all);
    print_tables(tables);
    return 0;
  }
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < all.size(); ++i)
    parts.push_back(fmt::format(
        "{{\"alternative\": \"{}\", \"triangulation\": \"barycentric\", \"signatures\": {}, \"passed\": {}, "
        "\"facets\": {{\"simplex\": {}, \"cone\": {}, \"side\": {}}}, \"signatures_with_non_spherical\": {}, "
        "\"simplices\": {}, \"max_simplices\": {}}}",
        alternative_name(kAlternatives[i]), cell.tile.full() + 1, all[i].tiles, all[i].by_filling[0],
        all[i].by_filling[1], all[i].by_filling[2], all[i].non_spherical, all[i].simplices, all[i].max_simplices));
  fmt::print("{{\"tile\": \"{}\", \"dim\": {}, \"certified\": [\n  {}\n], \"tables\": {}}}\n", options.cell->given,
             options.dim, fmt::join(parts, ",\n  "), json_of(tables));
  return 0;
}

int run_cell_summary(const Options& options) {
  const auto start = std::chrono::steady_clock::now();
  const Cell cell = mesh_cell(options.cell->shape);
  const std::vector<GroupCount> counts = count_classes(cell.tile);
  if (!options.json) print_group_counts(options, cell.tile.corner_count(), counts);
  const std::vector<CellTables> tables = tables_of(cell);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (options.json) {
    fmt::print("{{{}, \"tables\": {}, \"seconds\": {:.2f}}}\n",
               group_counts_json(options, cell.tile.corner_count(), counts), json_of(tables), seconds);
    return 0;
  }
  print_tables(tables);
  fmt::print("\nMade and certified in {:.2f} s.\n", seconds);
  return 0;
}

}  // namespace tegl::gen
