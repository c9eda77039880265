// SPDX-License-Identifier: BSD-3-Clause
//
// The cube by recursion over its squares.
#include "builders/cube_rule.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/lattice.hpp"
#include "builders/square_contours.hpp"
#include "tegl/tile/certificate.hpp"

namespace tegl::gen {

namespace {

using tile::Choice;

constexpr std::uint8_t kEdges = 12;
constexpr Choice kChoices[] = {Choice::separate, Choice::low, Choice::high};

const Tile& cube() {
  static const CubeLattice tiles(3);
  return tiles.tile(3);
}

/// Corners connected with `corner` on the cube's boundary: by edges, and across squares whose centre is on their side.
unsigned region_of(unsigned corner, unsigned inside, unsigned inside_centres) {
  unsigned reached = 1u << corner, before = 0;
  while (reached != std::exchange(before, reached)) {
    for (const auto& [a, b] : cube().edges)
      if ((inside >> a & inside >> b & (reached >> a | reached >> b) & 1u) != 0) reached |= 1u << a | 1u << b;
    for (std::size_t q = 0; q < 6; ++q) {
      const auto corners = static_cast<unsigned>(cube().faces[q].corners());
      if ((inside_centres >> q & 1u) != 0 && (reached & corners) != 0) reached |= inside & corners;
    }
  }
  return reached;
}

const tables::ResolvedList& list_of(const tables::ResolvedEntry& entry, Choice choice) {
  return choice == Choice::separate ? entry.separate : choice == Choice::low ? entry.low : entry.high;
}

/// A polygon coned from its barycentre, or its only triangle.
CubeFilling cone_over(const CubePolygon& polygon) {
  if (polygon.size() == 3) return {{{polygon[0], polygon[1], polygon[2]}}, {}};
  CubeFilling cone;
  cone.masks = {std::uint32_t{1} << kBarycentreBit};
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    cone.triangles.push_back({kEdges, polygon[i], polygon[(i + 1) % polygon.size()]});
    cone.masks[0] |= std::uint32_t{1} << (8 + polygon[i]);
  }
  return cone;
}

/// The set of a facet's edges, by its polygons and by its triangles.
unsigned edges_of(const std::vector<CubePolygon>& polygons) {
  unsigned edges = 0;
  for (const CubePolygon& polygon : polygons)
    for (const std::uint8_t e : polygon) edges |= 1u << e;
  return edges;
}

unsigned edges_of(const CubeFilling& filling) {
  unsigned edges = 0;
  for (const CubeTriangle& t : filling.triangles)
    for (const std::uint8_t v : t)
      if (v < kEdges) edges |= 1u << v;
  return edges;
}

Squares squares_kind(unsigned ambiguous, unsigned high, const std::vector<CubePolygon>& polygons, std::size_t facets) {
  if ((high & ambiguous) == 0) return kNoneHigh;
  if ((high & ambiguous) == ambiguous) return kAllHigh;
  return facets == 2 && polygons[0].size() == 6 && polygons[1].size() == 6 ? kHexagons : kMixed;
}

[[noreturn]] void fail(unsigned signature, unsigned high, const char* why) {
  throw Error(ErrorCode::CertificateFailed,
              fmt::format("builder of the cube, signature {}, high squares {:#x}: {}", signature, high, why));
}

}  // namespace

std::vector<CubePolygon> cube_polygons(unsigned signature, unsigned high_squares) {
  std::array<std::uint8_t, kEdges> next{};
  next.fill(kEdges);
  std::vector<std::uint8_t> starts;
  for (const std::uint8_t q : kSquareOrder) {
    const SubTile& square = cube().faces[q];
    const auto in_square = static_cast<unsigned>(cube().restrict_to(q, signature));
    for (auto [from, to] : square_segments(in_square, (high_squares >> q & 1u) != 0)) {
      if (square.sign < 0) std::swap(from, to);
      next[square.edge[from]] = square.edge[to];
      starts.push_back(square.edge[from]);
    }
  }
  std::vector<CubePolygon> polygons;
  for (std::uint8_t start : starts) {
    if (next[start] == kEdges) continue;
    CubePolygon& polygon = polygons.emplace_back();
    for (std::uint8_t at = start; next[at] != kEdges;) {
      polygon.push_back(at);
      at = std::exchange(next[at], kEdges);
    }
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
  }
  return polygons;
}

