// SPDX-License-Identifier: BSD-3-Clause
//
// Construction of the symbolic facet tables; see facet_tables.hpp.
#include "facets/facet_tables.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "ambiguity/face_estimator.hpp"
#include "base/disjoint_sets.hpp"
#include "tegl/generated/tables.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {
namespace {

constexpr Index kNoPart = ~Index{0};

/// Name of a facet of dimension d - 3 in a d-cube: the two axes and sides of its face, and its number there. `face` is
/// 2 a + side in the cube, `in_face.face` the same in the axes of that face.
unsigned name_of(unsigned face, const FacetEntry& in_face) noexcept {
  unsigned a = face / 2, b = in_face.face / 2u;
  if (b >= a) ++b;
  unsigned side_a = face % 2, side_b = in_face.face % 2u;
  if (a > b) {
    std::swap(a, b);
    std::swap(side_a, side_b);
  }
  return ((a * FacetTables::kMaxDim + b) * 4 + side_a * 2 + side_b) * 8 + in_face.number;
}
constexpr std::size_t kNames = FacetTables::kMaxDim * FacetTables::kMaxDim * 4 * 8;

/// The cube edge with this name.
unsigned edge_named(unsigned name) noexcept {
  name /= 8;
  const unsigned sides = name % 4, a = name / 4 / FacetTables::kMaxDim, b = name / 4 % FacetTables::kMaxDim;
  const unsigned along = 3 - a - b;
  return edge_number(3, along, (sides >> 1) << a | (sides & 1u) << b);
}

}  // namespace

FacetTables::FacetTables(Ambiguity ambiguity) : ambiguity_(ambiguity) {
  for (Lists& lists : lists_) lists.first_facet = lists.first_entry = {0};
  const bool estimated = is_estimated(ambiguity);
  for (unsigned dim = 1; dim < (estimated ? 2 : kMaxDim); ++dim)
    for (unsigned signature = 0; signature < 1u << (1u << dim); ++signature) add_signature(dim, signature);
  if (!estimated) return;
  for (const bool high : {false, true})
    for (unsigned signature = 0; signature < 16; ++signature) {
      add_square(signature, high);
      lists_[2].first_facet.push_back(static_cast<std::uint32_t>(lists_[2].first_entry.size() - 1));
    }
  for (unsigned list = 0; list < ResolvedCubes::instance().lists().size(); ++list) add_cube(list);
}

void FacetTables::add_tesseracts(std::span<const std::uint16_t> signatures) {
  std::vector<std::uint16_t> sorted(signatures.begin(), signatures.end());
  std::sort(sorted.begin(), sorted.end());
  Lists& lists = lists_[kMaxDim];
  lists = {{0}, {0}, {}};
  auto next = sorted.begin();
  for (unsigned signature = 0; signature < 1u << (1u << kMaxDim); ++signature) {
    if (next == sorted.end() || *next != signature) {
      lists.first_facet.push_back(lists.first_facet.back());
      continue;
    }
    add_signature(kMaxDim, signature);
    next = std::find_if(next, sorted.end(), [&](std::uint16_t s) { return s != signature; });
  }
}

void FacetTables::add_signature(unsigned dim, unsigned signature) {
  Lists& lists = lists_[dim];
  if (dim == 1) {
    if (std::popcount(signature) == 1) lists.first_entry.push_back(lists.first_entry.back());
  } else if (dim == 2) {
    add_square(signature, ambiguity_ == Ambiguity::high);
  } else {
    const FaceTypes types = face_types(dim, signature);
    std::vector<Part> all = parts(dim, types);
    join_parts(dim, types, all);
    for (std::size_t first = 0; first < all.size(); ++first) {
      if (all[first].component != first) continue;
      if (dim == 3) {
        add_loop(all, first);
        continue;
      }
      for (const Part& part : all)
        if (part.component == first) lists.entries.push_back(part.entry);
      lists.first_entry.push_back(static_cast<std::uint32_t>(lists.entries.size()));
    }
  }
  lists.first_facet.push_back(static_cast<std::uint32_t>(lists.first_entry.size() - 1));
}

