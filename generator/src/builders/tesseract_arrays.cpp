// SPDX-License-Identifier: BSD-3-Clause
//
// Makes the arrays of the tesseract's builder from the resolved cube and writes them as C++.
#include "builders/tesseract_arrays.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <span>

#include "tables/table_set.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::gen {

namespace {

using Out = std::back_insert_iterator<std::string>;

/// `const TYPE NAME = {...};` with one element as `write` formats it. `open`, `close`: braces.
template <class Range, class Write>
void define(std::string& text, const std::string& declaration, const Range& values, const Write& write,
            const char* open = "{", const char* close = "}") {
  fmt::format_to(Out(text), "\nconst {} = {}", declaration, open);
  std::size_t line = text.size();
  bool is_first = true;
  for (const auto& v : values) {
    const std::string element = write(v);
    if (is_first || text.size() - line + element.size() > 112) {
      text += "\n    ";
      line = text.size() - 4;
      is_first = false;
    }
    text += element + ",";
  }
  fmt::format_to(Out(text), "{};\n", close);
}

std::string number(std::uint64_t value) { return fmt::format("{}", value); }
std::string mask(std::uint64_t value) { return fmt::format("{:#x}", value); }

/// Bytes as a string literal, which compilers read a hundred times faster than lists of numbers.
void define_bytes(std::string& text, const std::string& name, const std::vector<std::uint8_t>& bytes,
                  std::size_t per_line) {
  fmt::format_to(Out(text), "\nconst unsigned char {}[] =", name);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (i % per_line == 0) text += i == 0 ? "\n    \"" : "\"\n    \"";
    fmt::format_to(Out(text), "\\{:o}", bytes[i]);
  }
  text += "\";\n";
}

template <class Element>
std::vector<std::uint8_t> flat(const std::vector<Element>& elements, std::size_t more) {
  std::vector<std::uint8_t> bytes;
  for (const Element& e : elements) bytes.insert(bytes.end(), e.begin(), e.end());
  bytes.resize(bytes.size() + more);
  return bytes;
}

std::string class_array(const std::string& type, const char* name) {
  return fmt::format("{} ResolvedCubes::{}", type, name);
}

std::string inner_array(std::span<const std::uint64_t> values) {
  return fmt::format("{{{{{:#x}}}}}", fmt::join(values, ","));
}

/// Signatures of the cubes: those of a tile with the corners 0 to 7, or 8 to 15.
void define_signatures(std::string& text) {
  std::array<std::array<std::uint64_t, 256>, 2> signatures{};
  for (unsigned half = 0; half < 2; ++half)
    for (unsigned tile = 0; tile < 256; ++tile)
      for (unsigned f = 0; f < 8; ++f)
        signatures[half][tile] |= std::uint64_t{detail::face_signature(4, tile << (8 * half), f)} << (8 * f);
  define(text, class_array("std::array<std::array<std::uint64_t, 256>, 2>", "kSignatures"), signatures, inner_array,
         "{{", "}}");
}

/// Squares of the cubes, by pair of axes and set of the pair's squares.
void define_squares(std::string& text) {
  std::array<std::array<std::uint64_t, 16>, 6> squares{};
  for (unsigned pair = 0, c = 0; c < 4; ++c)
    for (unsigned d = c + 1; d < 4; ++d, ++pair)
      for (unsigned sides = 0; sides < 4; ++sides) {
        // In the cube that omits one of the two axes, the other axis's number is one less if it is the higher one.
        const unsigned f_of_c = 2 * c + (sides & 1u), q_of_c = 2 * (d - 1) + (sides >> 1);
        const unsigned f_of_d = 2 * d + (sides >> 1), q_of_d = 2 * c + (sides & 1u);
        for (unsigned set = 0; set < 16; ++set)
          if ((set >> sides & 1u) != 0)
            squares[pair][set] |= std::uint64_t{1} << (8 * f_of_c + q_of_c) | std::uint64_t{1} << (8 * f_of_d + q_of_d);
      }
  define(text, class_array("std::array<std::array<std::uint64_t, 16>, 6>", "kSquaresOfPairs"), squares, inner_array,
         "{{", "}}");
}

