// SPDX-License-Identifier: BSD-3-Clause
//
// Compares emitted builders of the square and the cube, as compiled, with tile::FacetBuilder and with the definition.
// Templates, because each builder, and each copy with a fault, has types of its own.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../definition_oracle.hpp"
#include "base/lattice.hpp"
#include "tegl/generated/tables.hpp"
#include "tegl/tile/certificate.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl::test {

using tile::Choice;

/// A facet of a contour of an n-tile: simplices by local vertices. Edge points come first; other vertices follow.
template <std::size_t N>
using LocalFacet = std::vector<std::array<std::uint8_t, N>>;

/// V - E + F, or V - E for segments, and the set of edge points.
template <std::size_t N>
std::pair<int, std::uint32_t> figures_of(const LocalFacet<N>& facet, std::uint32_t edges) {
  std::set<std::uint8_t> vertices;
  std::set<std::pair<std::uint8_t, std::uint8_t>> sides;
  std::uint32_t points = 0;
  for (const auto& simplex : facet)
    for (std::size_t i = 0; i < N; ++i) {
      vertices.insert(simplex[i]);
      if (simplex[i] < edges) points |= 1u << simplex[i];
      if (i + 1 < N || N > 2) sides.insert(std::minmax(simplex[i], simplex[(i + 1) % N]));
    }
  const int triangles = N > 2 ? static_cast<int>(facet.size()) : 0;
  return {static_cast<int>(vertices.size()) - static_cast<int>(sides.size()) + triangles, points};
}

/// Builds tiles by tile::FacetBuilder and replaces their facets.
template <std::size_t N>
class GeneralTile {
 public:
  /// `is_high`: the centre of each square, by number. `centre`: of the cube.
  template <class IsHigh>
  void build(unsigned signature, const IsHigh& is_high, Choice centre) {
    std::vector<Choice> choices(lattice_.faces().size(), Choice::separate);
    if constexpr (N == 2) {
      choices.back() = is_high(0) ? Choice::high : Choice::low;
    } else {
      for (std::uint32_t q = 0; q < cube().faces.size(); ++q)
        choices[lattice_.find(cube().faces[q].corners()).value()] = is_high(q) ? Choice::high : Choice::low;
      choices.back() = centre;
    }
    tile_ = builder_.build(signature, {choices, tile::Alternative::low}, tile::Geometry::without);
  }

  /// Figures of each facet, ascending.
  [[nodiscard]] std::multiset<std::pair<int, std::uint32_t>> figures() const {
    std::vector<std::uint8_t> number(tile_.vertices.size());
    for (std::size_t v = 0; v < number.size(); ++v) {
      number[v] = static_cast<std::uint8_t>(edges() + v);
      for (std::uint8_t e = 0; e < edges(); ++e)
        if (is_point_of(v, e)) number[v] = e;
    }
    std::multiset<std::pair<int, std::uint32_t>> result;
    for (const tile::Facet& facet : tile_.facets) {
      LocalFacet<N> local;
      for (const tile::Simplex& simplex : facet.simplices)
        for (std::size_t i = 0, at = (local.emplace_back(), 0); i < N; ++i, at = i)
          local.back()[at] = number[simplex[i]];
      result.insert(figures_of<N>(local, edges()));
    }
    return result;
  }

  /// Certifies the tile with these facets instead.
  [[nodiscard]] tile::Fault certify(const std::vector<LocalFacet<N>>& facets) {
    std::vector<tile::VertexId> id(256, tile::kNoVertex);
    for (tile::VertexId v = 0; v < tile_.vertices.size(); ++v)
      for (std::uint8_t e = 0; e < edges(); ++e)
        if (is_point_of(v, e)) id[e] = v;
    tile::TileFacets replaced = tile_;
    replaced.facets.clear();
    for (const LocalFacet<N>& facet : facets)
      for (std::size_t s = 0, f = (replaced.facets.emplace_back(), 0); s < facet.size(); ++s, f = s) {
        tile::Simplex& simplex = replaced.facets.back().simplices.emplace_back(tile::kNoSimplex);
        for (std::size_t i = 0; i < N; ++i) {
          tile::VertexId& v = id[facet[f][i]];
          if (v == tile::kNoVertex) {
            if (facet[f][i] < edges()) return tile::Fault::sigma;  // a point on an edge that the contour does not cross
            v = static_cast<tile::VertexId>(replaced.vertices.size());
            replaced.vertices.push_back({tile::VertexKind::side, lattice_.tile(), 100u + v, tile::kNoVertex, {}});
          }
          simplex[i] = v;
        }
      }
    return certifier_.certify(lattice_, replaced);
  }

