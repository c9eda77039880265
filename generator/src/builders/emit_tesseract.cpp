// SPDX-License-Identifier: BSD-3-Clause
//
// Emits the builder of the tesseract: by the lists of its cubes, or by recursion down to the edges.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/determinant.hpp"
#include "base/error.hpp"
#include "builders/cube_facets.hpp"
#include "builders/cube_lists.hpp"
#include "builders/cube_regions.hpp"
#include "builders/cube_words.hpp"
#include "builders/emit_builder.hpp"
#include "builders/templates.hpp"
#include "builders/tesseract_arrays.hpp"
#include "embedding/embedding_proof.hpp"
#include "tables/table_set.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::gen {

namespace {

constexpr const char* kAxes = "xyzt";
/// Corners at the lower end of each axis.
constexpr std::array<unsigned, 4> kLower = {0x5555, 0x3333, 0x0f0f, 0x00ff};

/// "x = 0"
std::string plane_name(unsigned f) { return fmt::format("{} = {}", kAxes[f / 2], f % 2); }

struct Square {
  unsigned base, axes, c, d, sides;  ///< c < d: axes that it does not span
};
std::vector<Square> all_squares() {
  std::vector<Square> result;
  for (unsigned c = 0; c < 4; ++c)
    for (unsigned d = c + 1; d < 4; ++d)
      for (unsigned sides = 0; sides < 4; ++sides)
        result.push_back({(sides & 1u) << c | (sides >> 1) << d, 15u ^ 1u << c ^ 1u << d, c, d, sides});
  return result;
}

/// One line per element, `per_line` of them in a line.
std::string rows(std::size_t count, std::size_t per_line, const std::function<std::string(std::size_t)>& element) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i)
    text += element(i) + (i + 1 == count || (i + 1) % per_line == 0 ? ",\n" : ", ");
  return text;
}

std::string square_list() {
  std::string text;
  for (const Square& q : all_squares())
    text += fmt::format("{{{}, {}}},  // {} = {}, {} = {}\n", q.base, q.axes, kAxes[q.c], q.sides & 1, kAxes[q.d],
                        q.sides >> 1);
  return text;
}

/// Squares of cubes, by pairs of axes that squares do not span.
std::string squares_of_cubes() {
  std::string text = "std::uint64_t result = 0;\n";
  const auto squares = all_squares();
  for (unsigned pair = 0; pair < 6; ++pair)
    text += fmt::format("result |= kSquaresOfPairs[{}][tile >> {} & 15u];  // across {} and {}\n", pair, 4 * pair,
                        kAxes[squares[std::size_t{4} * pair].c], kAxes[squares[std::size_t{4} * pair].d]);
  return text + "return result;\n";
}

std::uint32_t ends_of(unsigned edge) {
  const unsigned base = detail::edge_base(4, edge);
  return 1u << base | 1u << (base | 1u << edge / 8);
}

std::string edges_with_vertices() {
  // Compresses the bits of the corners at the lower end of an axis, lowest first.
  std::string text = "std::uint32_t ends = 0;\n";
  for (unsigned a = 0; a < 4; ++a) {
    text +=
        fmt::format("ends = (signature ^ signature >> {}) & {:#06x}u;  // along {}\n", 1u << a, kLower[a], kAxes[a]);
    for (unsigned b = a; b < 3; ++b)
      text += fmt::format("ends = (ends | ends >> {}) & {:#06x}u;\n", 1u << b, kLower[b + 1]);
    text += fmt::format("result |= ends << {};\n", 8 * a);
  }
  return text;
}

std::string ends_of_edges() {
  // Expands the bits of the edges along an axis to those of the corners at their lower ends.
  std::string text;
  for (unsigned a = 0; a < 4; ++a) {
    text += fmt::format("ends = edges >> {} & 0xffu;  // along {}\n", 8 * a, kAxes[a]);
    for (unsigned b = 3; b-- > a;) text += fmt::format("ends = (ends | ends << {}) & {:#06x}u;\n", 1u << b, kLower[b]);
    text += fmt::format("result |= ends | ends << {};\n", 1u << a);
  }
  return text;
}

std::string differences() {
  std::string text;
  for (unsigned a = 0; a < 4; ++a)
    text +=
        fmt::format("const std::uint32_t {} = signature ^ signature >> {};  // bit v: v and the next corner along {}\n",
                    kAxes[a], 1u << a, kAxes[a]);
  return text;
}

std::string ambiguous_squares() {
  std::string text;
  const auto squares = all_squares();
  for (unsigned a = 0; a < 4; ++a)
    for (unsigned b = a + 1; b < 4; ++b) {
      text += fmt::format("found = {} & {} & {} >> {};  // along {} and {}\n", kAxes[a], kAxes[b], kAxes[b], 1u << a,
                          kAxes[a], kAxes[b]);
      std::vector<std::string> terms;
      for (std::size_t q = 0; q < squares.size(); ++q)
        if (squares[q].axes == (1u << a | 1u << b))
          terms.push_back(fmt::format("(found >> {} & 1u) << {}", squares[q].base, q));
      text += fmt::format("result |= {};\n", fmt::join(terms, " | "));
    }
  return text;
}