/// Entries of cubes, by signature and resolution.
void define_entries(std::string& text, const TesseractArrays& arrays) {
  std::vector<unsigned> all(256);
  for (unsigned s = 0; s < 256; ++s) all[s] = s;
  define(
      text, class_array("std::array<ResolvedCubes::Signature, 256>", "kOfSignatures"), all,
      [&](unsigned s) { return fmt::format("{{{},{}}}", arrays.cube.first_entry[s], arrays.cube.ambiguous[s]); }, "{{",
      "}}");
  define(
      text, class_array("std::array<std::array<std::uint8_t, 64>, 64>", "kPackedSquares"), std::span(all).first(64),
      [](unsigned ambiguous) {
        std::array<unsigned, 64> packed{};
        for (unsigned set = 0; set < 64; ++set)
          for (unsigned q = 0, bit = 1; q < 6; ++q) {
            if ((ambiguous >> q & 1u) == 0) continue;
            packed[set] |= (set >> q & 1u) != 0 ? bit : 0;
            bit *= 2;
          }
        return fmt::format("{{{{{}}}}}", fmt::join(packed, ","));
      },
      "{{", "}}");
  const CubeLists& lists = arrays.lists.front();
  std::vector<std::size_t> entries(arrays.cube.entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) entries[i] = i;
  define(
      text, class_array(fmt::format("std::array<ResolvedCubes::Entry, {}>", entries.size()), "kEntries"), entries,
      [&](std::size_t entry) {
        std::array<std::size_t, 3> by_choice{};
        for (std::size_t choice = 0; choice < 3; ++choice) {
          const std::uint16_t list = lists.list_of[3 * entry + choice];
          by_choice[choice] = list == CubeLists::kNone ? lists.lists.size() : list;
        }
        return fmt::format("{{{{{}}},{}}}", fmt::join(by_choice, ","),
                           arrays.cube.entries[entry].components > 1 ? 1 : 0);
      },
      "{{", "}}");
}

/// Edges and local vertices of the cubes in the tesseract's numbering.
void define_frames(std::string& text) {
  std::array<std::uint64_t, 32> beside{};
  std::array<std::uint32_t, 8> edges{};
  for (unsigned f = 0; f < 8; ++f) {
    edges[f] = detail::face_edges(4, f);
    const std::uint64_t own = ((std::uint64_t{1} << CubeLists::kMostOwn) - 1)
                              << (CubeLists::kEdges + CubeLists::kMostOwn * f);
    for (unsigned e = 0; e < 32; ++e)
      if ((edges[f] >> e & 1u) != 0) beside[e] |= edges[f] | own;
  }
  define(text, class_array("std::array<std::uint64_t, ResolvedCubes::kEdges>", "kBeside"), beside, mask, "{{", "}}");
  define(text, class_array("std::array<std::uint32_t, ResolvedCubes::kCubes>", "kEdgesOfCubes"), edges, mask, "{{",
         "}}");
  define(
      text,
      class_array("std::array<std::array<std::uint8_t, 12 + ResolvedCubes::kMostOwn>, ResolvedCubes::kCubes>",
                  "kLifted"),
      std::array{0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u},
      [](unsigned f) {
        std::array<unsigned, CubeLists::kCubeEdges + CubeLists::kMostOwn> lifted{};
        for (unsigned v = 0; v < lifted.size(); ++v) lifted[v] = lifted_vertex(f, v);
        return fmt::format("{{{{{}}}}}", fmt::join(lifted, ","));
      },
      "{{", "}}");
  define(
      text,
      class_array("std::array<std::array<std::array<std::uint32_t, 64>, 2>, ResolvedCubes::kCubes>", "kLiftedEdges"),
      std::array{0u, 1u, 2u, 3u, 4u, 5u, 6u, 7u},
      [](unsigned f) {
        std::array<std::array<std::uint32_t, 64>, 2> lifted{};
        for (unsigned e = 0; e < CubeLists::kCubeEdges; ++e)
          for (unsigned set = 0; set < 64; ++set) lifted[e / 6][set] |= (set >> e % 6 & 1u) << lifted_vertex(f, e);
        return fmt::format("{{{{{{{{{}}}}},{{{{{}}}}}}}}}", fmt::join(lifted[0], ","), fmt::join(lifted[1], ","));
      },
      "{{", "}}");
}

void define_lists(std::string& text, const CubeLists& lists, const std::string& suffix) {
  const auto name = [&](const char* type, const char* what) { return fmt::format("{} k{}{}[]", type, what, suffix); };
  define(text, name("CubeList", "Lists"), lists.lists, [](const CubeLists::List& l) {
    return fmt::format("{{{},{},{},{}}}", l.entry, l.choice, l.signature, l.high_squares);
  });
  define(text, name("std::uint16_t", "Keys"), lists.lists, [](const CubeLists::List& l) { return number(l.key); });
  define_bytes(text, "kTriangles" + suffix, lists.triangles, 36);
  std::vector<std::uint32_t> first;
  for (const CubeLists::List& l : lists.lists) first.push_back(l.first_triangle);
  first.push_back(static_cast<std::uint32_t>(lists.triangles.size() / 3));
  define(text, name("std::uint32_t", "FirstTriangle"), first, number);
  define(text, name("std::array<std::uint32_t, ResolvedCubes::kMostOwn>", "Masks"), lists.lists,
         [](const CubeLists::List& l) { return fmt::format("{{{{{}}}}}", fmt::join(l.masks, ",")); });
  std::vector<CubeLists::List> and_none = lists.lists;
  and_none.push_back({});
  define(text, name("ResolvedCubes::Summary", "Summaries"), and_none, [&](const CubeLists::List& l) {
    const std::uint32_t first_triangle = l.part_count == 0 ? 0 : lists.parts[l.first_part].first_triangle;
    return fmt::format("{{{},{},{},{},{},{},{}}}", l.first_part, first_triangle, l.not_apexes, l.part_count,
                       l.triangle_count, l.own_vertices, l.barycentres);
  });
  std::vector<CubeLists::Part> parts = lists.parts;
  parts.resize(lists.parts_of_cube);
  define(text, name("ResolvedCubes::PartOfCube", "Parts"), parts, [](const CubeLists::Part& p) {
    return fmt::format("{{{},{},{}}}", p.first_triangle, p.not_apexes, p.triangle_count);
  });
  parts = lists.parts;
  parts.resize(parts.size() + CubeLists::kMostParts);
  define(text, name("std::uint64_t", "PartVertices"), parts, [](const CubeLists::Part& p) { return mask(p.vertices); });
  constexpr std::size_t kWordsBehind = 16;
  define_bytes(text, "kWords" + suffix, flat(lists.words, 4 * kWordsBehind), 32);
  fmt::format_to(Out(text),
                 "\nconstinit const ResolvedCubes kCubes{0}({{kLists{0}, kKeys{0}, kTriangles{0}, kFirstTriangle{0}, "
                 "kMasks{0}, kSummaries{0},\n                                          kParts{0}, kPartVertices{0}, "
                 "kWords{0}}});\n",
                 suffix);
}

