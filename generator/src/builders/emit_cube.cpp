// SPDX-License-Identifier: BSD-3-Clause
//
// Emits the builder of the cube: by table, or by recursion over its squares down to the edges.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/lattice.hpp"
#include "base/tile_contour.hpp"
#include "builders/cube_rule.hpp"
#include "builders/emit_builder.hpp"
#include "builders/templates.hpp"
#include "cubes/cube_certificate.hpp"
#include "cubes/resolved_cube.hpp"

namespace tegl::gen {

namespace {

constexpr std::size_t kLineLength = 110;  ///< less than 120 by the longest indentation
constexpr const char* kAxisNames = "xyz";

/// Joins items with commas to lines.
std::string in_lines(const std::vector<std::string>& items) {
  std::string text;
  std::size_t line = 0;
  for (const std::string& item : items) {
    if (text.size() > line && text.size() - line + item.size() + 2 > kLineLength) {
      text += '\n';
      line = text.size();
    }
    text += (text.size() == line ? "" : " ") + item + ",";
  }
  return text + "\n";
}

template <class Number>
std::vector<std::string> as_items(const std::vector<Number>& numbers) {
  std::vector<std::string> items;
  for (const Number number : numbers) items.push_back(fmt::format("{}", number));
  return items;
}

/// Triangles and masks of a builder, as one array each.
struct Arrays {
  std::vector<CubeTriangle> triangles;
  std::vector<std::uint32_t> masks;