std::string with_neighbours() {
  std::string text;
  for (unsigned a = 0; a < 4; ++a)
    text += fmt::format("result |= (corners & {:#06x}u) << {} | (corners >> {} & {:#06x}u);  // along {}\n", kLower[a],
                        1u << a, 1u << a, kLower[a], kAxes[a]);
  return text;
}

/// A line for each cube; `{}` stands for its number.
std::string for_cubes(const char* line) {
  std::string text;
  for (unsigned f = 0; f < 8; ++f) text += fmt::format(fmt::runtime(line), f) + "  // " + plane_name(f) + "\n";
  return text;
}

std::string corner_sets(std::size_t count, std::size_t per_line, const std::function<std::uint32_t(unsigned)>& set) {
  return rows(count, per_line, [&](std::size_t i) { return fmt::format("{:#06x}", set(static_cast<unsigned>(i))); });
}

using FourPoint = std::array<int, 4>;

/// Sets of points above and below the hyperplane through corners, as masks: `above` and `below` are the corners, and
/// the bits of `points` follow. Coordinates of points are in thousandths of an edge.
std::pair<std::uint32_t, std::uint32_t> with_points(std::uint32_t above, std::uint32_t below,
                                                    std::span<const FourPoint> points) {
  const auto corner = [](unsigned v) {
    FourPoint point{};
    for (unsigned a = 0; a < 4; ++a) point[a] = static_cast<int>(v >> a & 1u);
    return point;
  };
  std::vector<FourPoint> inside;
  for (unsigned v = 0; v < 16; ++v)
    if (((above | below) >> v & 1u) == 0) inside.push_back(corner(v));
  const FourPoint base = inside[0];
  for (FourPoint& point : inside)
    for (unsigned a = 0; a < 4; ++a) point[a] -= base[a];
  // `unit`: the unit of the point's coordinates is an edge divided by it.
  const auto height = [&](const FourPoint& normal, const FourPoint& point, int unit) {
    int sum = 0;
    for (unsigned a = 0; a < 4; ++a) sum += normal[a] * (point[a] - unit * base[a]);
    return sum;
  };
  for (std::size_t i = 1; i < inside.size(); ++i)
    for (std::size_t j = 1; j < i; ++j)
      for (std::size_t k = 1; k < j; ++k) {
        const std::array<FourPoint, 3> directions = {inside[i], inside[j], inside[k]};
        const FourPoint normal = cross_product(directions, 4);
        if (normal == FourPoint{}) continue;
        const int up = height(normal, corner(static_cast<unsigned>(std::countr_zero(above))), 1) < 0 ? -1 : 1;
        for (std::size_t p = 0; p < points.size(); ++p) {
          const int at = up * height(normal, points[p], 1000);
          if (at > 0) above |= 0x10000u << p;
          if (at < 0) below |= 0x10000u << p;
        }
        return {above, below};
      }
  throw std::logic_error("a hyperplane that its corners do not span");
}

/// Hyperplanes through corners that divide the tesseract. Those with few corners on one side divide most pairs of
/// components, which lie around few corners, so they come first. After the corners: ResolvedTesseract::kCentre,
/// kMeanTarget.
std::string dividers() {
  constexpr std::array<FourPoint, 2> kPoints = {{{500, 500, 500, 500}, {487, 497, 507, 517}}};
  const Lattice lattice(TileKind::cube, 4);
  const EmbeddingProof proof(lattice.tile(4));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> planes;
  for (const auto& [above, below] : proof.hyperplanes())
    if (above != 0 && below != 0) planes.emplace_back(above, below);
  const auto smaller_side = [](const auto& plane) {
    return std::min(std::popcount(plane.first), std::popcount(plane.second));
  };
  std::stable_sort(planes.begin(), planes.end(),
                   [&](const auto& a, const auto& b) { return smaller_side(a) < smaller_side(b); });
  return rows(planes.size(), 3, [&](std::size_t i) {
    const auto [above, below] = with_points(planes[i].first, planes[i].second, kPoints);
    std::uint32_t inside = 0;
    for (unsigned e = 0; e < 32; ++e) inside |= (ends_of(e) & (above | below)) == 0 ? 1u << e : 0u;
    return fmt::format("{{{:#07x}, {:#07x}, {:#010x}}}", above, below, inside);
  });
}