void define_regions(std::string& text, const CubeRegions& regions, const std::string& suffix) {
  const auto name = [&](const char* type, const char* what) { return fmt::format("{} k{}{}[]", type, what, suffix); };
  define(text, name("std::uint32_t", "FirstRegion"), regions.first_region, number);
  constexpr std::size_t kMoreRegions = 2;
  std::vector<CubeRegions::Region> and_more = regions.regions;
  and_more.resize(and_more.size() + kMoreRegions);
  define(text, name("CubeRegions::Region", "Regions"), and_more, [](const CubeRegions::Region& r) {
    return fmt::format("{{{},{},{},{},{}}}", r.corners, r.centre_count, r.tetrahedron_count, r.first_tetrahedron,
                       r.first_centre);
  });
  constexpr std::size_t kMoreTetrahedra = 15;
  define_bytes(text, "kTetrahedra" + suffix, flat(regions.tetrahedra, 4 * kMoreTetrahedra), 32);
  define(text, name("std::uint32_t", "Centres"), regions.centres, mask);
  fmt::format_to(Out(text),
                 "\nconstinit const CubeRegions kRegionsOf{0}({{kFirstRegion{0}, kRegions{0}, kTetrahedra{0}, "
                 "kCentres{0}}});\n",
                 suffix);
}

}  // namespace

std::size_t TesseractArrays::region_count() const {
  std::size_t count = 0;
  for (const CubeRegions& r : regions) count += r.regions.size();
  return count;
}

unsigned TesseractArrays::most_triangles() const {
  unsigned most = 0;
  for (const CubeLists& of : lists)
    for (const CubeLists::List& l : of.lists) most = std::max<unsigned>(most, l.triangle_count);
  return most;
}

TesseractArrays make_tesseract_arrays() {
  TableRequest request;
  request.dim = 3;
  TableSet set = make_table_set(request);
  TesseractArrays arrays;
  arrays.cube = std::move(*set.resolved);
  arrays.joins = std::move(set.joins);
  for (const VariantTables& variants : set.variants) {
    arrays.lists.push_back(make_cube_lists(arrays.cube, variants));
    arrays.regions.push_back(make_cube_regions(arrays.lists.back(), false));
  }
  for (const CubeLists& lists : arrays.lists) arrays.regions.push_back(make_cube_regions(lists, true));
  return arrays;
}

std::string arrays_text(const TesseractArrays& arrays) {
  std::string text;
  define_signatures(text);
  define_squares(text);
  define_entries(text, arrays);
  define_frames(text);
  text += "\nnamespace {\n";
  define_lists(text, arrays.lists[0], "Barycentric");
  define_lists(text, arrays.lists[1], "Compact");
  define_regions(text, arrays.regions[0], "Barycentric");
  define_regions(text, arrays.regions[1], "Compact");
  define_regions(text, arrays.regions[2], "CapsBarycentric");
  define_regions(text, arrays.regions[3], "CapsCompact");
  text += R"(
}  // namespace

const ResolvedCubes& ResolvedCubes::instance(Triangulation triangulation) noexcept {
  return triangulation == Triangulation::barycentric ? kCubesBarycentric : kCubesCompact;
}

const CubeRegions& CubeRegions::instance(Triangulation triangulation) noexcept {
  return triangulation == Triangulation::barycentric ? kRegionsOfBarycentric : kRegionsOfCompact;
}

const CubeRegions& CubeRegions::of_caps(Triangulation triangulation) noexcept {
  return triangulation == Triangulation::barycentric ? kRegionsOfCapsBarycentric : kRegionsOfCapsCompact;
}
)";
  return text;
}

}  // namespace tegl::gen
