// SPDX-License-Identifier: BSD-3-Clause
//
// Emits tables as JSON: the contract's arrays by name. The schema is in docs/tables.md.
#include "tables/emit.hpp"
#include "tables/emit_json_text.hpp"

namespace tegl::gen {

namespace {

/// The beginning of every file: an open object with the common members.
std::string opening(const TableSet& set, const char* kind, int dim) {
  std::string text;
  fmt::format_to(Appender(text),
                 "{{\n  \"generated_by\": \"{}\",\n  \"license\": \"BSD-3-Clause\",\n  \"kind\": \"{}\",\n"
                 "  \"contract_version\": {},\n  \"dim\": {},\n  \"group_order\": {},\n  \"orbits\": {},\n"
                 "  \"certified\": [",
                 command_for(set, Language::json), kind, tables::kContractVersion, dim, set.group_order, set.orbits);
  const char* separator = "\n";
  for (const CertifiedFigures& f : set.figures) {
    fmt::format_to(Appender(text),
                   "{}    {{\"alternative\": \"{}\", \"triangulation\": \"{}\", \"signatures\": {}, \"facets\": {}, "
                   "\"spherical\": {}, \"non_spherical\": {}, \"simplices\": {}, {}}}",
                   separator, alternative_name(f.alternative), triangulation_name(f.triangulation), f.signatures,
                   f.facets, f.spheres, f.others, f.simplices, evidence_json(f));
    separator = ",\n";
  }
  text += "\n  ]";
  return text;
}

/// Corners, edges and faces, so that a file documents its own numbering.
void shape(std::string& text, const TileTables& table) {
  std::vector<std::string> corners, edges, faces;
  for (const auto& x : table.corners)
    corners.push_back(fmt::format("[{}]", fmt::join(x.begin(), x.begin() + table.dim, ",")));
  for (const auto& ends : table.edges) edges.push_back(fmt::format("[{}]", fmt::join(ends, ",")));
  for (const auto& face : table.faces) faces.push_back(fmt::format("[{}]", fmt::join(face, ",")));
  fmt::format_to(Appender(text), ",\n  \"tile\": \"{}\",\n  \"corners\": [{}],\n  \"edges\": [{}],\n  \"faces\": [{}]",
                 tile_kind_name(table.tile), fmt::join(corners, ", "), fmt::join(edges, ", "), fmt::join(faces, ", "));
}

EmittedFile json_of_tile(const TableSet& set, const TileTables& table) {
  std::string text = opening(set, "tile", table.dim);
  shape(text, table);
  fmt::format_to(Appender(text),
                 ",\n  \"triangulation\": \"{}\",\n  \"alternative\": \"low\",\n  \"layout\": \"{}\",\n"
                 "  \"fnv1a\": \"{:016x}\",\n  \"edge_count\": {},\n  \"first_tile_vertex\": {},\n"
                 "  \"permutation_stride\": {},\n  \"max_simplices\": {},\n  \"max_tile_vertices\": {}",
                 triangulation_name(table.triangulation), layout_name(table.layout), digest(table), table.edges.size(),
                 table.first_tile_vertex, table.permutation_stride, table.max_simplices, table.max_tile_vertices);
  json_array(text, "list_of", table.list_of);
  json_array(text, "element_of", table.element_of);
  json_array(text, "slot_swaps", table.slot_swaps);
  json_array(text, "permutations", table.permutations);
  json_array(text, "reverses", table.reverses);
  json_rows(text, "lists", "\"first_simplex\", \"simplex_count\", \"cone_vertices\", \"side_vertices\", \"first_side\"",
            table.lists, [](const tables::List& l) {
              return std::array<std::uint32_t, 5>{l.first_simplex, l.simplex_count, l.cone_vertices, l.side_vertices,
                                                  l.first_side};
            });
  json_array(text, "simplices", table.simplices);
  json_array(text, "side_masks", table.side_masks);
  text += "\n}\n";
  return {fmt::format("{}_{}.json", tile_name(table.tile, table.dim), triangulation_name(table.triangulation)),
          std::move(text)};
}

EmittedFile region_file(const TableSet& set, const RegionTables& table) {
  std::string text = opening(set, "region", table.dim);
  fmt::format_to(Appender(text),
                 ",\n  \"triangulation\": \"{}\",\n  \"alternative\": \"{}\",\n  \"fnv1a\": \"{:016x}\",\n"
                 "  \"first_region_vertex\": {},\n  \"max_own_vertices\": {}",
                 triangulation_name(table.triangulation), alternative_name(table.alternative), digest(table),
                 tables::first_region_vertex(static_cast<std::uint32_t>(table.dim)), table.max_own_vertices);
  json_rows(text, "lists", "\"first_simplex\", \"simplex_count\", \"own_vertices\", \"first_mask\"", table.lists,
            [](const tables::RegionList& l) {
              return std::array<std::uint32_t, 4>{l.first_simplex, l.simplex_count, l.own_vertices, l.first_mask};
            });
  json_array(text, "simplices", table.simplices);
  json_array(text, "masks", table.masks);
  text += "\n}\n";
  return {fmt::format("region{}_{}_{}.json", table.dim, triangulation_name(table.triangulation),
                      alternative_name(table.alternative)),
          std::move(text)};
}

EmittedFile json_of_resolved(const TableSet& set, const ResolvedCube& table) {
  std::string text = opening(set, "resolved", 3);
  std::vector<std::string> squares;
  for (const auto& square : table.squares) squares.push_back(fmt::format("[{}]", fmt::join(square, ",")));
  fmt::format_to(Appender(text), ",\n  \"certified_entries\": {},\n  \"squares\": [{}],\n  \"fnv1a\": \"{:016x}\"",
                 table.entries.size(), fmt::join(squares, ", "), digest(table));
  json_array(text, "first_entry", table.first_entry);
  json_array(text, "ambiguous_squares", table.ambiguous);
  std::string columns = "\"components\"";
  for (const char* const centre : {"separate", "low", "high"})
    for (const char* const column : {"first_triangle", "triangle_count", "own_vertices", "first_mask"})
      columns += fmt::format(", \"{}_{}\"", centre, column);
  json_rows(text, "entries", columns.c_str(), table.entries, [](const tables::ResolvedEntry& e) {
    std::vector<std::uint32_t> row = {e.components};
    for (const tables::ResolvedList& l : {e.separate, e.low, e.high})
      row.insert(row.end(), {l.first_triangle, l.triangle_count, l.own_vertices, l.first_mask});
    return row;
  });
  json_array(text, "triangles", table.triangles);
  json_array(text, "masks", table.masks);
  text += "\n}\n";
  return {"tile3_resolved.json", std::move(text)};
}

}  // namespace

std::vector<EmittedFile> emit_json(const TableSet& set) {
  std::vector<EmittedFile> files;
  for (const TileTables& table : set.tiles) files.push_back(json_of_tile(set, table));
  for (const RegionTables& table : set.regions) files.push_back(region_file(set, table));
  if (set.resolved) files.push_back(json_of_resolved(set, *set.resolved));
  return files;
}

}  // namespace tegl::gen
