// SPDX-License-Identifier: BSD-3-Clause
//
// Divisions of the high parts of 3D cells: proved for all signatures, and positive wherever the points are.
#include "regions/region_divisions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "complex/cell_cases.hpp"
#include "complex/cell_groups.hpp"
#include "tegl/generated/cells.hpp"

namespace tegl::detail {
namespace {

using tables::CellShape;
using Triangle = RegionDivision::Triangle;
using Triangles = std::vector<Triangle>;
using Ring = std::vector<std::uint8_t>;

constexpr CellShape kSolid[] = {CellShape::tetrahedron, CellShape::wedge, CellShape::pyramid, CellShape::hexahedron,
                                CellShape::octahedron};

const tables::CellTable& compact_table(CellShape shape) { return tables::cell_table(shape, Triangulation::compact); }

/// Six times the signed volume between the shape's first corner and a triangle.
double volume_behind(const ShapePlaces& places, std::uint8_t from, const Triangle& t) {
  return six_volumes(places.places({from, t[0], t[1], t[2]}));
}

/// The faces of a shape as rings of corners, counterclockwise seen from outside.
std::vector<Ring> faces_of(CellShape shape) {
  const tables::CellTable& table = compact_table(shape);
  std::vector<Ring> faces;
  for (const auto& q : quadrilaterals_of(shape)) faces.push_back({q[0], q[1], q[3], q[2]});
  const auto joined = [&](unsigned p, unsigned q) {
    for (std::uint32_t e = 0; e < table.edge_count; ++e)
      if ((table.edges[2 * e] == p && table.edges[2 * e + 1] == q) ||
          (table.edges[2 * e] == q && table.edges[2 * e + 1] == p))
        return true;
    return false;
  };
  for (std::uint8_t a = 0; a < table.corner_count; ++a)
    for (auto b = static_cast<std::uint8_t>(a + 1); b < table.corner_count; ++b)
      for (auto c = static_cast<std::uint8_t>(b + 1); c < table.corner_count; ++c)
        if (joined(a, b) && joined(b, c) && joined(a, c)) faces.push_back({a, b, c});
  const ShapePlaces places(table);
  for (Ring& face : faces) {
    double sum = 0;
    for (std::uint8_t v = 0; v < table.corner_count; ++v) sum += volume_behind(places, v, {face[0], face[1], face[2]});
    if (sum < 0) std::reverse(face.begin() + 1, face.end());
  }
  return faces;
}

/// Numbers of the points at the corners.
using Points = std::array<unsigned, 8>;

/// The high parts of a face, low-connected, as fans: from the corner between two others, else from the smallest.
void add_face(CellShape shape, const Ring& face, unsigned signature, const Points& points, Triangles& boundary) {
  const auto smallest = [&](const Ring& corners) {
    return *std::min_element(corners.begin(), corners.end(), [&](auto a, auto b) { return points[a] < points[b]; });
  };
  const tables::CellTable& table = compact_table(shape);
  const std::size_t size = face.size();
  const auto high = [&](std::size_t i) { return (signature >> face[i % size] & 1u) != 0; };
  const auto point = [&](std::size_t i) {  // between corners i and i + 1
    return static_cast<std::uint8_t>(ShapeVertices::kFirstEdge +
                                     edge_between(table, face[i % size], face[(i + 1) % size]));
  };
  const auto add_fan = [&](Ring ring, std::uint8_t from) {
    std::rotate(ring.begin(), std::find(ring.begin(), ring.end(), from), ring.end());
    for (std::size_t k = 1; k + 1 < ring.size(); ++k) boundary.push_back({ring[0], ring[k], ring[k + 1]});
  };
  bool all = true;
  for (std::size_t i = 0; i < size; ++i) all = all && high(i);
  if (all) return add_fan(face, smallest(face));
  for (std::size_t i = 0; i < size; ++i) {
    if (!high(i) || high(i + size - 1)) continue;
    Ring corners;
    for (std::size_t k = i; high(k); ++k) corners.push_back(face[k % size]);
    Ring ring = corners;
    ring.push_back(point(i + corners.size() - 1));
    ring.push_back(point(i + size - 1));
    add_fan(ring, corners.size() == 3 ? corners[1] : smallest(corners));
  }
}

/// The boundary of the high part of a cell; empty if the contour has vertices inside the cell.
Triangles boundary_of(CellShape shape, unsigned signature, const Points& points) {
  const tables::CellTable& table = compact_table(shape);
  const CellContour contour(table, signature, false);
  Triangles boundary;
  if (contour.list().added() > 0) return boundary;
  for (unsigned i = 0; i < contour.list().simplex_count; ++i) {
    Triangle t;
    for (unsigned k = 0; k < 3; ++k) t[k] = static_cast<std::uint8_t>(ShapeVertices::kFirstEdge + contour.vertex(i, k));
    if (!contour.reverses()) std::swap(t[1], t[2]);  // tables face high
    boundary.push_back(t);
  }
  for (const Ring& face : faces_of(shape)) add_face(shape, face, signature, points, boundary);
  return boundary;
}

void expect_closed(const Triangles& boundary) {
  std::map<std::pair<std::uint8_t, std::uint8_t>, int> sides;
  for (const Triangle& t : boundary)
    for (std::size_t k = 0; k < 3; ++k) {
      ++sides[{t[k], t[(k + 1) % 3]}];
      --sides[{t[(k + 1) % 3], t[k]}];
    }
  EXPECT_TRUE(std::all_of(sides.begin(), sides.end(), [](const auto& side) { return side.second == 0; }));
}

TEST(RegionDivisions, AllSignaturesOfAllShapesAreProvedAndFillTheirRegionsWhereverThePointsAre) {
  std::mt19937_64 random(3);
  RegionDivisions divisions(Triangulation::compact, tile::Alternative::low);
  for (const CellShape shape : kSolid) {
    const tables::CellTable& table = compact_table(shape);
    unsigned divided = 0;
    for (unsigned signature = 1; signature + 1 < 1u << table.corner_count; ++signature) {
      Points points;
      std::iota(points.begin(), points.end(), 0u);
      std::shuffle(points.begin(), points.end(), random);
      const Triangles boundary = boundary_of(shape, signature, points);
      if (boundary.empty()) continue;
      SCOPED_TRACE(testing::Message() << "shape " << static_cast<int>(shape) << " signature " << signature);
      expect_closed(boundary);
      const RegionDivision& division = divisions.of(shape, boundary);
      EXPECT_TRUE(division.is_proved);
      ++divided;
      if (!division.own.empty()) continue;
      ShapePlaces places(table);
      for (unsigned e = 0; e < table.edge_count; ++e)
        places.set_alpha(e, 0.01 + 0.98 * static_cast<double>(random() >> 11) * 0x1p-53);
      double expected = 0, sum = 0;
      for (const Triangle& t : boundary) expected += volume_behind(places, 0, t);
      for (const auto& t : division.tetrahedra) {
        const double volume = six_volumes(places.places(t)) * (expected < 0 ? -1 : 1);
        EXPECT_GT(volume, 0);
        sum += volume;
      }
      EXPECT_NEAR(std::abs(expected), sum, 1e-12);
    }
    EXPECT_GT(divided, shape == CellShape::tetrahedron ? 13u : 25u);
  }
}

/// The emitted table has regions up to symmetry. Those that a share of the symmetries makes of them are found in it.
TEST(RegionDivisions, ListedRegionsAreProvedAndFilledInOtherPositionsToo) {
  constexpr std::size_t kStep = 5;  // of symmetries; the numbers of them are multiples of 2 and 3
  RegionDivisions divisions(Triangulation::compact, tile::Alternative::low);
  for (const CellShape shape : kSolid) {
    const tables::CellTable& table = compact_table(shape);
    const tables::RegionDivisionTable& listed = *tables::region_division_table(shape);
    const tables::ShapeTable& symmetric = tables::shape_table(shape);
    const std::size_t stride = table.corner_count + table.edge_count;
    for (std::uint32_t i = 0; i < listed.count; ++i) {
      RegionTriangles region(listed.records[i].triangles);
      for (std::size_t j = 0; j < region.size(); ++j)
        std::copy_n(listed.triangles + 3 * (listed.records[i].first_triangle + j), 3, region[j].begin());
      for (std::size_t s = i % kStep; s < symmetric.symmetry_count; s += kStep) {
        SCOPED_TRACE(testing::Message() << "shape " << static_cast<int>(shape) << " region " << i << " symmetry " << s);
        RegionMap map{};
        const RegionTriangles boundary =
            representative_of(region, table, {symmetric.symmetries + s * stride, stride}, map);
        const RegionDivision& division = divisions.of(shape, boundary);
        ASSERT_TRUE(division.is_proved);
        RegionTriangles sum;
        for (const RegionTetrahedron& t : division.tetrahedra)
          for (const RegionTriangle& face : detail::faces_of(t)) add_to_boundary(sum, face);
        ASSERT_EQ(sum, boundary);
      }
    }
  }
}

/// The points on four parallel edges span a tetrahedron that is positive or negative, depending on where they are.
TEST(RegionDivisions, ARegionWhoseOrientationDependsOnThePointsIsNotProved) {
  RegionDivisions divisions(Triangulation::compact, tile::Alternative::low);
  const tables::CellTable& table = compact_table(CellShape::hexahedron);
  std::array<std::uint8_t, 4> p;
  for (unsigned i = 0; i < 4; ++i)
    p[i] = static_cast<std::uint8_t>(ShapeVertices::kFirstEdge + edge_between(table, 2 * i, 2 * i + 1));
  const Triangles boundary = {{p[0], p[2], p[1]}, {p[0], p[1], p[3]}, {p[0], p[3], p[2]}, {p[1], p[2], p[3]}};
  expect_closed(boundary);
  EXPECT_FALSE(divisions.of(CellShape::hexahedron, boundary).is_proved);
}

}  // namespace
}  // namespace tegl::detail
