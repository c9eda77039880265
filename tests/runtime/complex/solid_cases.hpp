// SPDX-License-Identifier: BSD-3-Clause
//
// Single 4D polytopes, prisms over polyhedra among them, against the general engine.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "ambiguity/face_estimator.hpp"
#include "polytope/polytopes.hpp"
#include "prisms/solid_cell.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl::test {

/// A vertex as the crossed edges around it: its own, or those whose barycentre it is.
using Around = std::set<std::array<unsigned, 2>>;
/// A tetrahedron by its sorted vertices; the last entry is 1 for an odd order.
using Named = std::pair<std::array<Around, 4>, int>;

inline Named named(std::array<Around, 4> t, bool flip) {
  const int sign = tile::sort_vertices(t) * (flip ? -1 : 1);
  return {t, sign < 0 ? 1 : 0};
}

/// Tetrahedra by numbers of their vertices, and how they are called.
struct CellContourOf {
  std::vector<std::array<std::size_t, 4>> tetrahedra = {};
  std::map<std::size_t, Around> around = {};
  bool has_sides = false, has_cones = false;

  [[nodiscard]] std::multiset<Named> named_tetrahedra(bool flip) const {
    std::multiset<Named> result;
    for (const auto& t : tetrahedra)
      result.insert(named({around.at(t[0]), around.at(t[1]), around.at(t[2]), around.at(t[3])}, flip));
    return result;
  }
  /// The triangles of one tetrahedron only, oriented, and their signs. Expects that each other one is in two, with
  /// opposite signs.
  [[nodiscard]] std::map<std::array<std::size_t, 3>, int> open_triangles() const {
    std::map<std::array<std::size_t, 3>, std::pair<int, int>> triangles;  // count and sum of signs
    for (const auto& t : tetrahedra)
      for (std::size_t i = 0; i < 4; ++i) {
        std::array<std::size_t, 3> triangle{};
        for (std::size_t k = 0, j = 0; k < 4; ++k)
          if (k != i) triangle[j++] = t[k];
        const int sign = tile::sort_vertices(triangle) * (i % 2 == 0 ? 1 : -1);
        auto& [count, sum] = triangles[triangle];
        ++count;
        sum += sign;
      }
    std::map<std::array<std::size_t, 3>, int> result;
    for (const auto& [triangle, uses] : triangles) {
      EXPECT_LE(uses.first, 2);
      EXPECT_EQ(uses.first == 2, uses.second == 0);
      if (uses.first == 1) result.emplace(triangle, uses.second);
    }
    return result;
  }
  /// The same by names.
  [[nodiscard]] std::map<std::array<Around, 3>, int> boundary(bool flip) const {
    std::map<std::array<Around, 3>, int> result;
    for (const auto& [triangle, sum] : open_triangles()) {
      std::array<Around, 3> t{around.at(triangle[0]), around.at(triangle[1]), around.at(triangle[2])};
      const int sign = tile::sort_vertices(t) * sum * (flip ? -1 : 1);
      EXPECT_TRUE(result.emplace(t, sign).second);
    }
    return result;
  }
  [[nodiscard]] int euler() const {
    std::array<std::set<std::vector<std::size_t>>, 4> faces;
    for (auto t : tetrahedra) {
      std::sort(t.begin(), t.end());
      for (unsigned s = 1; s < 16; ++s) {
        std::vector<std::size_t> face;
        for (unsigned i = 0; i < 4; ++i)
          if ((s >> i & 1u) != 0) face.push_back(t[i]);
        faces[face.size() - 1].insert(face);
      }
    }
    const auto count = [&](std::size_t d) { return static_cast<int>(faces[d].size()); };
    return count(0) - count(1) + count(2) - count(3);
  }
};

/// Number of connected components.
inline std::size_t components_of(const CellContourOf& contour) {
  std::map<std::size_t, std::size_t> parent;
  const auto root = [&](std::size_t v) {
    while (parent.at(v) != v) v = parent.at(v);
    return v;
  };
  for (const auto& t : contour.tetrahedra)
    for (const std::size_t v : t) {
      parent.try_emplace(v, v);
      parent[root(v)] = root(t[0]);
    }
  return static_cast<std::size_t>(
      std::count_if(parent.begin(), parent.end(), [](const auto& each) { return each.first == each.second; }));
}

