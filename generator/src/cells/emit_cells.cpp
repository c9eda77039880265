// SPDX-License-Identifier: BSD-3-Clause
//
// Emits the tables of mesh cells and their manifest.
#include <array>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/fnv.hpp"
#include "cells/cell_tables.hpp"
#include "cells/face_fillings.hpp"
#include "cells/region_tables.hpp"
#include "cells/shape_tables.hpp"
#include "filling/position_search.hpp"
#include "tables/emit_arrays.hpp"
#include "tables/emit_json_text.hpp"
#include "tables/emit_text.hpp"

namespace tegl::gen {

namespace {

std::string table_name(const CellTables& table) {
  return upper_camel(table.name) + upper_camel(triangulation_name(table.triangulation));
}

std::string array_name(const CellTables& table, const char* what) {
  return fmt::format("k{}{}", table_name(table), what);
}

std::string certificate(const CellTables& table) {
  return fmt::format(
      "{} of {} signatures certified{}, {} classes under {} symmetries, {} simplices; embedded: {} proved, {} searched",
      table.certified, table.list_of.size(), table.element_of.empty() ? "" : " (one of each class)", table.classes,
      table.group_order, table.total_simplices, table.proved, table.list_of.size() - table.proved);
}

/// The classes that were searched, and the positions; "" if all are proved.
std::string search_text(const CellTables& table) {
  if (table.searched.empty()) return "";
  const SearchPlan plan;
  std::string text = fmt::format(
      ", \"search\": {{\"seed\": {}, \"middle\": 1, \"uniform\": {}, \"near_ends\": {}, \"descents\": {}, \"steps\": "
      "{}, \"intersections\": 0, \"classes\": [",
      plan.seed, plan.uniform, plan.near_ends, plan.descents, plan.steps);
  const char* separator = "";
  for (const CellTables::Searched& s : table.searched) {
    fmt::format_to(Appender(text), "{}{{\"signature\": {}, \"entries\": {}, \"unproved_pairs\": {}", separator,
                   s.signature, s.entries, s.pairs);
    if (s.random != plan.uniform)
      fmt::format_to(Appender(text), ", \"uniform\": {}, \"near_ends\": {}", s.random, s.random);
    text += '}';
    separator = ", ";
  }
  return text + "]}";
}

std::uint64_t digest(const CellTables& table) {
  Fnv hash;
  hash.add(table.list_of);
  hash.add(table.element_of);
  hash.add(table.permutations);
  hash.add(table.reverses);
  for (const tables::CellList& list : table.lists) {
    hash.add(list.first_simplex);
    hash.add(list.first_mask);
    hash.add(list.simplex_count);
    hash.add(list.shared_vertices);
    hash.add(list.cone_vertices);
    hash.add(list.side_vertices);
  }
  hash.add(table.simplices);
  hash.add(table.masks);
  return hash.value();
}

void add_arrays(std::string& text, const CellTables& table) {
  fmt::format_to(Appender(text), "\n// {}, {}: {}.\n", table.name, triangulation_name(table.triangulation),
                 certificate(table));
  std::vector<int> corners;
  for (const auto& corner : table.tile.corners)
    for (int i = 0; i < table.tile.dim; ++i) corners.push_back(static_cast<int>(corner[static_cast<std::size_t>(i)]));
  std::vector<std::uint8_t> edges;
  for (const auto& [a, b] : table.tile.edges) edges.push_back(a), edges.push_back(b);
  const auto name = [&](const char* what) { return array_name(table, what); };
  write_array(text, "std::int8_t", name("Corners").c_str(), "corner x dim", corners);
  write_array(text, "std::uint8_t", name("Edges").c_str(), "edge x 2", edges);
  write_array(text, "std::uint16_t", name("ListOf").c_str(), "signature -> list", table.list_of);
  write_array(text, "std::uint16_t", name("ElementOf").c_str(), "signature -> symmetry", table.element_of);
  write_array(text, "std::uint8_t", name("Permutations").c_str(), "symmetry x (corners, edges)", table.permutations);
  write_array(text, "std::uint8_t", name("Reverses").c_str(), "symmetry -> reverses", table.reverses);
  write_records(text, "CellList", name("Lists").c_str(), "simplices, masks, counts", table.lists,
                [](const tables::CellList& l) {
                  return fmt::format("{{{},{},{},{},{},{},0}}", l.first_simplex, l.first_mask, l.simplex_count,
                                     l.shared_vertices, l.cone_vertices, l.side_vertices);
                });
  write_bytes(text, name("Simplices").c_str(), "local vertices, octal", table.simplices,
              static_cast<std::size_t>(table.tile.dim) * 8);
  write_array(text, "std::uint64_t", name("Masks").c_str(), "corners and edges", table.masks);
}

std::string initialiser(const CellTables& table) {
  const auto name = [&](const char* what, bool present) {
    return present ? array_name(table, what) : std::string("nullptr");
  };
  const bool by_class = !table.element_of.empty();
  return fmt::format(
      "{{{}u, {}u, {}u, {}u, {}u, {}u, {}u, {}, {},\n     {}, {}, {}, {},\n     {},\n     reinterpret_cast<const "
      "std::uint8_t*>({}), {}}}",
      tables::kCellContractVersion, table.tile.dim, table.tile.corner_count(), table.tile.edge_count(),
      table.max_simplices, table.max_added, by_class ? table.tile.corner_count() + table.tile.edge_count() : 0,
      name("Corners", true), name("Edges", true), name("ListOf", true), name("ElementOf", by_class),
      name("Permutations", by_class), name("Reverses", by_class), name("Lists", true), name("Simplices", true),
      name("Masks", !table.masks.empty()));
}

/// The beginning of a C++ file and the arrays of its tables.
std::string opening(const std::vector<CellTables>& tables, const std::string& command, const char* header) {
  std::string text = fmt::format(
      "// @generated by {} -- DO NOT EDIT\n// SPDX-License-Identifier: BSD-3-Clause\n"
      "// Contours of mesh cells, low-connected alternative. Certified: closed up to Sigma, manifold, oriented, and "
      "in\n"
      "// each face the contour of that face alone. Proved: no two simplices of a cell intersect, wherever its points "
      "are\n"
      "// on their edges, if the cell is an affine image of the reference cell; searched: no intersection was found.\n"
      "#include \"{}\"\n\nnamespace tegl::tables {{\n\n"
      "static_assert(kCellContractVersion == {}u, \"tables of another contract version\");\n\nnamespace {{\n",
      command, header, tables::kCellContractVersion);
  for (const CellTables& table : tables) add_arrays(text, table);
  return text;
}

EmittedFile source(const std::vector<CellTables>& tables, const std::vector<FaceFillings>& fillings,
                   const std::vector<ShapeTables>& shapes, const std::vector<CapTables>& regions) {
  std::string text = opening(tables, "gen --cells", "tegl/generated/cells.hpp");
  text += face_filling_arrays(fillings);
  text += shape_arrays(shapes);
  text += region_arrays(regions);
  text += "\n// by shape: barycentric, compact (4D: barycentric)\n";
  fmt::format_to(Appender(text), "const CellTable kTables[{}][2] = {{\n", tables::kCellShapes);
  for (std::size_t i = 0; i < tables.size(); ++i) {
    const bool two = tables[i].tile.dim < 4;
    fmt::format_to(Appender(text), "    {{{},\n     {}}},\n", initialiser(tables[i]),
                   initialiser(tables[two ? i + 1 : i]));
    if (two) ++i;
  }
  text +=
      "};\n\n}  // namespace\n\nconst CellTable& cell_table(CellShape shape, Triangulation triangulation) noexcept {\n"
      "  return kTables[static_cast<unsigned>(shape)][static_cast<unsigned>(triangulation)];\n}\n\n";
  text += face_filling_function(fillings) + "\n" + shape_function(shapes) + "\n" + region_function(regions) +
          "\n}  // namespace tegl::tables\n";
  return {"cells.cpp", std::move(text)};
}

/// The tables of one cell as variables, which a header declares as `extern`.
EmittedFile source_of_cell(const std::vector<CellTables>& tables, const std::string& command) {
  std::string text = opening(tables, command, "tegl/cell_contract.hpp");
  text += "\n}  // namespace\n";
  for (const CellTables& table : tables)
    fmt::format_to(Appender(text), "\nextern const CellTable k{0};\nconst CellTable k{0} =\n    {1};\n",
                   table_name(table), initialiser(table));
  text += "\n}  // namespace tegl::tables\n";
  return {fmt::format("cell_{}.cpp", tables.front().name), std::move(text)};
}

EmittedFile json_of_cell(const CellTables& table, const std::string& command) {
  std::vector<std::string> corners, edges, faces;
  for (const auto& x : table.tile.corners)
    corners.push_back(fmt::format("[{}]", fmt::join(x.begin(), x.begin() + table.tile.dim, ",")));
  for (const auto& ends : table.tile.edges) edges.push_back(fmt::format("[{}]", fmt::join(ends, ",")));
  for (const SubTile& face : table.tile.faces) faces.push_back(fmt::format("[{}]", fmt::join(face.corner, ",")));
  std::string text = fmt::format(
      "{{\n  \"generated_by\": \"{}\",\n  \"license\": \"BSD-3-Clause\",\n  \"kind\": \"cell\",\n"
      "  \"cell\": \"{}\",\n  \"triangulation\": \"{}\",\n  \"alternative\": \"low\",\n"
      "  \"contract_version\": {},\n  \"dim\": {},\n  \"group_order\": {},\n  \"orbits\": {},\n"
      "  \"certified\": {},\n  \"signatures_with_non_spherical\": {},\n  \"embedded_proved\": {},\n"
      "  \"corners\": [{}],\n  \"edges\": [{}],\n  \"faces\": [{}],\n  \"max_simplices\": {},\n"
      "  \"max_added_vertices\": {},\n  \"fnv1a\": \"{:016x}\"",
      command, table.name, triangulation_name(table.triangulation), tables::kCellContractVersion, table.tile.dim,
      table.group_order, table.classes, table.certified, table.others, table.proved, fmt::join(corners, ", "),
      fmt::join(edges, ", "), fmt::join(faces, ", "), table.max_simplices, table.max_added, digest(table));
  json_array(text, "list_of", table.list_of);
  json_array(text, "element_of", table.element_of);
  json_array(text, "permutations", table.permutations);
  json_array(text, "reverses", table.reverses);
  json_rows(text, "lists",
            "\"first_simplex\", \"first_mask\", \"simplex_count\", \"shared_vertices\", \"cone_vertices\", "
            "\"side_vertices\"",
            table.lists, [](const tables::CellList& l) {
              return std::array<std::uint32_t, 6>{l.first_simplex,   l.first_mask,    l.simplex_count,
                                                  l.shared_vertices, l.cone_vertices, l.side_vertices};
            });
  json_array(text, "simplices", table.simplices);
  json_array(text, "masks", table.masks);
  text += "\n}\n";
  return {fmt::format("cell_{}_{}.json", table.name, triangulation_name(table.triangulation)), std::move(text)};
}

std::string manifest(const std::vector<CellTables>& tables, std::size_t cells, const std::string& command,
                     const std::vector<FaceFillings>& fillings = {}, const std::vector<ShapeTables>& shapes = {},
                     const std::vector<CapTables>& regions = {}) {
  std::string text = fmt::format("{{\n  \"cells\": {},\n  \"contract_version\": {},\n  \"command\": \"{}\",\n", cells,
                                 tables::kCellContractVersion, command);
  text += "  \"tables\": [";
  const char* separator = "\n";
  for (const CellTables& t : tables) {
    fmt::format_to(
        Appender(text),
        "{}    {{\"cell\": \"{}\", \"triangulation\": \"{}\", \"signatures\": {}, \"group_order\": {}, "
        "\"orbits\": {}, \"certified\": {}, \"signatures_with_non_spherical\": {}, \"simplices\": {}, "
        "\"max_simplices\": {}, \"max_added_vertices\": {}, \"embedded_proved\": {}, \"embedded_searched\": {}{}, "
        "\"fnv1a\": \"{:016x}\"}}",
        separator, t.name, triangulation_name(t.triangulation), t.list_of.size(), t.group_order, t.classes, t.certified,
        t.others, t.total_simplices, t.max_simplices, t.max_added, t.proved, t.list_of.size() - t.proved,
        search_text(t), digest(t));
    separator = ",\n";
  }
  text += "\n  ]";
  if (!fillings.empty()) text += ",\n  \"face_fillings\": [\n" + face_filling_manifest(fillings) + "\n  ]";
  if (!shapes.empty()) text += ",\n  \"shapes\": [\n" + shape_manifest(shapes) + "\n  ]";
  if (!regions.empty()) text += ",\n  \"regions\": [\n" + region_manifest(regions) + "\n  ]";
  return text + "\n}\n";
}

}  // namespace

std::vector<EmittedFile> emit_cells(const std::vector<CellTables>& tables) {
  const std::vector<FaceFillings> fillings = make_all_face_fillings(tables);
  const std::vector<ShapeTables> shapes = make_all_shape_tables();
  const std::vector<CapTables> regions = make_all_region_tables(shapes, fillings);
  return {source(tables, fillings, shapes, regions),
          {"cells_manifest.json", manifest(tables, tables::kCellShapes, "gen --cells", fillings, shapes, regions)}};
}

std::vector<EmittedFile> emit_cell(const std::vector<CellTables>& tables, std::span<const Language> languages,
                                   const std::string& command) {
  std::vector<EmittedFile> files;
  for (const Language language : languages) {
    if (language == Language::cpp) {
      files.push_back(source_of_cell(tables, command));
      files.push_back({fmt::format("cell_{}_manifest.json", tables.front().name), manifest(tables, 1, command)});
    } else if (language == Language::json) {
      for (const CellTables& table : tables) files.push_back(json_of_cell(table, command));
    }
  }
  return files;
}

}  // namespace tegl::gen
