// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of squares and cubes, their certificate, and their text.
#include "builders/cube_facets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "base/error.hpp"
#include "builders/square_contours.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::gen {

namespace {

/// A segment by its ends: edges of the cube, or CubeLists::kCubeEdges + the index of a point inside.
using Ends = std::array<std::uint8_t, 2>;

/// Edge 2 a + side of a square, as a face, for its number in the tables.
std::uint8_t face_of_edge(unsigned edge) { return static_cast<std::uint8_t>(edge ^ 2u); }

/// A segment of Sigma in a square of the cube, with the incidence number of the square.
struct SigmaSegment {
  FacetBound bound;
  Ends ends;
};

/// Sigma of a list, by square and number.
std::vector<SigmaSegment> sigma_of(const CubeLists::List& list) {
  std::vector<SigmaSegment> result;
  for (unsigned q = 0; q < 6; ++q) {
    const auto facets = square_facets(detail::face_signature(3, list.signature, q), (list.high_squares >> q & 1u) != 0);
    const int sign = detail::face_sign(q);
    for (std::size_t number = 0; number < facets.size(); ++number) {
      Ends ends{};
      for (const FacetBound& point : facets[number].bounds)
        ends[point.sign * sign > 0 ? 1 : 0] = static_cast<std::uint8_t>(detail::lifted_edge(3, q, point.face ^ 2u));
      result.push_back(
          {{static_cast<std::uint8_t>(q), static_cast<std::uint8_t>(number), static_cast<std::int8_t>(sign)}, ends});
    }
  }
  return result;
}

/// Numbers of the segments of the cycle that contains `first`, head to tail, starting with it.
std::vector<std::size_t> cycle(const std::vector<SigmaSegment>& sigma, std::size_t first) {
  std::vector<std::size_t> result;
  std::size_t at = first;
  do {
    result.push_back(at);
    at = static_cast<std::size_t>(
        std::find_if(sigma.begin(), sigma.end(), [&](const auto& s) { return s.ends[0] == sigma[at].ends[1]; }) -
        sigma.begin());
  } while (at != first && at != sigma.size() && result.size() <= sigma.size());
  return result;
}

/// Number of the list's part that contains the vertex on an edge.
unsigned part_with(const CubeLists& lists, const CubeLists::List& list, unsigned edge) {
  unsigned part = 0;
  while ((lists.parts[list.first_part + part].vertices >> lifted_vertex(0, edge) & 1u) == 0) ++part;
  return part;
}

/// Adds a triangle of a tunnel. Each of its sides is a segment of Sigma, or one inside the cube.
void add_triangle(std::span<const std::uint8_t> triangle, std::uint8_t part, const std::vector<SigmaSegment>& sigma,
                  CubeFacets& result) {
  std::array<std::uint8_t, 3> corners{};
  for (std::size_t j = 0; j < 3; ++j) {
    corners[j] = triangle[j];
    if (triangle[j] < CubeLists::kCubeEdges) continue;
    const auto own = static_cast<std::uint8_t>(triangle[j] - CubeLists::kCubeEdges);
    auto at = std::find(result.points.begin(), result.points.end(), own);
    if (at == result.points.end()) at = result.points.insert(at, own);
    corners[j] = static_cast<std::uint8_t>(CubeLists::kCubeEdges + (at - result.points.begin()));
  }
  FaceFacet& facet = result.facets.emplace_back();
  facet.part = part;
  for (std::size_t j = 0; j < 3; ++j) {
    const std::uint8_t from = corners[j], to = corners[(j + 1) % 3];
    const auto on = std::find_if(sigma.begin(), sigma.end(), [&](const auto& s) { return s.ends == Ends{from, to}; });
    if (on != sigma.end()) {
      facet.bounds.push_back(on->bound);
      continue;
    }
    const Ends ends{std::min(from, to), std::max(from, to)};
    auto at = std::find(result.segments.begin(), result.segments.end(), ends);
    if (at == result.segments.end()) at = result.segments.insert(at, ends);
    facet.bounds.push_back({CubeFacets::kInside, static_cast<std::uint8_t>(at - result.segments.begin()),
                            static_cast<std::int8_t>(from < to ? 1 : -1)});
  }
}

CubeFacets facets_of(const CubeLists& lists, std::size_t number) {
  const CubeLists::List& list = lists.lists[number];
  const std::vector<SigmaSegment> sigma = sigma_of(list);
  // the cycles of Sigma, by part
  std::vector<std::vector<std::size_t>> cycles;
  std::array<unsigned, CubeLists::kMostParts> cycles_of_part{}, done{};
  std::vector<bool> is_used(sigma.size());
  for (std::size_t first = 0; first < sigma.size(); ++first) {
    if (is_used[first]) continue;
    cycles.push_back(cycle(sigma, first));
    for (const std::size_t at : cycles.back()) is_used[at] = true;
    ++cycles_of_part[part_with(lists, list, sigma[first].ends[0])];
  }
  // one cycle: a polygon; several: the triangles of a tunnel
  CubeFacets result;
  const std::span<const std::uint8_t> triangles = lists.triangles_of(number);
  for (const auto& segments : cycles) {
    const unsigned part = part_with(lists, list, sigma[segments[0]].ends[0]);
    if (cycles_of_part[part] == 1) {
      FaceFacet& facet = result.facets.emplace_back();
      facet.part = static_cast<std::uint8_t>(part);
      for (const std::size_t at : segments) facet.bounds.push_back(sigma[at].bound);
    } else if (done[part]++ == 0) {
      const std::uint64_t vertices = lists.parts[list.first_part + part].vertices;
      for (std::size_t t = 0; t < triangles.size(); t += 3)
        if ((vertices >> lifted_vertex(0, triangles[t]) & 1u) != 0)
          add_triangle(triangles.subspan(t, 3), static_cast<std::uint8_t>(part), sigma, result);
    }
  }
  return result;
}

/// Points, segments and triangles of a part of a list.
int euler_of_triangles(std::span<const std::uint8_t> triangles, std::uint64_t part) {
  std::set<std::uint8_t> vertices;
  std::set<std::pair<std::uint8_t, std::uint8_t>> edges;
  int count = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    if ((part >> lifted_vertex(0, triangles[t]) & 1u) == 0) continue;
    ++count;
    for (std::size_t i = 0; i < 3; ++i) {
      vertices.insert(triangles[t + i]);
      edges.insert(std::minmax(triangles[t + i], triangles[t + (i + 1) % 3]));
    }
  }
  return static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) + count;
}