inline CellContourOf contour_by_engine(tile::FacetBuilder& builder, tile::Signature signature,
                                       const tile::Resolution& resolution) {
  const tile::TileFacets& facets = builder.build(signature, resolution);
  CellContourOf contour;
  const auto edge = [&](std::size_t v) {
    const tile::Signature corners = builder.lattice().faces()[facets.vertices[v].face].corners;
    return std::array{static_cast<unsigned>(std::countr_zero(corners)),
                      63u - static_cast<unsigned>(std::countl_zero(corners))};
  };
  const auto is_on_edge = [&](std::size_t v) { return facets.vertices[v].kind == tile::VertexKind::edge; };
  for (std::size_t v = 0; v < facets.vertices.size(); ++v) {
    Around& around = contour.around[v];
    if (is_on_edge(v)) around.insert(edge(v));
    if (facets.vertices[v].kind != tile::VertexKind::barycentre) continue;
    for (const auto& simplex : facets.vertices[v].of)
      for (int i = 0; i < tile::size(simplex); ++i)
        if (is_on_edge(simplex[static_cast<std::size_t>(i)])) around.insert(edge(simplex[static_cast<std::size_t>(i)]));
  }
  for (const tile::Facet& facet : facets.facets) {
    const bool is_side = facet.filling == tile::Filling::side;
    contour.has_sides = contour.has_sides || is_side;
    contour.has_cones = contour.has_cones || !is_side;
    for (const auto& s : facet.simplices) contour.tetrahedra.push_back({s[0], s[1], s[2], s[3]});
  }
  return contour;
}

inline CellContourOf contour_by_library(const detail::SolidCell& cell, const detail::PolytopeShape& shape) {
  CellContourOf contour;
  contour.has_sides = !cell.sides().empty();
  const auto edge = [&](detail::SolidCell::Local v) {
    const auto& [a, b] = shape.edges()[v];
    return std::array{unsigned{std::min(a, b)}, unsigned{std::max(a, b)}};
  };
  for (const auto& t : cell.tetrahedra()) {
    auto& to = contour.tetrahedra.emplace_back();
    for (std::size_t k = 0; k < 4; ++k) {
      to[k] = t[k];
      Around& around = contour.around[t[k]];
      if (t[k] < cell.first_shared()) {
        around.insert(edge(t[k]));
      } else if (t[k] < detail::SolidCell::kSides) {
        const bool is_shared = t[k] < cell.first_cone();
        const auto& inner = is_shared ? cell.shared()[t[k] - std::size_t{cell.first_shared()}]
                                      : cell.cones()[t[k] - std::size_t{cell.first_cone()}];
        for (const detail::SolidCell::Local v : inner.points) around.insert(edge(v));
      }
    }
  }
  return contour;
}

/// Compares contours of a 4D polytope whose values are 1 or -1 with the engine's: those of every `step`-th signature
/// from a random one on. Returns how many have copied sides.
inline std::size_t compare_with_engine(const detail::Polytopes& polytopes, tile::FacetBuilder& builder,
                                       std::uint64_t step) {
  const std::size_t corners = polytopes.shape(0).corner_count();
  const std::uint64_t count = std::uint64_t{1} << corners;
  std::mt19937_64 random(corners);
  std::size_t compared = 0, reversed = 0, sides = 0, fewer = 0;
  for (const bool high : {false, true}) {
    detail::PolytopeRules rules;
    rules.joins_high = high;
    rules.is_compact = false;
    detail::PolytopeRules compact_rules = rules;
    compact_rules.is_compact = true;
    detail::SolidCell cell(rules), compact(compact_rules);
    for (std::uint64_t s = step == 1 ? 1 : 1 + random() % step; s + 1 < count; s += step) {
      std::vector<double> values;
      for (std::size_t v = 0; v < corners; ++v) values.push_back((s >> v & 1u) != 0 ? 1.0 : -1.0);
      cell.build(polytopes.shape(0), polytopes.cell(0), values.data());
      const auto alternative = high ? tile::Alternative::high : tile::Alternative::low;
      const CellContourOf expected = contour_by_engine(builder, s, {{}, alternative});
      const CellContourOf contour = contour_by_library(cell, polytopes.shape(0));
      const auto sigma = expected.boundary(false);
      const bool flip = contour.boundary(false) != sigma;
      EXPECT_EQ(sigma, contour.boundary(flip)) << s;
      EXPECT_EQ(expected.has_sides, contour.has_sides) << s;
      EXPECT_EQ(expected.euler(), contour.euler()) << s;
      const std::size_t components = components_of(expected);
      EXPECT_EQ(components, components_of(contour)) << s;
      ++compared;
      reversed += flip ? 1 : 0;
      sides += contour.has_sides ? 1 : 0;
      compact.build(polytopes.shape(0), polytopes.cell(0), values.data());
      const CellContourOf other = contour_by_library(compact, polytopes.shape(0));
      if (!contour.has_sides) {
        EXPECT_EQ(expected.named_tetrahedra(false), contour.named_tetrahedra(flip)) << s;
        fewer += other.tetrahedra.size() < contour.tetrahedra.size() ? 1 : 0;
        EXPECT_LE(other.tetrahedra.size(), contour.tetrahedra.size()) << s;
      }
      // compact: other diagonals, the same topology
      EXPECT_EQ(expected.euler(), other.euler()) << s;
      EXPECT_EQ(components, components_of(other)) << s;
      (void)other.boundary(false);  // tests the neighbours of triangles
      if (::testing::Test::HasFailure()) return sides;
    }
  }
  EXPECT_TRUE(reversed == 0 || reversed == compared);  // the lattice has one orientation
  EXPECT_GT(3 * fewer, 2 * (compared - sides));
  return sides;
}

