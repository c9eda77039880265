// SPDX-License-Identifier: BSD-3-Clause
//
// `gen --dim N` without a command: makes and certifies all tables and the builder of a dimension in memory and prints a
// summary.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "builders/emit_builder.hpp"
#include "filling/resolutions.hpp"
#include "program/commands.hpp"
#include "program/print_figures.hpp"
#include "symmetry/counting.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "symmetry/transversal.hpp"
#include "tables/emit_text.hpp"
#include "tables/table_set.hpp"

namespace tegl::gen {

std::vector<GroupCount> count_classes(const Tile& tile) {
  std::vector<GroupCount> counts{
      {GroupKind::Full, false}, {GroupKind::Rotations, false}, {GroupKind::Full, true}, {GroupKind::Rotations, true}};
  for (GroupCount& count : counts) {
    Transversal classes;
    if (tile.kind == TileKind::cube) {
      const std::vector<Element> elements = group(tile.dim, count.kind, count.inversion);
      classes = transversal(tile.dim, elements);
      require_burnside_count(classes, tile.dim, count.kind, count.inversion);
      count.order = elements.size();
    } else {
      const std::vector<TileSymmetry> elements = symmetries(tile, count.kind, count.inversion);
      classes = transversal(tile, elements);
      require_burnside_count(classes, elements);
      count.order = elements.size();
    }
    count.classes = classes.representatives.size();
  }
  return counts;
}

std::vector<GroupCount> count_classes_by_burnside(int dim) {
  std::vector<GroupCount> counts;
  for (const bool inversion : {false, true})
    for (const GroupKind kind : {GroupKind::Full, GroupKind::Rotations})
      counts.push_back({kind, inversion, group_order(dim, kind, inversion),
                        std::stoull(burnside_orbits(dim, kind, inversion).to_decimal())});
  return counts;
}

void print_group_counts(const Options& options, unsigned corners, const std::vector<GroupCount>& counts) {
  fmt::print("{}-{}: {} corners, {} signatures\n\nclasses   order  group\n", options.dim,
             options.tile == TileKind::cube ? "tile" : tile_text(options), corners, std::uint64_t{1} << corners);
  for (const GroupCount& count : counts)
    fmt::print("{:>7} {:>7}  {}{}\n", count.classes, count.order,
               count.kind == GroupKind::Full ? "all symmetries" : "rotations",
               count.inversion ? ", with the exchange of high and low" : "");
  fmt::print("The classes are counted by {}Burnside's lemma.\n",
             options.dim <= kMaxEnumeratedDim ? "enumeration and by " : "");
  std::fflush(stdout);  // certifying takes a minute of processor time in 4D
}

std::string group_counts_json(const Options& options, unsigned corners, const std::vector<GroupCount>& counts) {
  std::vector<std::string> groups;
  for (const GroupCount& count : counts)
    groups.push_back(fmt::format("{{\"group\": \"{}\", \"inversion\": {}, \"order\": {}, \"classes\": {}}}",
                                 count.kind == GroupKind::Full ? "full" : "rotations", count.inversion, count.order,
                                 count.classes));
  return fmt::format("\"tile\": \"{}\", \"dim\": {}, \"corners\": {}, \"signatures\": {}, \"groups\": [\n  {}\n]",
                     tile_text(options), options.dim, corners, std::uint64_t{1} << corners, fmt::join(groups, ",\n  "));
}

namespace {

/// The size of a table's data in memory.
struct TableSize {
  std::string name;
  const char* layout;
  std::size_t lists;
  std::size_t simplices;
  std::size_t bytes;
};

template <typename... Entries>
std::size_t bytes_of(const std::vector<Entries>&... arrays) {
  return (... + (arrays.size() * sizeof(Entries)));
}

TableSize size_of(const std::string& name, const TileTables& t) {
  return {
      name, layout_name(t.layout), t.lists.size(), t.simplices.size() / static_cast<std::size_t>(t.dim),
      bytes_of(t.list_of, t.element_of, t.slot_swaps, t.permutations, t.reverses, t.lists, t.simplices, t.side_masks)};
}

/// Rows refer to the simplices of other tables and have none of their own.
std::size_t bytes_of_rows(const RowTables& t) {
  return bytes_of(t.entries, t.counts, t.shuffles, t.variant_places, t.variants);
}

std::vector<TableSize> sizes(const TableSet& set) {
  std::vector<TableSize> result;
  for (const TileTables& t : set.tiles)
    result.push_back(size_of(tile_name(t.tile, t.dim) + "_" + triangulation_name(t.triangulation), t));
  if (set.balanced) {
    result.push_back(size_of("tile4_balanced", *set.balanced));
    result.push_back({"tile4_balanced_rows", layout_name(Layout::flat), set.balanced_rows.entries.size(), 0,
                      bytes_of_rows(set.balanced_rows)});
  }
  for (const RegionTables& t : set.regions)
    result.push_back(
        {fmt::format("region{}_{}_{}", t.dim, triangulation_name(t.triangulation), alternative_name(t.alternative)),
         layout_name(Layout::flat), t.lists.size(), t.simplices.size() / (static_cast<std::size_t>(t.dim) + 1),
         bytes_of(t.lists, t.simplices, t.masks)});
  if (set.resolved)
    result.push_back({"tile3_resolved", layout_name(Layout::flat), 3 * set.resolved->entries.size(),
                      set.resolved->triangles.size() / 3,
                      bytes_of(set.resolved->first_entry, set.resolved->ambiguous, set.resolved->entries,
                               set.resolved->triangles, set.resolved->masks)});
  for (const VariantTables& t : set.variants) {
    TableSize size =
        size_of(fmt::format("tile{}_{}_variants", t.tile.dim, triangulation_name(t.tile.triangulation)), t.tile);
    size.bytes += bytes_of_rows(t.rows);
    result.push_back(std::move(size));
  }
  for (const NamedRows& t : set.rows)
    result.push_back({fmt::format("tile{}_{}{}_rows", set.dim, triangulation_name(t.of),
                                  t.name.find("Estimated") == std::string::npos ? "" : "_estimated"),
                      layout_name(Layout::flat), t.rows.entries.size(), 0, bytes_of_rows(t.rows)});
  return result;
}

/// The builder of a dimension, certified and emitted.
struct Builder {
  std::string certificate;
  std::vector<EmittedFile> texts;
};

Builder make_builder(int dim) {
  BuilderRequest request{.dim = dim};
  if (dim <= 3) request.languages = {Language::cpp, Language::glsl, Language::wgsl};
  BuilderTexts texts = emit_builder_texts(request);
  return {std::move(texts.certificate), std::move(texts.files)};
}

void print_builder(const Builder& builder) {
  fmt::print("\n{:<28} {:>33}\n", "text of the builder", "bytes");
  for (const EmittedFile& file : builder.texts) fmt::print("{:<28} {:>33}\n", file.name, file.text.size());
  fmt::print("Certified: {}.\n", builder.certificate);
}

std::string builder_json(const Builder& builder) {
  std::vector<std::string> texts;
  for (const EmittedFile& file : builder.texts)
    texts.push_back(fmt::format("{{\"name\": \"{}\", \"bytes\": {}}}", file.name, file.text.size()));
  return fmt::format("\"builder\": {{\"certified\": \"{}\", \"texts\": [\n  {}\n]}}", builder.certificate,
                     fmt::join(texts, ",\n  "));
}

void print_figures_of(const TableSet& set) {
  fmt::print("\n{:<11} {:<13} {:>9} {:>7} {:>13} {:>9} {:>7} {:>8} {:>9}\n", "alternative", "triangulation",
             "certified", "facets", "non-spherical", "simplices", "at most", "embedded", "pairs");
  bool non_spherical = false, pairs = false;
  for (const CertifiedFigures& f : set.figures) {
    fmt::print("{:<11} {:<13} {:>9} {:>7} {:>13} {:>9} {:>7} {:>8} {:>9}\n", alternative_name(f.alternative),
               triangulation_name(f.triangulation), f.signatures, f.facets, f.others, f.simplices, f.max_simplices,
               f.embedded, f.pairs.pairs == 0 ? "-" : std::to_string(f.pairs.pairs));
    non_spherical |= f.others != 0;
    pairs |= f.pairs.pairs != 0;
  }
  fmt::print("Every signature is certified{}.\n", pairs ? ", and every pair of neighbours matches" : "");
  if (!non_spherical) return;
  fmt::print("\n");
  for (const CertifiedFigures& f : set.figures)  // the same in both triangulations
    if (f.triangulation == set.figures.front().triangulation)
      fmt::print("{} classes with a non-spherical facet, {} alternative (genus up to {}):\n  {}\n",
                 f.classes_with_others.size(), alternative_name(f.alternative), f.highest_genus,
                 fmt::join(f.classes_with_others, " "));
}

void print_sizes(const TableSet& set) {
  std::size_t bytes = 0;
  fmt::print("\n{:<28} {:>6} {:>6} {:>9} {:>9}\n", "table", "layout", "lists", "simplices", "bytes");
  for (const TableSize& size : sizes(set)) {
    fmt::print("{:<28} {:>6} {:>6} {:>9} {:>9}\n", size.name, size.layout, size.lists, size.simplices, size.bytes);
    bytes += size.bytes;
  }
  fmt::print("{:<28} {:>33}\n", "all", bytes);
}

void print_json(const Options& options, const Tile& tile, const std::vector<GroupCount>& counts, const TableSet& set,
                const std::optional<Builder>& builder, double seconds) {
  std::vector<std::string> figures, tables;
  for (const CertifiedFigures& f : set.figures) figures.push_back(figures_json(f));
  for (const TableSize& size : sizes(set))
    tables.push_back(
        fmt::format("{{\"name\": \"{}\", \"layout\": \"{}\", \"lists\": {}, \"simplices\": {}, \"bytes\": {}}}",
                    size.name, size.layout, size.lists, size.simplices, size.bytes));
  fmt::print("{{{}, \"certified\": [\n  {}\n], \"tables\": [\n  {}\n]{}, \"seconds\": {:.2f}}}\n",
             group_counts_json(options, tile.corner_count(), counts), fmt::join(figures, ",\n  "),
             fmt::join(tables, ",\n  "), builder ? ", " + builder_json(*builder) : "", seconds);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A dimension without tables: its tiles are built one by one. Certifies the builder's faces and a sample of tiles.
int run_summary_without_tables(const Options& options) {
  constexpr std::uint64_t kSample = 200, kSeed = 1;
  const auto start = std::chrono::steady_clock::now();
  const unsigned corners = 1u << options.dim;
  const std::vector<GroupCount> counts = count_classes_by_burnside(options.dim);
  if (!options.json) print_group_counts(options, corners, counts);
  const Builder builder = make_builder(options.dim);
  const ResolutionFigures figures = certify_sample(TileKind::cube, options.dim, kSample, kSeed, 0);
  if (options.json) {
    fmt::print("{{{}, \"sample\": {}, \"seed\": {}, \"certified_tiles\": {}, {}, \"seconds\": {:.2f}}}\n",
               group_counts_json(options, corners, counts), kSample, kSeed, figures.tiles, builder_json(builder),
               seconds_since(start));
    return 0;
  }
  fmt::print(
      "\nThere are no tables; tiles are built one by one. {} with random signatures and choices in all faces\n"
      "(seed {}) are certified, with the contours in their faces.\n",
      figures.tiles, kSeed);
  print_builder(builder);
  fmt::print("\nMade and certified in {:.2f} s.\n", seconds_since(start));
  return 0;
}

}  // namespace

int run_summary(const Options& options) {
  if (options.dim > kMaxEnumeratedDim) return run_summary_without_tables(options);
  const auto start = std::chrono::steady_clock::now();
  const Lattice lattice(options.tile, options.dim);
  const Tile& tile = lattice.tile(options.dim);
  const std::vector<GroupCount> counts = count_classes(tile);
  if (!options.json) print_group_counts(options, tile.corner_count(), counts);
  TableRequest request;
  request.tile = options.tile;
  request.dim = options.dim;
  request.pairs = true;
  const TableSet set = make_table_set(request);
  std::optional<Builder> builder;
  if (options.tile == TileKind::cube) builder = make_builder(options.dim);
  if (options.json) {
    print_json(options, tile, counts, set, builder, seconds_since(start));
    return 0;
  }
  print_figures_of(set);
  print_sizes(set);
  if (builder) print_builder(*builder);
  fmt::print("\nMade and certified in {:.2f} s.\n", seconds_since(start));
  return 0;
}

}  // namespace tegl::gen