/// What is wrong with the facets of a list; null if nothing is.
const char* fault_of(const CubeLists& lists, std::size_t number, const CubeFacets& facets) {
  const CubeLists::List& list = lists.lists[number];
  if (list.choice == 0 && !facets.segments.empty()) return "a tunnel, although no centre joins";
  // ends and uses of each segment
  std::map<std::pair<std::uint8_t, std::uint8_t>, Ends> ends;
  for (const SigmaSegment& s : sigma_of(list)) ends[{s.bound.face, s.bound.number}] = s.ends;
  for (std::size_t i = 0; i < facets.segments.size(); ++i)
    ends[{CubeFacets::kInside, static_cast<std::uint8_t>(i)}] = facets.segments[i];
  std::map<std::pair<std::uint8_t, std::uint8_t>, std::array<int, 2>> uses;  // along and against its ends
  struct Figures {
    std::uint64_t points = 0;
    std::set<std::pair<std::uint8_t, std::uint8_t>> segments;
    int facets = 0;
  };
  std::array<Figures, CubeLists::kMostParts> figures;
  for (const FaceFacet& facet : facets.facets) {
    Figures& of_part = figures[facet.part];
    ++of_part.facets;
    for (std::size_t i = 0; i < facet.bounds.size(); ++i) {
      const FacetBound &bound = facet.bounds[i], &next = facet.bounds[(i + 1) % facet.bounds.size()];
      if (!ends.contains({bound.face, bound.number})) return "an unknown segment";
      const auto directed = [&](const FacetBound& b) {  // in a square, Sigma's ends are already those of the sum
        Ends of = ends[{b.face, b.number}];
        if (b.face == CubeFacets::kInside && b.sign < 0) std::swap(of[0], of[1]);
        return of;
      };
      if (bound.face != CubeFacets::kInside && bound.sign != detail::face_sign(bound.face)) return "a wrong sign";
      if (directed(bound)[1] != directed(next)[0]) return "an open boundary";
      for (const std::uint8_t v : directed(bound)) of_part.points |= std::uint64_t{1} << v;
      of_part.segments.insert({bound.face, bound.number});
      ++uses[{bound.face, bound.number}][bound.face == CubeFacets::kInside && bound.sign < 0 ? 1 : 0];
    }
  }
  for (const auto& [segment, of] : ends)
    if (uses[segment] != std::array<int, 2>{1, segment.first == CubeFacets::kInside ? 1 : 0})
      return "a segment that does not bound the right number of facets";
  // points and Euler characteristic of each part
  for (unsigned p = 0; p < list.part_count; ++p) {
    const std::uint64_t vertices = lists.parts[list.first_part + p].vertices;
    for (unsigned e = 0; e < CubeLists::kCubeEdges; ++e)
      if ((figures[p].points >> e & 1u) != (vertices >> lifted_vertex(0, e) & 1u)) return "other points than the list";
    const int euler =
        std::popcount(figures[p].points) - static_cast<int>(figures[p].segments.size()) + figures[p].facets;
    if (euler != euler_of_triangles(lists.triangles_of(number), vertices)) return "another Euler characteristic";
  }
  return nullptr;
}

std::string text_of(const FacetBound& bound) {
  return fmt::format("{{{}, {}, {}}}", bound.face, bound.number, bound.sign);
}

/// `const TYPE NAME[] = {...};`, one row of elements per line.
void define_rows(std::string& text, const char* declaration, const std::vector<std::string>& row_texts) {
  text += fmt::format("\nconst {}[] = {{\n", declaration);
  for (const std::string& row : row_texts)
    if (!row.empty()) text += "    " + row + "\n";
  text += "};\n";
}

