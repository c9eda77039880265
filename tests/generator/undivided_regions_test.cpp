// SPDX-License-Identifier: BSD-3-Clause
//
// The region of 3D shapes whose division is not proved: an exhaustive search shows that it has none without an added
// vertex. All in integers, at a list of positions: what a division for all positions needs, it needs there.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "cells/region_search.hpp"
#include "cells/region_tables.hpp"
#include "cells/region_volumes.hpp"
#include "regions/region_divisions.hpp"
#include "tegl/generated/cells.hpp"
#include "tegl/region_boundary.hpp"

namespace tegl::gen {
namespace {

using Place = std::array<std::int64_t, 3>;
using Places = std::array<Place, detail::ShapeVertices::kEnd>;
using Vertices = detail::ShapeVertices;

int sign_of(std::int64_t x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); }

/// Searches for tetrahedra between the vertices of a boundary that divide the region at all positions.
class ExhaustiveDivision {
 public:
  ExhaustiveDivision(const Cell& cell, RegionTriangles boundary) : boundary_(std::move(boundary)) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 200; ++i) positions_.push_back(random_places(cell, i % 2 == 0 ? 31 : 1, random));
    for (std::uint8_t v = 0; v < Vertices::kFirstOwn; ++v)
      if ((detail::vertices_of(boundary_) >> v & 1u) != 0) vertices_.push_back(v);
    std::int64_t volume = 0;
    for (const RegionTriangle& t : boundary_) volume += six_volumes(positions_[0], {0, t[0], t[1], t[2]});
    outwards_ = sign_of(volume);
  }
  [[nodiscard]] bool is_possible() { return divide(boundary_); }
  [[nodiscard]] std::size_t steps() const { return seen_.size(); }

 private:
  static std::int64_t coordinate(const Cell& cell, unsigned corner, std::size_t a) {
    return static_cast<std::int64_t>(cell.tile.corners[corner][a]);
  }
  /// Points at k / 64 of their edges, k from 1 to `most` or from 64 - `most` to 63. Barycentres are not needed.
  static Places random_places(const Cell& cell, unsigned most, std::mt19937_64& random) {
    Places at{};
    for (unsigned v = 0; v < cell.tile.corner_count(); ++v)
      for (std::size_t a = 0; a < 3; ++a) at[v][a] = 64 * coordinate(cell, v, a);
    for (unsigned e = 0; e < cell.tile.edge_count(); ++e) {
      const auto& [p, q] = cell.tile.edges[e];
      const auto near = static_cast<std::int64_t>(1 + random() % most);
      const std::int64_t k = random() % 2 == 0 ? near : 64 - near;
      for (std::size_t a = 0; a < 3; ++a)
        at[Vertices::kFirstEdge + e][a] = (64 - k) * coordinate(cell, p, a) + k * coordinate(cell, q, a);
    }
    return at;
  }
  static std::int64_t six_volumes(const Places& at, const RegionTetrahedron& t) {
    return detail::six_volumes(std::array{at[t[0]], at[t[1]], at[t[2]], at[t[3]]});
  }
  [[nodiscard]] bool is_positive(const RegionTetrahedron& t) const {
    return std::all_of(positions_.begin(), positions_.end(),
                       [&](const Places& at) { return sign_of(six_volumes(at, t)) == outwards_; });
  }
  /// Whether a plane through vertices of two tetrahedra is between them.
  static bool are_apart(const Places& at, const RegionTetrahedron& a, const RegionTetrahedron& b) {
    std::set<std::uint8_t> all(a.begin(), a.end());
    all.insert(b.begin(), b.end());
    const std::vector<std::uint8_t> v(all.begin(), all.end());
    const auto side = [&](const RegionTriangle& plane, const RegionTetrahedron& of) {
      int result = 0;  // 2: both
      for (const std::uint8_t w : of) {
        const int sign = sign_of(six_volumes(at, {w, plane[0], plane[1], plane[2]}));
        if (sign != 0) result = result == 0 || result == sign ? sign : 2;
      }
      return result;
    };
    for (std::size_t i = 0; i < v.size(); ++i)
      for (std::size_t k = i + 1; k < v.size(); ++k)
        for (std::size_t l = k + 1; l < v.size(); ++l)
          if (side({v[i], v[k], v[l]}, a) * side({v[i], v[k], v[l]}, b) == -1) return true;
    return false;
  }
  /// Whether tetrahedra do not overlap at the first positions.
  bool fit(const RegionTetrahedron& a, const RegionTetrahedron& b) {
    const auto [at, is_new] = fits_.try_emplace(std::pair{a, b});
    if (is_new)
      at->second = std::all_of(positions_.begin(), positions_.begin() + 6,
                               [&](const Places& places) { return are_apart(places, a, b); });
    return at->second;
  }
  /// A triangle of the rest's boundary belongs to one tetrahedron of each division: tries all at the triangle with the
  /// fewest.
  bool divide(const RegionTriangles& rest) {
    if (rest.empty()) return true;
    if (!seen_.insert(rest).second) return false;
    std::vector<RegionTetrahedron> best, found;
    bool is_first = true;
    for (const RegionTriangle& t : rest) {
      found.clear();
      for (const std::uint8_t v : vertices_) {
        const RegionTetrahedron next{v, t[0], t[1], t[2]};
        if (std::find(t.begin(), t.end(), v) == t.end() && is_positive(next) &&
            std::all_of(taken_.begin(), taken_.end(), [&](const RegionTetrahedron& of) { return fit(of, next); }))
          found.push_back(next);
      }
      if (is_first || found.size() < best.size()) best = found;
      is_first = false;
    }
    for (const RegionTetrahedron& next : best) {
      RegionTriangles inner = rest;
      for (const RegionTriangle& face : detail::faces_of(next))
        detail::add_to_boundary(inner, {face[1], face[0], face[2]});
      taken_.push_back(next);
      if (divide(inner)) return true;
      taken_.pop_back();
    }
    return false;
  }

  RegionTriangles boundary_;
  std::vector<Places> positions_;
  std::vector<std::uint8_t> vertices_;
  int outwards_ = 0;
  std::vector<RegionTetrahedron> taken_;
  std::set<RegionTriangles> seen_;
  std::map<std::pair<RegionTetrahedron, RegionTetrahedron>, bool> fits_;
};

