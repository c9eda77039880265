// SPDX-License-Identifier: BSD-3-Clause
//
// Emits the builder of the cube: by table, or by recursion over its squares down to the edges.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/lattice.hpp"
#include "builders/cube_rule.hpp"
#include "builders/emit_builder.hpp"
#include "builders/templates.hpp"
#include "filling/resolved_cube.hpp"

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

/// Triangles and masks of all fillings of a builder.
struct Arrays {
  std::vector<std::string> triangles, masks;

  void add(const CubeFilling& filling, std::size_t own_vertices) {
    for (const CubeTriangle& t : filling.triangles) {
      const auto vertex = [own_vertices](std::size_t v) { return v < 12 ? v : v + own_vertices; };
      triangles.push_back(fmt::format("{{{}, {}, {}}}", vertex(t[0]), vertex(t[1]), vertex(t[2])));
    }
    for (const std::uint32_t mask : filling.masks) masks.push_back(fmt::format("{:#x}", mask));
  }
};

/// Limits of a contour.
struct Limits {
  std::size_t facets = 0, triangles = 0, own_vertices = 0;
};

Limits limits_of(const ResolvedCube& table) {
  Limits limits;
  for (const tables::ResolvedEntry& entry : table.entries)
    for (const tables::ResolvedList& list : {entry.separate, entry.low, entry.high}) {
      limits.facets = std::max(limits.facets, fillings_of(table, list).size());
      limits.triangles = std::max<std::size_t>(limits.triangles, list.triangle_count);
      limits.own_vertices = std::max<std::size_t>(limits.own_vertices, list.own_vertices);
    }
  return limits;
}

std::string by_table(const ResolvedCube& table, const Limits& limits, const std::string& banner,
                     const std::string& name, const std::string& space) {
  Arrays arrays;
  std::vector<std::string> lists, list_of;
  std::map<std::string, std::size_t> known;  // the fillings of a list as text -> its number
  for (const tables::ResolvedEntry& entry : table.entries) {
    std::vector<std::size_t> numbers;
    for (const tables::ResolvedList& list : {entry.separate, entry.low, entry.high}) {
      const std::vector<CubeFilling> fillings = fillings_of(table, list);
      const std::size_t first_triangle = arrays.triangles.size(), first_mask = arrays.masks.size();
      Arrays added;
      std::vector<std::size_t> ends;
      for (const CubeFilling& filling : fillings) {
        added.add(filling, added.masks.size());
        ends.push_back(added.triangles.size());
      }
      ends.resize(limits.facets);
      const std::string text = fmt::format("{} {}", fmt::join(added.triangles, ""), fmt::join(added.masks, " "));
      const auto [at, is_new] = known.try_emplace(text, lists.size());
      numbers.push_back(at->second);
      if (!is_new) continue;
      lists.push_back(fmt::format("{{{}, {}, {}, {}, {}, {{{}}}}}", first_triangle, list.triangle_count,
                                  list.own_vertices, fillings.size(), first_mask, fmt::join(ends, ", ")));
      arrays.triangles.insert(arrays.triangles.end(), added.triangles.begin(), added.triangles.end());
      arrays.masks.insert(arrays.masks.end(), added.masks.begin(), added.masks.end());
    }
    list_of.push_back(fmt::format("{{{}}}", fmt::join(numbers, ", ")));
  }
  return filled("builder3.cpp", {{"banner", banner},
                                 {"name", name},
                                 {"namespace", space},
                                 {"ambiguous", in_lines(as_items(table.ambiguous))},
                                 {"first_entry", in_lines(as_items(table.first_entry))},
                                 {"entries", fmt::format("{}", list_of.size())},
                                 {"list_of", in_lines(list_of)},
                                 {"lists", fmt::format("{}", lists.size())},
                                 {"list_rows", in_lines(lists)},
                                 {"triangles", fmt::format("{}", arrays.triangles.size())},
                                 {"triangle_rows", in_lines(arrays.triangles)},
                                 {"masks", fmt::format("{}", arrays.masks.size())},
                                 {"mask_rows", in_lines(arrays.masks)}});
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

std::string by_edges(const std::vector<FillingRow>& rule, const std::string& banner, const std::string& name,
                     const std::string& space) {
  const CubeLattice tiles(3);
  const Tile& cube = tiles.tile(3);
  Arrays arrays;
  std::string rows;
  for (const FillingRow& row : rule) {
    const char* const squares = row.squares == (kNoneHigh | kMixed | kAllHigh) ? "kAny"
                                : row.squares == kNoneHigh                     ? "kLow"
                                : row.squares == kMixed                        ? "kMixed"
                                : row.squares == kAllHigh                      ? "kHigh"
                                : row.squares == (kNoneHigh | kMixed)          ? "kLow | kMixed"
                                : row.squares == (kMixed | kAllHigh)           ? "kMixed | kHigh"
                                                                               : "kLow | kHigh";
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
                                       {"triangles", fmt::format("{}", arrays.triangles.size())},
                                       {"triangle_rows", in_lines(arrays.triangles)},
                                       {"masks", fmt::format("{}", arrays.masks.size())},
                                       {"mask_rows", in_lines(arrays.masks)}});
}

}  // namespace

BuilderTexts emit_cube_builder(const BuilderRequest& request) {
  const ResolvedCube table = make_resolved_cube();
  const std::vector<FillingRow> rule = make_filling_rule(table);
  const Limits limits = limits_of(table);
  BuilderTexts texts;
  texts.certificate = fmt::format("{} resolutions of 256 signatures, {} ways each", table.entries.size(), 3);
  const std::string name = builder_name(request), space = builder_namespace(request);
  for (const Language language : request.languages) {
    if (language != Language::cpp)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--dim 3: --builder does not emit {} yet; expected cpp", language_name(language)));
    const auto banner = [&](const char* what) { return builder_banner(request, language, what, texts.certificate); };
    texts.files.push_back({name + ".hpp", filled("builder3.hpp", {{"banner", banner("The contour in one cube.")},
                                                                  {"namespace", space},
                                                                  {"max_facets", std::to_string(limits.facets)},
                                                                  {"max_triangles", std::to_string(limits.triangles)},
                                                                  {"max_own", std::to_string(limits.own_vertices)}})});
    texts.files.push_back(
        {name + ".cpp",
         request.leaf == Leaf::table
             ? by_table(table, limits, banner("The contour in one cube, by table."), name, space)
             : by_edges(rule, banner("The contour in one cube, by recursion over its squares."), name, space)});
  }
  return texts;
}

}  // namespace tegl::gen