/// Facets of all types of a face: the first facet of each type and the end; the first entry of each facet and the end;
/// the entries, one facet per line.
void define_facets(std::string& text, const char* name, const std::vector<const std::vector<FaceFacet>*>& types) {
  std::vector<std::string> first_facet, first_entry, entries;
  std::size_t facet = 0, entry = 0;
  const auto add_number = [](std::vector<std::string>& to, std::size_t number) {
    if (to.empty() || to.back().size() > 108) to.emplace_back();
    to.back() += fmt::format("{}{},", to.back().empty() ? "" : " ", number);
  };
  for (const auto* facets : types) {
    add_number(first_facet, facet);
    for (const FaceFacet& of : *facets) {
      add_number(first_entry, entry);
      std::string& line = entries.emplace_back();
      for (const FacetBound& bound : of.bounds) line += (line.empty() ? "" : " ") + text_of(bound) + ",";
      entry += of.bounds.size();
    }
    facet += facets->size();
  }
  add_number(first_facet, facet);
  add_number(first_entry, entry);
  define_rows(text, fmt::format("std::uint16_t kFirstFacetOf{}", name).c_str(), first_facet);
  define_rows(text, fmt::format("std::uint32_t kFirstEntryOf{}", name).c_str(), first_entry);
  define_rows(text, fmt::format("FacetEntry kEntriesOf{}", name).c_str(), entries);
}

}  // namespace

std::vector<FaceFacet> square_facets(unsigned signature, bool centre_high) {
  std::vector<FaceFacet> facets;
  for (const auto& [from, to] : square_segments(signature, centre_high))
    facets.push_back({{{face_of_edge(from), 0, -1}, {face_of_edge(to), 0, 1}}});
  // by the lowest face with an end
  std::sort(facets.begin(), facets.end(), [](const FaceFacet& a, const FaceFacet& b) {
    return std::min(a.bounds[0].face, a.bounds[1].face) < std::min(b.bounds[0].face, b.bounds[1].face);
  });
  return facets;
}

std::vector<CubeFacets> make_cube_facets(const CubeLists& lists) {
  std::vector<CubeFacets> facets;
  for (std::size_t i = 0; i < lists.lists.size(); ++i) facets.push_back(facets_of(lists, i));
  certify_cube_facets(lists, facets);
  return facets;
}

void certify_cube_facets(const CubeLists& lists, const std::vector<CubeFacets>& facets) {
  for (std::size_t i = 0; i < lists.lists.size(); ++i)
    if (const char* fault = fault_of(lists, i, facets[i]); fault != nullptr)
      throw Error(ErrorCode::CertificateFailed,
                  fmt::format("facets of the cube, signature {}, high squares {:#x}, choice {}: {}",
                              lists.lists[i].signature, lists.lists[i].high_squares, lists.lists[i].choice, fault));
}

unsigned square_of_cube(unsigned f, unsigned q) {
  // the two axes that the square does not span, and its sides there
  unsigned c = f / 2, d = detail::lifted_axis(f, q / 2), side_c = f % 2, side_d = q % 2;
  if (c > d) std::swap(c, d), std::swap(side_c, side_d);
  unsigned pair = 0;  // (0, 1), (0, 2), (0, 3), (1, 2), ...
  for (unsigned a = 0; a < c; ++a) pair += 3 - a;
  return 4 * (pair + d - c - 1) + side_c + 2 * side_d;
}

std::string facet_arrays_text(const std::vector<CubeFacets>& facets) {
  std::string text;
  std::vector<std::vector<FaceFacet>> squares;
  for (unsigned type = 0; type < 32; ++type) squares.push_back(square_facets(type % 16, type >= 16));
  std::vector<const std::vector<FaceFacet>*> types;
  for (const auto& of : squares) types.push_back(&of);
  define_facets(text, "Squares", types);
  types.clear();
  const std::vector<FaceFacet> none;  // of a cube without a contour
  for (const CubeFacets& of : facets) types.push_back(&of.facets);
  types.push_back(&none);
  define_facets(text, "Cubes", types);
  // parts of facets, points and segments inside, by list
  std::vector<std::string> parts, first_inside, points, segments;
  std::size_t point = 0, segment = 0;
  for (const CubeFacets& of : facets) {
    std::string &part_row = parts.emplace_back(), &point_row = points.emplace_back(), &row = segments.emplace_back();
    for (const FaceFacet& facet : of.facets) part_row += fmt::format("{},", facet.part);
    for (const std::uint8_t own : of.points) point_row += fmt::format("{},", own);
    for (const auto& [from, to] : of.segments) row += fmt::format("{{{}, {}}},", from, to);
    first_inside.push_back(fmt::format("{{{}, {}}},", point, segment));
    point += of.points.size();
    segment += of.segments.size();
  }
  first_inside.insert(first_inside.end(), 2, fmt::format("{{{}, {}}},", point, segment));  // kNone, and the end
  define_rows(text, "std::uint8_t kParts", parts);
  define_rows(text, "FirstInside kFirstInside", first_inside);
  define_rows(text, "std::uint8_t kPoints", points);
  define_rows(text, "std::array<std::uint8_t, 2> kSegments", segments);
  return text;
}

}  // namespace tegl::gen