TEST(RegionTables, TheUndividedRegionHasNoDivisionWithoutAnAddedVertex) {
  const Cell octahedron = mesh_cell("octahedron");
  const CellTables compact = make_cell_tables(octahedron, Triangulation::compact);
  const std::array fillings = {make_face_fillings(compact, false), make_face_fillings(compact, true)};
  const auto shapes = make_all_shape_tables();
  const CapTables regions =
      make_region_tables(octahedron, shapes[static_cast<std::size_t>(tables::CellShape::octahedron)], fillings);
  // Corners 0, 2 and 3 are high: a corner and both ends of another axis. The contour is an octagon, in a fan from the
  // point on the edge between corners 0 and 5 (11).
  const RegionTriangles expected = {{0, 2, 10},   {0, 3, 19},   {0, 10, 3},   {0, 11, 17},  {0, 17, 2},   {0, 19, 11},
                                    {2, 12, 16},  {2, 16, 10},  {2, 17, 12},  {3, 10, 18},  {3, 13, 19},  {3, 18, 13},
                                    {10, 11, 18}, {10, 16, 11}, {11, 12, 17}, {11, 13, 18}, {11, 16, 12}, {11, 19, 13}};
  ASSERT_EQ(regions.unproved.size(), 1u);
  EXPECT_EQ(regions.unproved[0], expected);
  ExhaustiveDivision search(octahedron, expected);
  EXPECT_FALSE(search.is_possible());
  EXPECT_GE(search.steps(), 2u);

  // the search finds divisions that are known to exist: of regions without barycentres and vertices of their own
  std::size_t searched = 0;
  for (std::size_t i = 0; i < regions.records.size(); i += 7) {
    const tables::RegionRecord& record = regions.records[i];
    const RegionTriangles boundary(regions.triangles.begin() + record.first_triangle,
                                   regions.triangles.begin() + record.first_triangle + record.triangles);
    if (record.own != 0 || detail::vertices_of(boundary) >> Vertices::kFirstCentre != 0) continue;
    EXPECT_TRUE(ExhaustiveDivision(octahedron, boundary).is_possible()) << i;
    ++searched;
  }
  EXPECT_GT(searched, 10u);
}