/// The corners with values of at least 0, as bits.
inline tile::Signature signature_of(const std::vector<double>& values) {
  tile::Signature signature = 0;
  for (std::size_t v = 0; v < values.size(); ++v) signature |= tile::Signature{values[v] >= 0.0} << v;
  return signature;
}

/// Choices by the means of the corners for the faces that `is_decided(face)`; the others are separate.
template <class IsDecided>
std::vector<tile::Choice> choices_by_means(const std::vector<tile::Face>& faces, const std::vector<double>& values,
                                           const IsDecided& is_decided) {
  std::vector<tile::Choice> choices(faces.size(), tile::Choice::separate);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!is_decided(faces[f])) continue;
    double sum = 0.0;
    for (std::size_t v = 0; v < values.size(); ++v) sum += (faces[f].corners >> v & 1u) != 0 ? values[v] : 0.0;
    choices[f] = sum >= 0.0 ? tile::Choice::high : tile::Choice::low;
  }
  return choices;
}

/// Expects the topology of `expected` of the contours of a 4D polytope, barycentric and compact, and calls
/// `visit(contour)` for both.
template <class Visit>
void compare_topology(const CellContourOf& expected, const detail::Polytopes& polytopes, Ambiguity rule,
                      const std::vector<double>& values, const Visit& visit) {
  detail::PolytopeRules rules;
  rules.rule = detail::face_rule(rule);
  for (const bool is_compact : {false, true}) {
    rules.is_compact = is_compact;
    detail::SolidCell cell(rules);
    cell.build(polytopes.shape(0), polytopes.cell(0), values.data());
    const CellContourOf contour = contour_by_library(cell, polytopes.shape(0));
    EXPECT_EQ(expected.euler(), contour.euler()) << signature_of(values);
    EXPECT_EQ(components_of(expected), components_of(contour)) << signature_of(values);
    visit(contour);
  }
}

/// Compares the topology of a 4D polytope with random values by the rule that decides each polygon by its mean, and
/// joins nothing else. Returns in how many the engine copies a side and cones a sphere.
inline std::size_t compare_separate_components(const detail::Polytopes& polytopes, tile::FacetBuilder& builder,
                                               std::size_t count) {
  const std::size_t corners = polytopes.shape(0).corner_count();
  std::mt19937_64 random(corners);
  std::size_t mixed = 0;
  for (std::size_t c = 0; c < count; ++c) {
    std::vector<double> values(corners);
    for (double& value : values) value = static_cast<double>(random() >> 11) * 0x1p-52 - 1.0;
    const auto choices =
        choices_by_means(builder.lattice().faces(), values, [](const tile::Face& face) { return face.dim == 2; });
    const CellContourOf expected = contour_by_engine(builder, signature_of(values), {choices, tile::Alternative::low});
    mixed += expected.has_sides && expected.has_cones ? 1 : 0;
    compare_topology(expected, polytopes, Ambiguity::squares, values, [](const CellContourOf& contour) {
      (void)contour.boundary(false);  // tests the neighbours of triangles
    });
  }
  return mixed;
}

}  // namespace tegl::test