std::vector<std::size_t> FacetTables::loop(const std::vector<Part>& parts, std::size_t first) {
  std::vector<std::size_t> result;
  std::size_t at = first;
  do {
    result.push_back(at);
    at = static_cast<std::size_t>(
        std::find_if(parts.begin(), parts.end(), [&](const Part& part) { return part.ends[0] == parts[at].ends[1]; }) -
        parts.begin());
  } while (at != first);
  return result;
}

/// Adds a polygon.
void FacetTables::add_loop(const std::vector<Part>& parts, std::size_t first) {
  Lists& lists = lists_[3];
  for (const std::size_t at : loop(parts, first)) lists.entries.push_back(parts[at].entry);
  lists.first_entry.push_back(static_cast<std::uint32_t>(lists.entries.size()));
}

/// A connected part of the list with one component of Sigma is a disc, and becomes a polygon. Of any other part, each
/// triangle becomes a facet.
void FacetTables::add_cube(unsigned number) {
  const ResolvedCubes& cubes = ResolvedCubes::instance();
  const CubeList& of = cubes.lists()[number];
  FaceTypes types = face_types(3, of.signature);
  for (unsigned q = 0; q < 6; ++q) types[q] = square_type(types[q], (of.high_squares >> q & 1u) != 0);
  std::vector<Part> all = parts(3, types);
  join_parts(3, types, all);

  // connected parts of the triangle list
  const std::span<const std::uint8_t> vertices = cubes.triangles_of(number);
  std::vector<Triangle> triangles(vertices.size() / 3);
  BasicDisjointSets<Index> connected;  // by vertex of the list
  connected.reset(kCubeEdges + ResolvedCubes::kMostOwn);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::uint8_t* const v = vertices.data() + 3 * t;
    triangles[t] = {v[0], v[1], v[2]};
    connected.join(v[0], v[1]);
    connected.join(v[0], v[2]);
  }
  // count the components of Sigma of each part
  std::array<unsigned, kCubeEdges + ResolvedCubes::kMostOwn> loops{}, done{};
  const auto part_of = [&](const Part& part) { return connected.find(edge_named(part.ends[0])); };
  for (std::size_t first = 0; first < all.size(); ++first)
    if (all[first].component == first) ++loops[part_of(all[first])];

  // one component: polygon; several: triangles of a tunnel
  Inside& inside = inside_.emplace_back();
  for (std::size_t first = 0; first < all.size(); ++first) {
    if (all[first].component != first || done[part_of(all[first])]++ != 0) continue;
    if (loops[part_of(all[first])] == 1) {
      add_loop(all, first);
      std::uint16_t& points = points_.emplace_back();
      for (const Part& part : all)
        if (part.component == first) points = static_cast<std::uint16_t>(points | 1u << edge_named(part.ends[0]));
      continue;
    }
    inside.joins =
        cubes.list(of.signature, of.high_squares, tile::Choice::low) == number ? tile::Choice::low : tile::Choice::high;
    for (const Triangle& triangle : triangles)
      if (connected.find(triangle[0]) == part_of(all[first])) add_triangle(triangle, all, inside);
  }
  lists_[3].first_facet.push_back(static_cast<std::uint32_t>(lists_[3].first_entry.size() - 1));
}