/// A region of hexahedra with two barycentres, four of whose vertices may have volumes with terms of both signs.
const RegionTriangles kWithTwoBarycentres = {
    {0, 3, 8},    {0, 5, 10},   {0, 8, 5},    {0, 9, 3},    {0, 10, 9},   {3, 6, 15},   {3, 9, 13},   {3, 11, 8},
    {3, 13, 6},   {3, 15, 11},  {5, 6, 16},   {5, 8, 12},   {5, 12, 18},  {5, 16, 10},  {5, 18, 6},   {6, 13, 14},
    {6, 14, 17},  {6, 17, 16},  {6, 18, 19},  {6, 19, 15},  {8, 11, 20},  {8, 20, 12},  {9, 10, 21},  {9, 21, 13},
    {10, 16, 21}, {11, 15, 20}, {12, 20, 18}, {13, 21, 14}, {14, 21, 17}, {15, 19, 20}, {16, 17, 21}, {18, 20, 19}};

TEST(RegionVolumes, ExactSignsAreTheSignsAtAllPositionsAndFewerThanThoseOfTheTerms) {
  const tables::CellTable& table = tables::cell_table(tables::CellShape::hexahedron, Triangulation::barycentric);
  const RegionVolumes volumes = volumes_with(table, kWithTwoBarycentres);
  std::vector<detail::ShapePlaces> positions;
  std::mt19937_64 random(3);
  for (int i = 0; i < 60; ++i) {
    detail::ShapePlaces& places = positions.emplace_back(volumes.generic());
    for (unsigned e = 0; e < table.edge_count; ++e) {
      const double alpha = static_cast<double>(random() >> 11) * 0x1p-53;
      places.set_alpha(e, i % 2 == 0 ? alpha : std::round(alpha) * 0.998 + 0.001);
    }
  }
  std::vector<std::uint8_t> vertices;
  for (std::uint8_t v = 0; v < Vertices::kFirstOwn; ++v)
    if ((detail::vertices_of(kWithTwoBarycentres) >> v & 1u) != 0) vertices.push_back(v);
  std::size_t sharper = 0;
  const std::size_t n = vertices.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t k = j + 1; k < n; ++k)
        for (std::size_t l = k + 1; l < n; ++l) {
          const RegionTetrahedron t = {vertices[i], vertices[j], vertices[k], vertices[l]};
          const VolumeSigns exact = volumes.exact_signs(t), terms = volumes.signs(t);
          sharper += terms.positive && terms.negative && exact.positive != exact.negative ? 1 : 0;
          EXPECT_TRUE((terms.positive || !exact.positive) && (terms.negative || !exact.negative));
          for (const detail::ShapePlaces& places : positions) {
            const double volume = detail::six_volumes(places.places(t));
            EXPECT_TRUE(volume < 1e-12 || exact.positive) << volume;
            EXPECT_TRUE(volume > -1e-12 || exact.negative) << volume;
          }
        }
  EXPECT_GT(sharper, 0u);
}