 private:
  [[nodiscard]] const gen::Tile& cube() const { return tiles_.tile(N); }
  [[nodiscard]] std::uint32_t edges() const { return cube().edge_count(); }
  [[nodiscard]] bool is_point_of(std::size_t vertex, std::uint8_t e) const {
    const auto& [a, b] = cube().edges[e];
    return tile_.vertices[vertex].kind == tile::VertexKind::edge &&
           lattice_.faces()[tile_.vertices[vertex].face].corners == (tile::Signature{1} << a | tile::Signature{1} << b);
  }

  tile::FaceLattice lattice_ = tile::FaceLattice::cube(static_cast<int>(N));
  gen::CubeLattice tiles_{static_cast<int>(N)};
  tile::FacetBuilder builder_{lattice_};
  tile::Certifier certifier_;
  tile::TileFacets tile_;
};

/// Facets of an emitted square's contour: one per segment.
template <class Contour>
std::vector<LocalFacet<2>> facets_of_square(const Contour& contour) {
  std::vector<LocalFacet<2>> facets;
  for (unsigned i = 0; i < contour.count; ++i) facets.push_back({{contour.segments[i][0], contour.segments[i][1]}});
  return facets;
}

/// Facets of an emitted cube's contour.
template <class Contour>
std::vector<LocalFacet<3>> facets_of_cube(const Contour& contour) {
  std::vector<LocalFacet<3>> facets;
  for (unsigned f = 0, t = 0; f < contour.facets; ++f)
    for (facets.emplace_back(); t < contour.facet_end[f]; ++t)
      facets.back().push_back({contour.vertices[t][0], contour.vertices[t][1], contour.vertices[t][2]});
  return facets;
}

/// Calls `visit(signature, high_squares)` for every resolution of the ambiguous squares of every cube.
template <class Visit>
void for_each_cube(const Visit& visit) {
  const gen::CubeLattice tiles(3);
  for (unsigned signature = 0; signature < 256; ++signature) {
    unsigned ambiguous = 0, high = 0;
    for (std::uint32_t q = 0; q < 6; ++q) {
      const tile::Signature square = tiles.tile(3).restrict_to(q, signature);
      if (square == 6 || square == 9) ambiguous |= 1u << q;
    }
    do {
      visit(signature, high);
      high = (high - ambiguous) & ambiguous;
    } while (high != 0);
  }
}

/// The facets by definition: their Euler characteristics. If the centre is low, they are copies of the components of
/// the high part of the boundary; if it is high, of the low part. Separate polygons are discs, one less than there are
/// components of both parts.
template <std::size_t N, class HasCentre>
std::multiset<long> eulers_by_definition(unsigned signature, const HasCentre& is_high, Choice centre) {
  const unsigned all = (1u << (1u << N)) - 1;
  const BoundaryPart high(N, signature, is_high);
  const BoundaryPart low(N, ~signature & all, [&](unsigned base, unsigned axes) { return !is_high(base, axes); });
  std::multiset<long> eulers;
  if (signature == 0 || signature == all) return eulers;
  const BoundaryPart& copied = centre == Choice::high ? low : high;
  if (centre == Choice::separate)
    for (std::size_t i = 1; i < high.components() + low.components(); ++i) eulers.insert(1);
  else
    for (std::size_t c = 0; c < copied.components(); ++c) eulers.insert(copied.euler(c));
  return eulers;
}

/// What is wrong with a builder of squares, for the first square where anything is; "" if nothing is.
/// `build(signature, centre_high)` returns its contour.
template <class Build>
std::string fault_of_squares(const Build& build) {
  GeneralTile<2> general;
  for (unsigned signature = 0; signature < 16; ++signature)
    for (const bool high : {false, true}) {
      const auto facets = facets_of_square(build(signature, high));
      general.build(
          signature, [high](unsigned) { return high; }, Choice::separate);
      const std::string at = fmt::format("signature {}, centre {}: ", signature, high ? "high" : "low");
      std::multiset<std::pair<int, std::uint32_t>> figures;
      std::multiset<long> eulers;
      for (const LocalFacet<2>& facet : facets) {
        figures.insert(figures_of<2>(facet, 4));
        eulers.insert(figures_of<2>(facet, 4).first);
      }
      if (figures != general.figures()) return at + "segments differ from the general builder's";
      const Choice centre = high ? Choice::high : Choice::low;
      if (eulers != eulers_by_definition<2>(
                        signature, [](unsigned, unsigned) { return false; }, centre))
        return at + "segments differ from the definition";
      if (const tile::Fault fault = general.certify(facets); fault != tile::Fault::none)
        return at + std::string(tile::name_of(fault));
    }
  return "";
}