std::vector<std::vector<std::size_t>> cube_facets(unsigned signature, unsigned high_squares, Choice centre,
                                                  const std::vector<CubePolygon>& polygons) {
  std::vector<std::vector<std::size_t>> facets;
  std::vector<unsigned> regions;
  const unsigned inside = centre == Choice::high ? ~signature & 0xffu : signature;
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    const auto& ends = cube().edges[polygons[p][0]];
    const unsigned corner = (inside >> ends[0] & 1u) != 0 ? ends[0] : ends[1];
    const unsigned region = region_of(corner, inside, centre == Choice::high ? ~high_squares : high_squares);
    const auto same = std::find(regions.begin(), regions.end(), region);
    if (centre != Choice::separate && same != regions.end()) {
      facets[static_cast<std::size_t>(same - regions.begin())].push_back(p);
    } else {
      facets.push_back({p});
      regions.push_back(region);
    }
  }
  std::stable_partition(facets.begin(), facets.end(), [](const auto& facet) { return facet.size() == 1; });
  return facets;
}

std::uint64_t polygon_key(const std::vector<CubePolygon>& polygons) {
  std::uint64_t key = 0;
  for (const CubePolygon& polygon : polygons)
    for (std::size_t i = 0; i < polygon.size(); ++i)
      key |= (std::uint64_t{polygon[(i + 1) % polygon.size()]} + 1) << (4 * polygon[i]);
  return key;
}

std::vector<CubeFilling> fillings_of(const ResolvedCube& table, const tables::ResolvedList& list) {
  // Triangles of one facet follow each other, and have vertices in common.
  std::vector<std::uint32_t> facet_of(kEdges + list.own_vertices);
  for (std::uint32_t v = 0; v < facet_of.size(); ++v) facet_of[v] = v;
  const std::uint8_t* const triangles = table.triangles.data() + std::size_t{3} * list.first_triangle;
  for (std::size_t i = 0; i < 3u * list.triangle_count; i += 3)
    for (const std::size_t other : {i + 1, i + 2}) {
      const std::uint32_t from = facet_of[triangles[other]], to = facet_of[triangles[i]];
      std::replace(facet_of.begin(), facet_of.end(), from, to);
    }
  std::vector<CubeFilling> fillings;
  std::uint32_t current = ~0u, first_own = kEdges;
  for (std::size_t i = 0; i < 3u * list.triangle_count; i += 3) {
    if (facet_of[triangles[i]] != current) {
      if (!fillings.empty()) first_own += static_cast<std::uint32_t>(fillings.back().masks.size());
      current = facet_of[triangles[i]];
      fillings.emplace_back();
    }
    CubeTriangle& t = fillings.back().triangles.emplace_back();
    for (std::size_t j = 0; j < 3; ++j) {
      const std::uint8_t v = triangles[i + j];
      t[j] = v;
      if (v < kEdges) continue;
      t[j] = static_cast<std::uint8_t>(v - first_own + kEdges);
      std::vector<std::uint32_t>& masks = fillings.back().masks;
      masks.resize(std::max<std::size_t>(masks.size(), t[j] - kEdges + 1u));
      masks[t[j] - std::size_t{kEdges}] = table.masks[list.first_mask + v - std::size_t{kEdges}];
    }
  }
  return fillings;
}

ResolvedCube coned(const ResolvedCube& table) {
  ResolvedCube result = table;
  result.triangles.clear(), result.masks.clear();
  std::size_t number = 0;
  for_each_resolution(table, [&](unsigned signature, unsigned high, const tables::ResolvedEntry& entry) {
    tables::ResolvedEntry& changed = result.entries[number++];
    const std::vector<CubePolygon> polygons = cube_polygons(signature, high);
    for (const Choice choice : kChoices) {
      const auto facets = cube_facets(signature, high, choice, polygons);
      std::vector<CubeFilling> fillings = fillings_of(table, list_of(entry, choice));
      tables::ResolvedList list{static_cast<std::uint16_t>(result.triangles.size() / 3), 0, 0,
                                static_cast<std::uint16_t>(result.masks.size())};
      for (std::size_t f = 0; f < facets.size(); ++f) {
        const bool has_ray = std::any_of(fillings[f].masks.begin(), fillings[f].masks.end(), is_on_ray);
        if (facets[f].size() == 1 && !has_ray) fillings[f] = cone_over(polygons[facets[f][0]]);
        for (const CubeTriangle& t : fillings[f].triangles)
          for (const std::uint8_t v : t)
            result.triangles.push_back(static_cast<std::uint8_t>(v < kEdges ? v : v + list.own_vertices));
        list.triangle_count = static_cast<std::uint8_t>(list.triangle_count + fillings[f].triangles.size());
        list.own_vertices = static_cast<std::uint8_t>(list.own_vertices + fillings[f].masks.size());
        result.masks.insert(result.masks.end(), fillings[f].masks.begin(), fillings[f].masks.end());
      }
      (choice == Choice::separate ? changed.separate : choice == Choice::low ? changed.low : changed.high) = list;
    }
  });
  return result;
}