/// Whether the terms of some volume of an emitted division have both signs. `record`: without vertices near corners.
bool has_balanced_volume(const tables::RegionDivisionTable& table, const tables::RegionRecord& record,
                         const RegionVolumes& volumes) {
  const auto is_balanced = [&](std::uint8_t apex, const std::uint8_t* t) {
    const VolumeSigns of = volumes.signs({apex, t[1], t[2], t[3]});
    return of.positive && of.negative;
  };
  for (unsigned i = 0; i < record.tetrahedra; ++i) {
    const std::uint8_t* const t = table.tetrahedra + 4 * (record.first_tetrahedron + i);
    if (t[0] < Vertices::kFirstOwn) {
      if (is_balanced(t[0], t)) return true;
      continue;
    }
    const std::uint32_t points = table.own[record.first_own + t[0] - Vertices::kFirstOwn];
    for (std::uint8_t v = 0; v < Vertices::kFirstCentre; ++v)
      if ((points >> v & 1u) != 0 && std::find(t, t + 4, v) == t + 4 && is_balanced(v, t)) return true;
  }
  return false;
}

TEST(RegionTables, VolumesWithTermsOfBothSignsOccurInFiveRegionsOfHexahedraWithTwoBarycentres) {
  for (const auto shape : {tables::CellShape::tetrahedron, tables::CellShape::wedge, tables::CellShape::pyramid,
                           tables::CellShape::hexahedron, tables::CellShape::octahedron}) {
    const tables::RegionDivisionTable& table = *tables::region_division_table(shape);
    int balanced = 0;
    for (std::uint32_t i = 0; i < table.count; ++i) {
      const tables::RegionRecord& record = table.records[i];
      if (record.near != 0) continue;  // such a vertex need not see all triangles from each of its points
      RegionTriangles boundary(record.triangles);
      for (std::size_t j = 0; j < boundary.size(); ++j)
        std::copy_n(table.triangles + 3 * (record.first_triangle + j), 3, boundary[j].begin());
      const RegionVolumes volumes = volumes_with(tables::cell_table(shape, Triangulation::barycentric), boundary);
      if (!has_balanced_volume(table, record, volumes)) continue;
      ++balanced;
      const std::uint64_t centres = detail::vertices_of(boundary) >> Vertices::kFirstCentre;
      EXPECT_EQ(centres, 0b11u) << i;
    }
    EXPECT_EQ(balanced, shape == tables::CellShape::hexahedron ? 5 : 0);
  }
}

/// The divisions that the runtime finds for all boundaries that can occur, by shape.
TEST(RegionTables, TheRuntimeHasProvedDivisionsOfAllBoundariesExceptThoseOfOneRegion) {
  const std::pair<tables::CellShape, const char*> solid[] = {{tables::CellShape::tetrahedron, "tetrahedron"},
                                                             {tables::CellShape::wedge, "wedge"},
                                                             {tables::CellShape::pyramid, "pyramid"},
                                                             {tables::CellShape::hexahedron, "hexahedron"},
                                                             {tables::CellShape::octahedron, "octahedron"}};
  const auto shapes = make_all_shape_tables();
  detail::RegionDivisions divisions(Triangulation::compact, tile::Alternative::low);
  for (const auto& [shape, name] : solid) {
    const Cell cell = mesh_cell(name);
    const CellTables compact = make_cell_tables(cell, Triangulation::compact);
    const std::array fillings = {make_face_fillings(compact, false), make_face_fillings(compact, true)};
    std::size_t unproved = 0;
    for (const RegionTriangles& boundary : list_boundaries(cell, shapes[static_cast<std::size_t>(shape)], fillings)) {
      const detail::RegionDivision& division = divisions.of(shape, boundary);
      unproved += division.is_proved ? 0 : 1;
      RegionTriangles sum;
      for (const RegionTetrahedron& t : division.tetrahedra)
        for (const RegionTriangle& face : detail::faces_of(t)) detail::add_to_boundary(sum, face);
      ASSERT_EQ(sum, boundary) << name;
    }
    EXPECT_EQ(unproved, shape == tables::CellShape::octahedron ? 24u : 0u) << name;
  }
}

}  // namespace
}  // namespace tegl::gen
