// SPDX-License-Identifier: BSD-3-Clause
//
// Emits row tables, tables of resolved squares and cubes, and sets of ambiguous tiles (C++ only).
#include "tables/emit_rows.hpp"

#include "tables/emit_arrays.hpp"

namespace tegl::gen {

namespace {

std::string pointer(bool is_empty, const std::string& name) { return is_empty ? "nullptr" : name; }

/// Squares or cubes with resolved ambiguities.
void variants(std::string& text, const VariantTables& table, std::string& definitions) {
  const TileTables& tile = table.tile;
  const std::string suffix = upper_camel(triangulation_name(tile.triangulation)) + "Variants";
  write_array(text, "std::uint16_t", ("kListOf" + suffix).c_str(), "key -> list", tile.list_of);
  write_records(text, "List", ("kLists" + suffix).c_str(),
                "first simplex, simplices, cone vertices, side vertices, first side mask", tile.lists,
                [](const tables::List& l) {
                  return fmt::format("{{{},{},{},{},{}}}", l.first_simplex, l.simplex_count, l.cone_vertices,
                                     l.side_vertices, l.first_side);
                });
  write_array(text, "std::uint8_t", ("kSimplices" + suffix).c_str(), "local vertices",
              readable_by_registers(tile.simplices));
  write_array(text, "std::uint64_t", ("kSideMasks" + suffix).c_str(), "side vertex -> corners and edges",
              tile.side_masks);
  row_arrays(text, table.rows, suffix);
  const std::string name =
      fmt::format("kTile{}{}Variants", tile.dim, upper_camel(triangulation_name(tile.triangulation)));
  fmt::format_to(
      Appender(definitions),
      "\nconst VariantTable {} = {{\n    {{{}u, {}u, {}u, {}u, 0u, 0u, {}u, {}u, kListOf{}, nullptr, nullptr, "
      "nullptr, nullptr, kLists{}, kSimplices{}, {}}},\n    {}}};\n",
      name, tables::kContractVersion, tile.dim, tile.lists.size(),
      tile.simplices.size() / static_cast<std::size_t>(tile.dim), tile.max_simplices, tile.max_tile_vertices, suffix,
      suffix, suffix, pointer(tile.side_masks.empty(), "kSideMasks" + suffix),
      row_initialiser(table.rows, suffix, "&" + name + ".tile", "kSimplices" + suffix));
}

/// The set of ambiguous tiles.
std::string ambiguous_definition(int dim, const std::vector<bool>& ambiguous) {
  if (dim == 4) {
    std::vector<std::uint64_t> words(ambiguous.size() / 64);
    for (std::size_t s = 0; s < ambiguous.size(); ++s) words[s / 64] |= std::uint64_t{ambiguous[s]} << (s % 64);
    std::string text = "\nconst SignatureSet4 kAmbiguous4 = {{";
    for (std::size_t i = 0; i < words.size(); ++i)
      text += fmt::format("{}{:#x},", i % 6 == 0 ? "\n    " : "", words[i]);
    return text + "}};\n";
  }
  std::string text = fmt::format("\nconst std::array<bool, {}> kAmbiguous{} = {{{{", ambiguous.size(), dim);
  for (std::size_t s = 0; s < ambiguous.size(); ++s)
    text += fmt::format("{}{},", s % 50 == 0 ? "\n    " : "", ambiguous[s] ? 1 : 0);
  return text + "}};\n";
}

std::string joins_definition(const std::vector<tables::CubeJoin>& joins) {
  std::string text = fmt::format(
      "\n// corners, pairs, high, high pair, low pair\nconst std::array<CubeJoin, {}> kCubeJoins = {{{{", joins.size());
  for (std::size_t i = 0; i < joins.size(); ++i)
    text += fmt::format("{}{{{{{{{}}}}},{},{},{},{}}},", i % 4 == 0 ? "\n    " : "", fmt::join(joins[i].corners, ","),
                        joins[i].pairs, joins[i].high, joins[i].high_pair, joins[i].low_pair);
  return text + "}};\n";
}

}  // namespace

void row_arrays(std::string& text, const RowTables& rows, const std::string& suffix) {
  write_array(text, "std::uint32_t", ("kEntries" + suffix).c_str(), "entries: simplices, flag, first simplex",
              rows.entries);
  write_array(text, "std::uint8_t", ("kCounts" + suffix).c_str(), "signature -> simplices", rows.counts);
  write_array(text, "std::uint8_t", ("kShuffles" + suffix).c_str(), "2 orientations x 32 keys x 16 bytes",
              rows.shuffles);
  write_array(text, "std::uint16_t", ("kPlaces" + suffix).c_str(), "signature -> first entry of its variants",
              rows.variant_places);
  if (rows.variants.empty()) return;
  write_records(text, "Variant", ("kVariants" + suffix).c_str(),
                "resolved entry x choice: key, more simplices, own vertices", rows.variants,
                [](const tables::Variant& v) {
                  return fmt::format("{{{},{},{}}}", v.key, v.more_simplices, v.more_own_vertices);
                });
}

std::string row_initialiser(const RowTables& rows, const std::string& suffix, const std::string& table,
                            const std::string& simplices) {
  return fmt::format("{{{}, kEntries{}, {}, {}, {}, {}, {}, {}}}", table, suffix, simplices,
                     pointer(rows.counts.empty(), "kCounts" + suffix),
                     pointer(rows.shuffles.empty(), "kShuffles" + suffix),
                     pointer(rows.variant_places.empty(), "kPlaces" + suffix),
                     pointer(rows.variants.empty(), "kVariants" + suffix), rows.more_keys);
}

EmittedFile emit_variants(const TableSet& set) {
  std::string what = fmt::format("The {}-tile with resolved ambiguities.", set.dim);
  for (const VariantTables& table : set.variants)
    if (table.embedded != 0)
      what += fmt::format(" {}: {} lists proved to be embedded for all positions.",
                          triangulation_name(table.tile.triangulation), table.embedded);
  if (set.variants.empty()) what += " Sets of signatures and faces, no simplices.";
  std::string text = opening(set, what);
  std::string definitions;
  for (const VariantTables& table : set.variants) variants(text, table, definitions);
  text += "\n}  // namespace\n" + definitions;
  if (!set.ambiguous.empty()) text += ambiguous_definition(set.dim, set.ambiguous);
  if (!set.joins.empty()) text += joins_definition(set.joins);
  text += "\n}  // namespace tegl::tables\n";
  return {fmt::format("tile{}_variants.cpp", set.dim), std::move(text)};
}

}  // namespace tegl::gen