/// Whether a contour of a cube has the triangles and masks of a list of the table.
template <class Contour>
bool is_list_of_table(const Contour& contour, const tables::ResolvedList& list) {
  const tables::ResolvedTable& table = tables::kTile3Resolved;
  return contour.triangles == list.triangle_count && contour.own_vertices == list.own_vertices &&
         std::equal(contour.vertices[0], contour.vertices[0] + 3 * contour.triangles,
                    table.triangles + 3 * std::size_t{list.first_triangle}) &&
         std::equal(contour.masks, contour.masks + contour.own_vertices, table.masks + list.first_mask);
}

/// Whether each facet of one polygon is a triangle or a cone over its polygon, from its barycentre or, for two hexagons,
/// from a vertex on a ray; with the contract's mask.
template <class Contour>
bool is_coned(const Contour& contour) {
  constexpr std::uint32_t kBarycentre = 1u << 20;
  for (const LocalFacet<3>& facet : facets_of_cube(contour)) {
    const auto [euler, points] = figures_of<3>(facet, 12);
    if (euler != 1 || facet.size() == 1) continue;
    for (const auto& t : facet) {
      const auto apex = *std::max_element(t.begin(), t.end());
      if (apex < 12 || std::find(facet[0].begin(), facet[0].end(), apex) == facet[0].end()) return false;
      const std::uint32_t mask = contour.masks[apex - 12];
      const bool is_on_ray = facet.size() == 6 && mask != 0 && mask < 256;
      if (is_on_ray ? false : t[0] != apex || mask != (kBarycentre | points << 8)) return false;
    }
  }
  return true;
}

/// What is wrong with a builder of cubes, for the first cube where anything is; "" if nothing is.
/// `build(signature, high_squares, centre)` returns its contour. `has_right_triangles(contour, list)` compares its
/// triangles with the list of the table.
template <class Build, class Triangles>
std::string fault_of_cubes(const Build& build, const Triangles& has_right_triangles) {
  GeneralTile<3> general;
  std::string fault;
  std::uint32_t number = 0;
  for_each_cube([&](unsigned signature, unsigned high) {
    const tables::ResolvedEntry& entry = tables::kTile3Resolved.entries[number++];
    if (!fault.empty()) return;
    for (const Choice centre : {Choice::separate, Choice::low, Choice::high}) {
      const auto contour = build(signature, high, centre);
      const auto facets = facets_of_cube(contour);
      const std::string at =
          fmt::format("signature {}, high squares {:#x}, choice {}: ", signature, high, static_cast<int>(centre));
      general.build(
          signature, [high](unsigned q) { return (high >> q & 1u) != 0; }, centre);
      std::multiset<std::pair<int, std::uint32_t>> figures;
      std::multiset<long> eulers;
      std::set<std::uint8_t> own;
      for (const LocalFacet<3>& facet : facets) {
        figures.insert(figures_of<3>(facet, 12));
        eulers.insert(figures_of<3>(facet, 12).first);
        for (const auto& t : facet)
          for (const std::uint8_t v : t)
            if (v >= 12) own.insert(v);
      }
      if (figures != general.figures())
        fault = at + "facets differ from the general builder's";
      else if (eulers != eulers_by_definition<3>(
                             signature,
                             [high](unsigned base, unsigned axes) {
                               const unsigned axis = (axes & 1u) == 0 ? 0 : (axes & 2u) == 0 ? 1 : 2;
                               return (high >> (2 * axis + (base >> axis & 1u)) & 1u) != 0;
                             },
                             centre))
        fault = at + "facets differ from the definition";
      else if (own.size() != contour.own_vertices || (!own.empty() && *own.rbegin() != 11 + own.size()))
        fault = at + "own vertices are not those of the triangles";
      else if (contour.triangles != (contour.facets == 0 ? 0 : contour.facet_end[contour.facets - 1]))
        fault = at + "number of triangles";
      else if (const tile::Fault of_certificate = general.certify(facets); of_certificate != tile::Fault::none)
        fault = at + std::string(tile::name_of(of_certificate));
      else if (!has_right_triangles(contour, centre == Choice::separate ? entry.separate
                                             : centre == Choice::low    ? entry.low
                                                                        : entry.high))
        fault = at + "other triangles";
      if (!fault.empty()) return;
    }
  });
  return fault;
}

/// In the compact triangulation, with the triangles of the table.
template <class Build>
std::string fault_of_cubes(const Build& build) {
  return fault_of_cubes(
      build, [](const auto& contour, const tables::ResolvedList& list) { return is_list_of_table(contour, list); });
}

/// In the barycentric triangulation.
template <class Build>
std::string fault_of_barycentric_cubes(const Build& build) {
  return fault_of_cubes(build, [](const auto& contour, const tables::ResolvedList&) { return is_coned(contour); });
}

}  // namespace tegl::test