std::string lifted_vertices() {
  std::string text;
  for (unsigned f = 0; f < 8; ++f) {
    std::array<std::uint64_t, 2> words{};
    for (unsigned v = 0; v < 16; ++v) {
      const unsigned lifted = v < 12 ? detail::lifted_edge(4, f, v) : 32 + 4 * f + (v - 12);
      words[v / 8] |= std::uint64_t{lifted} << (8 * (v % 8));
    }
    text += fmt::format("{{{:#018x}, {:#018x}}},  // {}\n", words[0], words[1], plane_name(f));
  }
  return text;
}

std::uint32_t corners_of_square(unsigned number) {
  const Square q = all_squares()[number];
  std::uint32_t corners = 0;
  for (unsigned v = 0; v < 16; ++v)
    if ((v & ~q.axes) == q.base) corners |= 1u << v;
  return corners;
}

std::string lifted_corners() {
  std::string text;
  for (unsigned f = 0; f < 8; ++f) {
    std::array<unsigned, 8> corners{};
    for (unsigned v = 0; v < 8; ++v) corners[v] = detail::lifted_corner(f, v);
    text += fmt::format("{{{}}},  // {}\n", fmt::join(corners, ", "), plane_name(f));
  }
  return text;
}

unsigned reversed_cubes() {
  unsigned result = 0;
  for (unsigned f = 0; f < 8; ++f) result |= (detail::face_sign(f) < 0 ? 1u : 0u) << f;
  return result;
}

std::string class_text(const BuilderRequest& request) {
  if (request.leaf == Leaf::table)
    return filled("builder4_class.hpp", {{"part", "cubes_.part(parts_[i])"},
                                         {"members",
                                          "  std::array<std::uint32_t, 32 + ResolvedCubes::kMostParts> parts_{};  ///< "
                                          "numbers of the parts of its cubes\n"}});
  return filled("builder4_class.hpp", {{"part", "parts_of_cubes_[i]"},
                                       {"members", std::string(template_text("builder4_edges_members.hpp"))}});
}

std::string source_text(const BuilderRequest& request, const std::string& banner) {
  const bool edges = request.leaf == Leaf::edges;
  std::string add_all;
  for (unsigned f = 0; f < 8; ++f) {
    if (f == 1) add_all += "const unsigned first_of_1 = count;\n";
    add_all += fmt::format("add({});  // {}\n", f, plane_name(f));
    if (f == 1) add_all += "const unsigned end_of_1 = count;\n";
  }
  const std::string parts = edges ? "builder4_edges_parts.cpp" : "builder4_parts.cpp";
  constexpr const char* kBuiltTriangles =
      "{triangles_of_cubes_.data() + 4 * std::size_t{of_part.first_triangle},\n"
      "                          of_part.triangle_count, of_part.cube}";
  const std::string sets = filled("builder4_sets.cpp", {{"ends_of_edges", ends_of_edges()},
                                                        {"edges_with_vertices", edges_with_vertices()},
                                                        {"differences", differences()},
                                                        {"ambiguous_squares", ambiguous_squares()},
                                                        {"with_neighbours", with_neighbours()}});
  return filled("builder4.cpp",
                {{"banner", banner},
                 {"name", builder_name(request)},
                 {"namespace", builder_namespace(request)},
                 {"dividers", dividers()},
                 {"corners_of_squares", corner_sets(24, 8, corners_of_square)},
                 {"corners_of_cubes",
                  corner_sets(8, 8, [](unsigned f) { return static_cast<std::uint32_t>(detail::face_corners(4, f)); })},
                 {"ends", corner_sets(32, 8, ends_of)},
                 {"lifted_corners", lifted_corners()},
                 {"lifted_vertices", lifted_vertices()},
                 {"sets", sets},
                 {"local_functions", edges ? std::string(template_text("builder4_edges_local.cpp")) : std::string()},
                 {"find_parts", filled(parts, {{"add_cubes", add_all}})},
                 {"triangles_of_part", edges ? kBuiltTriangles : "cubes_.triangles(of_part)"},
                 {"nested", std::string(template_text("builder4_nested.cpp"))},
                 {"cone_all", edges ? std::string(template_text("builder4_edges_cone.cpp"))
                                    : std::string(template_text("builder4_cone.cpp"))},
                 {"cone_apart", edges ? std::string(template_text("builder4_edges_apart.cpp"))
                                      : std::string(template_text("builder4_apart.cpp"))},
                 {"find_connected", edges ? std::string(template_text("builder4_edges_connected.cpp"))
                                          : filled("builder4_connected.cpp", {{"add_cubes", for_cubes("add({});")}})}});
}

