// SPDX-License-Identifier: BSD-3-Clause
//
// Emits the C++ tables and the manifest.
#include "cubes/cube_certificate.hpp"
#include "tables/emit.hpp"
#include "tables/emit_arrays.hpp"
#include "tables/emit_rows.hpp"

namespace tegl::gen {

namespace {

void lists(std::string& text, const std::vector<tables::List>& values) {
  fmt::format_to(Appender(text),
                 "\n// first simplex, simplices, cone vertices, side vertices, first side mask\n"
                 "const List kLists[{}] = {{\n",
                 values.size());
  std::size_t column = 0;
  for (const tables::List& l : values) {
    fmt::format_to(Appender(text), "{}{{{},{},{},{},{}}},", column == 0 ? "    " : "", l.first_simplex, l.simplex_count,
                   l.cone_vertices, l.side_vertices, l.first_side);
    if (++column == 6) text += '\n', column = 0;
  }
  text += "};\n";
}

constexpr const char* kBalancedRows = "kTile4EstimatedCompactRows";

/// `variant`: the triangulation, or "balanced".
std::string variable_name(const TileTables& table, const std::string& variant) {
  return fmt::format("k{}{}", upper_camel(tile_name(table.tile, table.dim)), upper_camel(variant.c_str()));
}
std::string variable_name(const TileTables& table) {
  return variable_name(table, triangulation_name(table.triangulation));
}

EmittedFile tile_file(const TableSet& set, const TileTables& table, const std::string& variant,
                      const std::string& contents, const std::vector<NamedRows>& row_tables) {
  const auto name = variable_name(table, variant);
  std::string text = opening(set, contents);
  write_array(text, "std::uint16_t", "kListOf", "signature -> list", table.list_of);
  write_array(text, "std::uint16_t", "kElementOf", "signature -> group element", table.element_of);
  write_array(text, "std::uint8_t", "kSlotSwaps", "signature -> cubes whose barycentre slots change places",
              table.slot_swaps);
  write_array(text, "std::uint8_t", "kPermutations", "group element x (corners, edges, cube slots)",
              table.permutations);
  write_array(text, "std::uint8_t", "kReverses", "group element -> does it reverse the orientation", table.reverses);
  lists(text, table.lists);
  write_bytes(text, "kSimplices", fmt::format("#simplices x {} local vertices, octal", table.dim),
              readable_by_registers(table.simplices), static_cast<std::size_t>(table.dim) * 8);
  write_array(text, "std::uint64_t", "kSideMasks", "side vertex -> corners and edges", table.side_masks);
  std::string rows;
  for (const NamedRows& named : row_tables) {
    if (named.of != table.triangulation) continue;
    row_arrays(text, named.rows, named.name.substr(1));
    fmt::format_to(Appender(rows), "\nconst RowTable {} = {};\n", named.name,
                   row_initialiser(named.rows, named.name.substr(1), "&" + name,
                                   "reinterpret_cast<const std::uint8_t*>(kSimplices)"));
  }
  const auto or_null = [](const auto& values, const char* n) { return values.empty() ? "nullptr" : n; };
  fmt::format_to(Appender(text),
                 "\n}}  // namespace\n\n{}const TileTable {} = {{\n    {}u, {}u, {}u, {}u, {}u, {}u, {}u, {}u,\n    "
                 "kListOf, {}, {}, "
                 "{}, {}, kLists,\n    reinterpret_cast<const std::uint8_t*>(kSimplices), {}}};\n{}\n}}  // namespace "
                 "tegl::tables\n",
                 set.tile == TileKind::cube ? "" : fmt::format("extern const TileTable {};\n", name), name,
                 tables::kContractVersion, table.dim, table.lists.size(),
                 table.simplices.size() / static_cast<std::size_t>(table.dim), table.reverses.size(),
                 table.permutation_stride, table.max_simplices, table.max_tile_vertices,
                 or_null(table.element_of, "kElementOf"), or_null(table.slot_swaps, "kSlotSwaps"),
                 or_null(table.permutations, "kPermutations"), or_null(table.reverses, "kReverses"),
                 or_null(table.side_masks, "kSideMasks"), rows);
  return {fmt::format("{}_{}.cpp", tile_name(table.tile, table.dim), variant), std::move(text)};
}

void region_table(std::string& text, const RegionTables& table) {
  const auto suffix =
      upper_camel(triangulation_name(table.triangulation)) + upper_camel(alternative_name(table.alternative));
  fmt::format_to(Appender(text),
                 "\n// first simplex, simplices, own vertices, first mask\nconst RegionList kLists{}[{}] = {{", suffix,
                 table.lists.size());
  for (std::size_t i = 0; i < table.lists.size(); ++i) {
    const tables::RegionList& l = table.lists[i];
    fmt::format_to(Appender(text), "{}{{{},{},{},{}}},", i % 8 == 0 ? "\n    " : "", l.first_simplex, l.simplex_count,
                   l.own_vertices, l.first_mask);
  }
  text += "};\n";
  write_bytes(text, fmt::format("kSimplices{}", suffix).c_str(), fmt::format("#simplices x {}, octal", table.dim + 1),
              table.simplices, (static_cast<std::size_t>(table.dim) + 1) * 8);
  write_array(text, "std::uint32_t", fmt::format("kMasks{}", suffix).c_str(), "own vertex -> corners and edges",
              table.masks);
}

EmittedFile region_file(const TableSet& set) {
  std::string text = opening(set, fmt::format("High regions of the {}-tile: what closes a contour of a {}-dimensional "
                                              "image at its border.",
                                              set.dim - 1, set.dim));
  for (const RegionTables& table : set.regions) region_table(text, table);
  text += "\n}  // namespace\n";
  for (const RegionTables& table : set.regions) {
    const auto suffix =
        upper_camel(triangulation_name(table.triangulation)) + upper_camel(alternative_name(table.alternative));
    fmt::format_to(Appender(text),
                   "\nconst RegionTable kRegion{}{} = {{{}u, {}u, {}u, kLists{}, reinterpret_cast<const "
                   "std::uint8_t*>(kSimplices{}), {}}};\n",
                   table.dim, suffix, tables::kContractVersion, table.dim, table.max_own_vertices, suffix, suffix,
                   table.masks.empty() ? std::string("nullptr") : "kMasks" + suffix);
  }
  text += "\n}  // namespace tegl::tables\n";
  return {fmt::format("region{}.cpp", set.dim - 1), std::move(text)};
}

EmittedFile resolved_file(const TableSet& set, const ResolvedCube& table) {
  std::string text =
      opening(set, "The cube with every ambiguity resolved freely. " + resolved_certificate(table) + ".");
  write_array(text, "std::uint16_t", "kFirstEntry", "signature -> entry of resolution 0", table.first_entry);
  write_array(text, "std::uint8_t", "kAmbiguousSquares", "signature -> set of squares", table.ambiguous);
  fmt::format_to(Appender(text),
                 "\n// separate, low, high: first triangle, triangles, own vertices, first mask; polygons\n"
                 "const ResolvedEntry kEntries[{}] = {{",
                 table.entries.size());
  const auto list = [](const tables::ResolvedList& l) {
    return fmt::format("{{{},{},{},{}}}", l.first_triangle, l.triangle_count, l.own_vertices, l.first_mask);
  };
  for (std::size_t i = 0; i < table.entries.size(); ++i) {
    const tables::ResolvedEntry& e = table.entries[i];
    fmt::format_to(Appender(text), "{}{{{},{},{},{}}},", i % 4 == 0 ? "\n    " : "", list(e.separate), list(e.low),
                   list(e.high), e.components);
  }
  text += "};\n";
  write_bytes(text, "kTriangles", "#triangles x 3 local vertices, octal", table.triangles, 36);
  write_array(text, "std::uint32_t", "kMasks", "own vertex -> corners and edges", table.masks);
  fmt::format_to(Appender(text),
                 "\n}}  // namespace\n\nconst ResolvedTable kTile3Resolved = {{\n    {}u, {}u, kFirstEntry, "
                 "kAmbiguousSquares, kEntries,\n    reinterpret_cast<const std::uint8_t*>(kTriangles), kMasks}};\n\n"
                 "}}  // namespace tegl::tables\n",
                 tables::kContractVersion, table.entries.size());
  return {"tile3_resolved.cpp", std::move(text)};
}

}  // namespace

std::vector<EmittedFile> emit_cpp(const TableSet& set) {
  std::vector<EmittedFile> files;
  for (const TileTables& table : set.tiles) {
    const char* const triangulation = triangulation_name(table.triangulation);
    files.push_back(
        tile_file(set, table, triangulation,
                  fmt::format("Contours of the {}-tile, low-connected alternative, {} triangulation, {} layout.",
                              table.dim, triangulation, layout_name(table.layout)),
                  set.rows));
  }
  if (set.balanced)
    files.push_back(tile_file(set, *set.balanced, "balanced",
                              "Compact contours of the 4-tiles that do not depend on the data, with balanced fillings. "
                              "All are proved to be embedded for all positions.",
                              {{Triangulation::compact, kBalancedRows, set.balanced_rows}}));
  if (!set.regions.empty()) files.push_back(region_file(set));
  if (set.resolved) files.push_back(resolved_file(set, *set.resolved));
  if (set.tile == TileKind::cube) files.push_back(emit_variants(set));
  return files;
}

EmittedFile emit_manifest(const TableSet& set) {
  std::string text;
  fmt::format_to(Appender(text),
                 "{{\n  \"dim\": {},\n  \"contract_version\": {},\n  \"command\": \"{}\",\n  \"group_order\": {},\n"
                 "  \"orbits\": {},\n  \"certified\": [",
                 set.dim, tables::kContractVersion, set.command, set.group_order, set.orbits);
  const char* separator = "\n";
  for (const CertifiedFigures& f : set.figures) {
    fmt::format_to(
        Appender(text),
        "{}    {{\"alternative\": \"{}\", \"triangulation\": \"{}\", \"signatures\": {}, \"facets\": {}, "
        "\"spherical\": {}, \"non_spherical\": {}, \"signatures_with_non_spherical\": {}, \"simplices\": {}, "
        "\"max_simplices\": {}, \"mean_simplices\": {:.4f}, {}}}",
        separator, alternative_name(f.alternative), triangulation_name(f.triangulation), f.signatures, f.facets,
        f.spheres, f.others, f.signatures_with_others, f.simplices, f.max_simplices,
        static_cast<double>(f.simplices) / static_cast<double>(f.signatures), evidence_json(f));
    separator = ",\n";
  }
  text += "\n  ],\n  \"tables\": [";
  separator = "\n";
  const auto add_table = [&](const TileTables& t, const std::string& name) {
    fmt::format_to(Appender(text),
                   "{}    {{\"name\": \"{}\", \"layout\": \"{}\", \"lists\": {}, \"stored_simplices\": {}, "
                   "\"max_tile_vertices\": {}, \"fnv1a\": \"{:016x}\"}}",
                   separator, name, layout_name(t.layout), t.lists.size(),
                   t.simplices.size() / static_cast<std::size_t>(t.dim), t.max_tile_vertices, digest(t));
    separator = ",\n";
  };
  for (const TileTables& t : set.tiles) add_table(t, variable_name(t));
  if (set.balanced) add_table(*set.balanced, variable_name(*set.balanced, "balanced"));
  for (const RegionTables& t : set.regions)
    fmt::format_to(Appender(text),
                   "{}    {{\"name\": \"kRegion{}{}{}\", \"stored_simplices\": {}, \"fnv1a\": \"{:016x}\"}}", separator,
                   t.dim, upper_camel(triangulation_name(t.triangulation)),
                   upper_camel(alternative_name(t.alternative)),
                   t.simplices.size() / (static_cast<std::size_t>(t.dim) + 1), digest(t));
  if (set.resolved)
    fmt::format_to(Appender(text),
                   "{}    {{\"name\": \"kTile3Resolved\", \"entries\": {}, \"embedded_proved\": {}, "
                   "\"stored_simplices\": {}, \"fnv1a\": \"{:016x}\"}}",
                   separator, set.resolved->entries.size(), certify_embedding(*set.resolved),
                   set.resolved->triangles.size() / 3, digest(*set.resolved));
  const auto add_rows = [&](const std::string& name, const RowTables& rows) {
    fmt::format_to(Appender(text), "{}    {{\"name\": \"{}\", \"entries\": {}, \"fnv1a\": \"{:016x}\"}}", separator,
                   name, rows.entries.size(), digest(rows));
  };
  for (const NamedRows& rows : set.rows) add_rows(rows.name, rows.rows);
  if (set.balanced) add_rows(kBalancedRows, set.balanced_rows);
  for (const VariantTables& t : set.variants)
    fmt::format_to(Appender(text),
                   "{}    {{\"name\": \"{}Variants\", \"lists\": {}, {}\"stored_simplices\": {}, \"fnv1a\": "
                   "\"{:016x}\", \"rows_fnv1a\": \"{:016x}\"}}",
                   separator, variable_name(t.tile), t.tile.lists.size(),
                   t.embedded == 0 ? "" : fmt::format("\"embedded_proved\": {}, ", t.embedded),
                   t.tile.simplices.size() / static_cast<std::size_t>(set.dim), digest(t.tile), digest(t.rows));
  text += "\n  ]\n}\n";
  return {set.tile == TileKind::cube ? fmt::format("manifest{}.json", set.dim)
                                     : fmt::format("manifest_{}.json", tile_name(set.tile, set.dim)),
          std::move(text)};
}

}  // namespace tegl::gen