void certify_lists(const ResolvedCube& table) {
  const tile::FaceLattice lattice = tile::FaceLattice::cube(3);
  tile::FacetBuilder builder(lattice);
  tile::Certifier certifier;
  std::vector<Choice> choices(lattice.faces().size(), Choice::separate);
  std::map<Signature, std::uint8_t> edge_of;  // by its two corners
  for (std::uint8_t e = 0; e < kEdges; ++e)
    edge_of[Signature{1} << cube().edges[e][0] | Signature{1} << cube().edges[e][1]] = e;
  for_each_resolution(table, [&](unsigned signature, unsigned high, const tables::ResolvedEntry& entry) {
    for (std::size_t q = 0; q < 6; ++q)
      choices[lattice.find(cube().faces[q].corners()).value()] = (high >> q & 1u) != 0 ? Choice::high : Choice::low;
    for (const Choice choice : kChoices) {
      choices.back() = choice;
      tile::TileFacets built = builder.build(signature, {choices, tile::Alternative::low}, tile::Geometry::without);
      const std::vector<CubeFilling> fillings = fillings_of(table, list_of(entry, choice));
      if (built.facets.size() != fillings.size()) fail(signature, high, "not the facets of the general builder");
      std::vector<tile::VertexId> edge_point(kEdges, tile::kNoVertex);
      for (tile::VertexId v = 0; v < built.vertices.size(); ++v)
        if (built.vertices[v].kind == tile::VertexKind::edge)
          edge_point[edge_of.at(lattice.faces()[built.vertices[v].face].corners)] = v;
      built.facets.clear();
      for (const CubeFilling& filling : fillings) {
        std::vector<tile::VertexId> id = edge_point;
        for (std::size_t j = 0; j < filling.masks.size(); ++j) {
          id.push_back(static_cast<tile::VertexId>(built.vertices.size()));
          built.vertices.push_back({tile::VertexKind::side, lattice.tile(), id.back(), tile::kNoVertex, {}});
        }
        tile::Facet& facet = built.facets.emplace_back();
        for (const CubeTriangle& t : filling.triangles) {
          tile::Simplex& simplex = facet.simplices.emplace_back(tile::kNoSimplex);
          for (std::size_t i = 0; i < 3; ++i) simplex[i] = id[t[i]];
        }
      }
      if (const tile::Fault fault = certifier.certify(lattice, built); fault != tile::Fault::none)
        fail(signature, high, std::string(tile::name_of(fault)).c_str());
    }
  });
}

std::vector<FillingRow> make_filling_rule(const ResolvedCube& table) {
  std::vector<FillingRow> rows;
  std::map<std::pair<std::uint64_t, Squares>, std::size_t> row_of;
  for_each_resolution(table, [&](unsigned signature, unsigned high, const tables::ResolvedEntry& entry) {
    const std::vector<CubePolygon> polygons = cube_polygons(signature, high);
    if (polygons.size() != entry.components) fail(signature, high, "another number of polygons");
    for (const Choice choice : kChoices) {
      const auto facets = cube_facets(signature, high, choice, polygons);
      const Squares kind = squares_kind(table.ambiguous[signature], high, polygons, facets.size());
      const std::vector<CubeFilling> fillings = fillings_of(table, list_of(entry, choice));
      if (facets.size() != fillings.size()) fail(signature, high, "another number of facets");
      for (std::size_t f = 0; f < facets.size(); ++f) {
        std::vector<CubePolygon> around;
        for (const std::size_t p : facets[f]) around.push_back(polygons[p]);
        if (edges_of(around) != edges_of(fillings[f])) fail(signature, high, "another order of facets");
        const std::uint64_t key = polygon_key(around);
        if (const auto known = row_of.find({key, kind}); known != row_of.end()) {
          if (rows[known->second].filling != fillings[f]) fail(signature, high, "two fillings of the same polygons");
          continue;
        }
        const auto same = std::find_if(rows.begin(), rows.end(), [&](const FillingRow& row) {
          return row.key == key && row.filling == fillings[f];
        });
        row_of[{key, kind}] = static_cast<std::size_t>(same - rows.begin());
        if (same == rows.end())
          rows.push_back({key, kind, around, fillings[f]});
        else
          same->squares |= kind;
      }
    }
  });
  std::sort(rows.begin(), rows.end(), [](const FillingRow& a, const FillingRow& b) {
    return std::pair(a.key, a.squares) < std::pair(b.key, b.squares);
  });
  // A polygon with one filling has it for every resolution.
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool alone =
        (i == 0 || rows[i - 1].key != rows[i].key) && (i + 1 == rows.size() || rows[i + 1].key != rows[i].key);
    if (alone) rows[i].squares = kNoneHigh | kMixed | kAllHigh | kHexagons;
  }
  return rows;
}

}  // namespace tegl::gen