/// The builder of facets: header and source. The lists are those of the compact triangulation.
void add_facet_builder(const BuilderRequest& request, const TesseractArrays& arrays, BuilderTexts& texts) {
  const std::vector<CubeFacets> facets = make_cube_facets(arrays.lists.back());
  std::size_t most = 0, count = 0;
  for (const CubeFacets& of : facets) {
    most = std::max(most, of.facets.size());
    count += of.facets.size();
  }
  const std::string certificate = fmt::format(
      "{} facets of the {} lists; closed boundaries, uses of segments, Euler characteristics", count, facets.size());
  texts.certificate += "; " + certificate;
  const std::string banner =
      builder_banner(request, Language::cpp, "The facets of squares, cubes and tesseracts.", certificate);
  std::string squares;
  for (unsigned f = 0; f < 6; ++f) {
    std::array<unsigned, 6> of_cube{};
    for (unsigned q = 0; q < 6; ++q) of_cube[q] = square_of_cube(f, q);
    squares += fmt::format("{{{}}},  // {}\n", fmt::join(of_cube, ", "), plane_name(f));
  }
  const std::string name = builder_name(request) + "_facets";
  texts.files.push_back({name + ".hpp", filled("builder4_facets.hpp", {{"banner", banner},
                                                                       {"namespace", builder_namespace(request)},
                                                                       {"most_facets", fmt::format("{}", most)}})});
  texts.files.push_back(
      {name + ".cpp", filled("builder4_facets.cpp", {{"banner", banner},
                                                     {"name", name},
                                                     {"namespace", builder_namespace(request)},
                                                     {"arrays", facet_arrays_text(facets)},
                                                     {"squares_of_cubes", squares},
                                                     {"reversed_cubes", fmt::format("{:#04x}", reversed_cubes())}})});
}

/// The tables by which the lists of many cubes are looked up: header and source.
void add_lookup(const BuilderRequest& request, const TesseractArrays& arrays, BuilderTexts& texts) {
  const std::vector<CubeWords> words = make_cube_words(arrays);
  const std::string certificate =
      fmt::format("{} words about each of {} resolved cubes name its lists, choices and pairs of edges", words.size(),
                  arrays.cube.entries.size());
  texts.certificate += "; " + certificate;
  const std::string banner = builder_banner(request, Language::cpp, "Lookups of the lists of cubes.", certificate);
  const std::string name = builder_name(request) + "_lookup";
  const std::pair<std::string, std::string> common[] = {{"banner", banner}, {"namespace", builder_namespace(request)}};
  texts.files.push_back({name + ".hpp", filled("builder4_lookup.hpp", {common[0], common[1]})});
  texts.files.push_back(
      {name + ".cpp", filled("builder4_lookup.cpp", {common[0], common[1], {"arrays", words_text(words, arrays)}})});
}

}  // namespace

BuilderTexts emit_tesseract_builder(const BuilderRequest& request) {
  const TesseractArrays arrays = make_tesseract_arrays();
  BuilderTexts texts;
  texts.certificate = fmt::format(
      "the {} lists of the cube in both triangulations, {} regions of their sides; boundary, links and squares. "
      "Embedded: lists and regions proved for all positions; so are the fillings made of them: one cone, cones that "
      "hyperplanes divide, copies of regions, and nested copies from a root",
      arrays.lists.front().lists.size(), arrays.region_count());
  const auto banner = [&](const std::string& what) {
    return builder_banner(request, Language::cpp, what, texts.certificate);
  };
  const std::string name = builder_name(request);
  if (request.leaf == Leaf::edges) {
    texts.files.push_back(
        {name + ".hpp", filled("builder4_edges.hpp", {{"banner", banner("The contour of a tesseract, from its edges.")},
                                                      {"namespace", builder_namespace(request)},
                                                      {"class", class_text(request)}})});
  } else {
    texts.files.push_back(
        {name + ".hpp",
         filled("builder4.hpp", {{"banner", banner("The contour of a tesseract.")},
                                 {"namespace", builder_namespace(request)},
                                 {"square_list", square_list()},
                                 {"list_count", fmt::format("{}", arrays.lists.front().lists.size())},
                                 {"most_triangles", fmt::format("{}", arrays.most_triangles())},
                                 {"squares_of_cubes", squares_of_cubes()},
                                 {"parts_of_cube", fmt::format("{}u", arrays.lists.front().parts_of_cube)},
                                 {"reversed_cubes", fmt::format("{:#04x}", reversed_cubes())},
                                 {"entry_count", fmt::format("{}", arrays.cube.entries.size())},
                                 {"class", class_text(request)}})});
  }
  texts.files.push_back({name + ".cpp", source_text(request, banner("The contour of a tesseract."))});
  if (request.leaf == Leaf::table) {
    texts.files.push_back({name + "_lists.cpp", filled("builder4_lists.cpp", {{"banner", banner("Arrays.")},
                                                                              {"arrays", arrays_text(arrays)}})});
    add_facet_builder(request, arrays, texts);
    add_lookup(request, arrays, texts);
  }
  return texts;
}

}  // namespace tegl::gen