  /// Appends a filling whose own vertices are numbered from `own_vertices` on.
  void add(const CubeFilling& filling, std::size_t own_vertices) {
    for (CubeTriangle t : filling.triangles) {
      for (std::uint8_t& v : t) v = static_cast<std::uint8_t>(v < 12 ? v : v + own_vertices);
      triangles.push_back(t);
    }
    masks.insert(masks.end(), filling.masks.begin(), filling.masks.end());
  }
  [[nodiscard]] std::string triangle_rows() const {
    std::vector<std::string> items;
    for (const CubeTriangle& t : triangles) items.push_back(fmt::format("{{{}}}", fmt::join(t, ", ")));
    return in_lines(items);
  }
  [[nodiscard]] std::string mask_rows() const {
    std::vector<std::string> items;
    for (const std::uint32_t mask : masks) items.push_back(fmt::format("{:#x}", mask));
    return in_lines(items);
  }
};

/// A contour by its part of the arrays.
struct List {
  std::size_t first_triangle, triangles, own_vertices, first_mask;
  std::vector<std::size_t> facet_end;
};

/// The table of all contours, each stored once.
struct Lists {
  std::vector<std::array<std::size_t, 3>> list_of;  ///< by entry: separate, low, high
  std::vector<List> lists;
  Arrays arrays;
  std::size_t max_facets = 0, max_triangles = 0, max_own_vertices = 0;
};

Lists lists_of(const ResolvedCube& table) {
  Lists result;
  std::map<std::pair<std::vector<CubeTriangle>, std::vector<std::uint32_t>>, std::size_t> known;
  for (const tables::ResolvedEntry& entry : table.entries) {
    auto number = result.list_of.emplace_back().begin();
    for (const tables::ResolvedList& list : {entry.separate, entry.low, entry.high}) {
      Arrays added;
      std::vector<std::size_t> ends;
      for (const CubeFilling& filling : fillings_of(table, list)) {
        added.add(filling, added.masks.size());
        ends.push_back(added.triangles.size());
      }
      const auto [at, is_new] = known.try_emplace({added.triangles, added.masks}, result.lists.size());
      *number++ = at->second;
      if (!is_new) continue;
      Arrays& all = result.arrays;
      result.lists.push_back(
          {all.triangles.size(), added.triangles.size(), added.masks.size(), all.masks.size(), ends});
      all.triangles.insert(all.triangles.end(), added.triangles.begin(), added.triangles.end());
      all.masks.insert(all.masks.end(), added.masks.begin(), added.masks.end());
      result.max_facets = std::max(result.max_facets, ends.size());
      result.max_triangles = std::max(result.max_triangles, added.triangles.size());
      result.max_own_vertices = std::max(result.max_own_vertices, added.masks.size());
    }
  }
  return result;
}

std::string by_table(const ResolvedCube& table, const Lists& lists, const std::string& banner, const std::string& name,
                     const std::string& space) {
  std::vector<std::string> rows, list_of;
  for (const auto& of_entry : lists.list_of) list_of.push_back(fmt::format("{{{}}}", fmt::join(of_entry, ", ")));
  for (const List& list : lists.lists) {
    std::vector<std::size_t> ends = list.facet_end;
    ends.resize(lists.max_facets);
    rows.push_back(fmt::format("{{{}, {}, {}, {}, {}, {{{}}}}}", list.first_triangle, list.triangles, list.own_vertices,
                               list.facet_end.size(), list.first_mask, fmt::join(ends, ", ")));
  }
  return filled("builder3.cpp", {{"banner", banner},
                                 {"name", name},
                                 {"namespace", space},
                                 {"ambiguous", in_lines(as_items(table.ambiguous))},
                                 {"first_entry", in_lines(as_items(table.first_entry))},
                                 {"entries", std::to_string(list_of.size())},
                                 {"list_of", in_lines(list_of)},
                                 {"lists", std::to_string(rows.size())},
                                 {"list_rows", in_lines(rows)},
                                 {"triangles", std::to_string(lists.arrays.triangles.size())},
                                 {"triangle_rows", lists.arrays.triangle_rows()},
                                 {"masks", std::to_string(lists.arrays.masks.size())},
                                 {"mask_rows", lists.arrays.mask_rows()}});
}

/// Lines of comment on the masks that only the barycentric triangulation has.
std::string mask_note(bool barycentric, const char* comment) {
  if (!barycentric) return "";
  return fmt::format(
      "{0}With bit {1}, it is the barycentre of the polygon through its points: the mean of the midpoints of the\n"
      "{0}sides, weighted by the length of the sides. It is the first vertex of its triangles (v, a, b), and the\n"
      "{0}segments from a to b are the sides.\n",
      comment, kBarycentreBit);
}

/// The words of shaders, as builder3.glsl.in describes them.
struct Words {
  std::vector<std::uint32_t> words;
  std::size_t entries = 0, lists = 0, triangles = 0, masks = 0;  ///< index of the first word of each part
};

Words words_of(const ResolvedCube& table, const Lists& lists) {
  Words result;
  std::vector<std::uint32_t>& words = result.words;
  for (std::size_t s = 0; s < 256; ++s)
    words.push_back(table.first_entry[s] | static_cast<std::uint32_t>(table.ambiguous[s]) << 16);
  const auto fits = [](std::size_t value, unsigned bits) {
    if (value >> bits != 0) throw Error(ErrorCode::Internal, fmt::format("{} needs more than {} bits", value, bits));
    return static_cast<std::uint32_t>(value);
  };
  result.entries = words.size();
  for (const auto& [separate, low, high] : lists.list_of)
    words.push_back(fits(separate, 10) | fits(low, 10) << 10 | fits(high, 10) << 20);
  result.lists = words.size();
  for (const List& list : lists.lists) {
    words.push_back(fits(list.first_triangle, 16) | fits(list.triangles, 16) << 16);
    words.push_back(fits(list.first_mask, 16) | fits(list.own_vertices, 16) << 16);
  }
  result.triangles = words.size();
  for (std::size_t t = 0; t < lists.arrays.triangles.size(); ++t) {
    const CubeTriangle& triangle = lists.arrays.triangles[t];
    if (t % 2 == 0) words.push_back(0);
    words.back() |= (fits(triangle[0], 4) | fits(triangle[1], 4) << 4 | fits(triangle[2], 4) << 8) << (16 * (t % 2));
  }
  result.masks = words.size();
  words.insert(words.end(), lists.arrays.masks.begin(), lists.arrays.masks.end());
  return result;
}

std::string shader(const Words& words, const Lists& lists, bool barycentric, const std::string& banner,
                   Language language) {
  std::vector<std::string> items;
  for (const std::uint32_t word : words.words) items.push_back(fmt::format("{}u", word));
  std::string rows = in_lines(items);
  rows.erase(rows.size() - 2, 1);  // GLSL allows no comma at the end of a constructor's arguments
  return filled(fmt::format("builder3.{}", language_name(language)),
                {{"banner", banner},
                 {"mask_note", mask_note(barycentric, "// ")},
                 {"max_triangles", std::to_string(lists.max_triangles)},
                 {"max_vertices", std::to_string(3 * lists.max_triangles)},
                 {"max_own", std::to_string(lists.max_own_vertices)},
                 {"words_count", std::to_string(words.words.size())},
                 {"words", rows},
                 {"entries_at", std::to_string(words.entries)},
                 {"lists_at", std::to_string(words.lists)},
                 {"triangles_at", std::to_string(words.triangles)},
                 {"masks_at", std::to_string(words.masks)}});
}

/// One call per square: corners, edges and sign, by axis and side.
std::string square_calls(const Tile& cube) {
  std::string text;
  for (const std::uint8_t q : kSquareOrder) {
    const SubTile& square = cube.faces[q];
    text += fmt::format("add_square({}, {{{}}}, {{{}}}, {:+}, signature, high_squares, boundary);  // {} = {}\n", q,
                        fmt::join(square.corner, ", "), fmt::join(square.edge, ", "), square.sign, kAxisNames[q / 2],
                        q % 2);
  }
  return text;
}

std::string axis_lines() {
  std::string text;
  for (unsigned axis = 0; axis < 3; ++axis) {
    unsigned lower = 0;
    for (unsigned v = 0; v < 8; ++v)
      if ((v >> axis & 1u) == 0) lower |= 1u << v;
    text +=
        fmt::format("region |= inside & ((region & {0:#04x}u) << {1} | (region >> {1} & {0:#04x}u));  // along {2}\n",
                    lower, 1u << axis, kAxisNames[axis]);
  }
  return text;
}

std::string square_lines(const Tile& cube) {
  std::string text;
  for (const std::uint8_t q : kSquareOrder)
    text += fmt::format(
        "if ((inside_centres >> {0} & 1u) != 0 && (region & {1:#04x}u) != 0) region |= inside & {1:#04x}u;  // {2} = "
        "{3}\n",
        q, cube.faces[q].corners(), kAxisNames[q / 2], q % 2);
  return text;
}

std::string squares_text(unsigned squares) {
  if (squares == (kNoneHigh | kMixed | kAllHigh | kHexagons)) return "kAny";
  std::vector<const char*> names;
  if ((squares & kNoneHigh) != 0) names.push_back("kLow");
  if ((squares & kMixed) != 0) names.push_back("kMixed");
  if ((squares & kAllHigh) != 0) names.push_back("kHigh");
  if ((squares & kHexagons) != 0) names.push_back("kHexagons");
  return fmt::format("{}", fmt::join(names, " | "));
}

std::string by_edges(const std::vector<FillingRow>& rule, const std::string& banner, const std::string& name,
                     const std::string& space) {
  const CubeLattice tiles(3);
  const Tile& cube = tiles.tile(3);
  Arrays arrays;
  std::string rows;
  for (const FillingRow& row : rule) {
    const std::string squares = squares_text(row.squares);
    std::vector<std::string> polygons;
    for (const CubePolygon& polygon : row.polygons) polygons.push_back(fmt::format("({})", fmt::join(polygon, " ")));
    rows +=
        fmt::format("{{{:#014x}, {}, {}, {}, {}, {}}},  // {}\n", row.key, squares, row.filling.triangles.size(),
                    row.filling.masks.size(), arrays.triangles.size(), arrays.masks.size(), fmt::join(polygons, " "));
    arrays.add(row.filling, 0);
  }
  std::vector<std::string> ends;
  for (const auto& [a, b] : cube.edges) ends.push_back(fmt::format("{{{}, {}}}", a, b));
  return filled("builder3_edges.cpp", {{"banner", banner},
                                       {"name", name},
                                       {"square", "builder2_edges"},
                                       {"namespace", space},
                                       {"add_squares", square_calls(cube)},
                                       {"along_axes", axis_lines()},
                                       {"across_squares", square_lines(cube)},
                                       {"ends", in_lines(ends)},
                                       {"fillings", fmt::format("{}", rule.size())},
                                       {"filling_rows", rows},
                                       {"triangles", std::to_string(arrays.triangles.size())},
                                       {"triangle_rows", arrays.triangle_rows()},
                                       {"masks", std::to_string(arrays.masks.size())},
                                       {"mask_rows", arrays.mask_rows()}});
}

}  // namespace

BuilderTexts emit_cube_builder(const BuilderRequest& request) {
  const bool barycentric = request.triangulation == Triangulation::barycentric;
  const ResolvedCube table = barycentric ? coned(make_resolved_cube()) : make_resolved_cube();
  certify_lists(table);
  const std::vector<FillingRow> rule = make_filling_rule(table);
  const Lists lists = lists_of(table);
  BuilderTexts texts;
  texts.certificate =
      fmt::format("{} triangulation, {} resolutions of 256 signatures, 3 ways each; {} proved to be embedded",
                  triangulation_name(request.triangulation), table.entries.size(), certify_embedding(table));
  const std::string name = builder_name(request), space = builder_namespace(request);
  for (const Language language : request.languages) {
    const auto banner = [&](const char* what) { return builder_banner(request, language, what, texts.certificate); };
    if (language != Language::cpp) {
      texts.files.push_back(
          {fmt::format("{}.{}", name, language_name(language)),
           shader(words_of(table, lists), lists, barycentric, banner("The contour in one cube."), language)});
      continue;
    }
    texts.files.push_back(
        {name + ".hpp", filled("builder3.hpp", {{"banner", banner("The contour in one cube.")},
                                                {"namespace", space},
                                                {"mask_note", mask_note(barycentric, "/// ")},
                                                {"max_facets", std::to_string(lists.max_facets)},
                                                {"max_triangles", std::to_string(lists.max_triangles)},
                                                {"max_own", std::to_string(lists.max_own_vertices)}})});
    texts.files.push_back(
        {name + ".cpp",
         request.leaf == Leaf::table
             ? by_table(table, lists, banner("The contour in one cube, by table."), name, space)
             : by_edges(rule, banner("The contour in one cube, by recursion over its squares."), name, space)});
  }
  return texts;
}

}  // namespace tegl::gen