/// Adds a triangle of a tunnel. Each of its sides is a part of Sigma, or a segment inside the cube.
void FacetTables::add_triangle(const Triangle& triangle, const std::vector<Part>& parts, Inside& inside) {
  Lists& lists = lists_[3];
  std::array<std::uint8_t, 3> corners{};
  std::uint16_t& points = points_.emplace_back();
  // number its points; new ones inside are added
  for (std::size_t j = 0; j < 3; ++j) {
    corners[j] = triangle[j];
    if (triangle[j] >= kCubeEdges) {
      const auto own = static_cast<std::uint8_t>(triangle[j] - kCubeEdges);
      auto at = std::find(inside.points.begin(), inside.points.end(), own);
      if (at == inside.points.end()) at = inside.points.insert(at, own);
      corners[j] = static_cast<std::uint8_t>(kCubeEdges + (at - inside.points.begin()));
    }
    points = static_cast<std::uint16_t>(points | 1u << corners[j]);
  }
  // its sides
  for (std::size_t j = 0; j < 3; ++j) {
    const std::uint8_t from = corners[j], to = corners[(j + 1) % 3];
    const auto part = std::find_if(parts.begin(), parts.end(), [&](const Part& p) {
      return edge_named(p.ends[0]) == from && edge_named(p.ends[1]) == to;
    });
    if (part != parts.end()) {
      lists.entries.push_back(part->entry);
      continue;
    }
    const std::array<std::uint8_t, 2> ends{std::min(from, to), std::max(from, to)};
    auto at = std::find(inside.segments.begin(), inside.segments.end(), ends);
    if (at == inside.segments.end()) at = inside.segments.insert(at, ends);
    lists.entries.push_back({kInside, static_cast<std::uint8_t>(at - inside.segments.begin()),
                             static_cast<std::int8_t>(from < to ? 1 : -1)});
  }
  lists.first_entry.push_back(static_cast<std::uint32_t>(lists.entries.size()));
}

void FacetTables::add_square(unsigned signature, bool high) {
  std::array<FacetEntry, 4> points{};
  unsigned count = 0;
  for (unsigned face = 0; face < 4; ++face) {
    const unsigned ends = face_signature(2, signature, face);
    if (std::popcount(ends) != 1) continue;
    const int rising = ends == 2 ? 1 : -1;
    points[count++] = {static_cast<std::uint8_t>(face), 0, static_cast<std::int8_t>(rising * face_sign(face))};
  }
  Lists& lists = lists_[2];
  const auto add = [&](const FacetEntry& a, const FacetEntry& b) {
    lists.entries.push_back(a.sign < 0 ? a : b);
    lists.entries.push_back(a.sign < 0 ? b : a);
    lists.first_entry.push_back(static_cast<std::uint32_t>(lists.entries.size()));
  };
  if (count == 2) add(points[0], points[1]);
  if (count != 4) return;
  // Faces 0 and 1 are at x = 0 and 1, faces 2 and 3 at y = 0 and 1. The segments cut off corners 0 and 3, or 1 and 2.
  const bool diagonal_is_high = signature == 0b1001;
  if (diagonal_is_high != high) {
    add(points[0], points[2]);
    add(points[1], points[3]);
  } else {
    add(points[0], points[3]);
    add(points[1], points[2]);
  }
}

FacetTables::FaceTypes FacetTables::face_types(unsigned dim, unsigned signature) noexcept {
  FaceTypes types{};
  for (unsigned face = 0; face < 2 * dim; ++face) types[face] = face_signature(dim, signature, face);
  return types;
}

std::vector<FacetTables::Part> FacetTables::parts(unsigned dim, const FaceTypes& types) const {
  std::vector<Part> result;
  for (unsigned face = 0; face < 2 * dim; ++face) {
    for (unsigned number = 0; number < count(dim - 1, types[face]); ++number)
      result.push_back({{static_cast<std::uint8_t>(face), static_cast<std::uint8_t>(number),
                         static_cast<std::int8_t>(face_sign(face))},
                        result.size()});
  }
  return result;
}

/// Connects the parts that share a facet of the next lower dimension.
void FacetTables::join_parts(unsigned dim, const FaceTypes& types, std::vector<Part>& parts) const {
  std::vector<Index> first_with(kNames, kNoPart);
  DisjointSets components;
  components.reset(parts.size());
  for (Index i = 0; i < parts.size(); ++i) {
    const FacetEntry& part = parts[i].entry;
    for (const FacetEntry& shared : entries(dim - 1, types[part.face], part.number)) {
      const unsigned name = name_of(part.face, shared);
      if (dim == 3) parts[i].ends[shared.sign * part.sign > 0 ? 1 : 0] = name;
      if (first_with[name] == kNoPart) first_with[name] = i;
      components.join(first_with[name], i);
    }
  }
  for (Index i = 0; i < parts.size(); ++i) parts[i].component = components.find(i);
}

}  // namespace tegl::detail
