// SPDX-License-Identifier: BSD-3-Clause
//
// Triangulations of polygons: each method's chords follow its definition, and contours made of polygons are manifolds
// for all pairs of tiles.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "estimators.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/polygons.hpp"

namespace tegl::test {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;
using Points = std::vector<Point<3>>;

constexpr std::array<PolygonTriangulation, 5> kMethods = {
    PolygonTriangulation::fan, PolygonTriangulation::zigzag, PolygonTriangulation::halving_chord,
    PolygonTriangulation::halving_kink, PolygonTriangulation::barycentric};

Triangles triangles_of(const Points& points, PolygonTriangulation method, std::span<const Chord> forbidden = {}) {
  return triangulate_polygon<3>(points, method, forbidden);
}

/// A circle of points with random displacements.
Points random_polygon(std::size_t size, std::mt19937_64& bits) {
  Points points;
  for (std::size_t i = 0; i < size; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(size);
    points.push_back({std::cos(angle) + 0.3 * unit_random(bits), std::sin(angle) + 0.3 * unit_random(bits),
                      0.5 * unit_random(bits)});
  }
  return points;
}

/// The chords, each once, smaller point first.
std::set<Chord> chords_of(const Triangles& triangles, std::size_t size) {
  std::set<Chord> chords;
  for (const auto& t : triangles)
    for (std::size_t j = 0; j < 3; ++j) {
      const auto [a, b] = std::minmax(t[j], t[(j + 1) % 3]);
      if (b < size && b - a != 1 && b - a != size - 1) chords.insert({a, b});
    }
  return chords;
}

/// Expects the triangles' directed edges, after cancellation, to be the polygon's.
void expect_bounded_by_polygon(const Triangles& triangles, std::size_t size) {
  std::map<Chord, int> edges;
  for (const auto& t : triangles)
    for (std::size_t j = 0; j < 3; ++j) {
      const Index a = t[j], b = t[(j + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  for (Index i = 0; i < size; ++i) {
    const auto j = static_cast<Index>((i + 1) % size);
    edges[{std::min(i, j), std::max(i, j)}] -= i < j ? 1 : -1;
  }
  for (const auto& [edge, sum] : edges) EXPECT_EQ(sum, 0) << edge[0] << '-' << edge[1];
}

TEST(Polygons, OfAnySizeBecomeTrianglesThatTheyBound) {
  std::mt19937_64 bits(1);
  for (std::size_t size = 3; size <= 12; ++size)
    for (const PolygonTriangulation method : kMethods) {
      SCOPED_TRACE("size " + std::to_string(size) + ", method " + std::to_string(static_cast<int>(method)));
      const Triangles triangles = triangles_of(random_polygon(size, bits), method);
      const bool has_barycentre = method == PolygonTriangulation::barycentric && size > 3;
      EXPECT_EQ(triangles.size(), has_barycentre ? size : size - 2);
      expect_bounded_by_polygon(triangles, size);
    }
}

TEST(Polygons, OfSevenPointsAreCutAsInTheThesis) {
  std::mt19937_64 bits(2);
  const Points points = random_polygon(7, bits);
  EXPECT_EQ(triangles_of(points, PolygonTriangulation::fan),
            (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}}));
  EXPECT_EQ(triangles_of(points, PolygonTriangulation::zigzag),
            (Triangles{{0, 1, 6}, {5, 6, 1}, {1, 2, 5}, {4, 5, 2}, {2, 3, 4}}));
  // A quadrilateral and a pentagon: one chord leaves three points on its far side, and any other chord fewer.
  for (const auto method : {PolygonTriangulation::halving_chord, PolygonTriangulation::halving_kink}) {
    int halves = 0;
    for (const auto& [a, b] : chords_of(triangles_of(points, method), 7)) halves += b - a == 3 || b - a == 4 ? 1 : 0;
    EXPECT_GE(halves, 1);
  }
}

/// The weight of a kink by the angle between the planes of the chord and the edges at one of its ends.
double kink_by_planes(const Points& p, std::size_t i, std::size_t j) {
  const std::size_t n = p.size();
  const auto minus = [](const Point<3>& a, const Point<3>& b) {
    return Eigen::Vector3d(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  };
  const Eigen::Vector3d chord = minus(p[j], p[i]);
  double sum = 0;
  for (const std::size_t end : {i, j}) {
    const Eigen::Vector3d a = chord.cross(minus(p[(end + 1) % n], p[end]));
    const Eigen::Vector3d b = chord.cross(minus(p[(end + n - 1) % n], p[end]));
    sum += 1.0 - std::atan2(a.cross(b).norm(), a.dot(b)) / std::numbers::pi;
  }
  return 0.5 * sum;
}

TEST(Polygons, AreHalvedByTheChordOfLeastWeight) {
  std::mt19937_64 bits(3);
  int differ = 0;
  for (int run = 0; run < 200; ++run) {
    const std::size_t size = 4 + static_cast<std::size_t>(run) % 5;
    const Points p = random_polygon(size, bits);
    Chord shortest{}, flattest{};
    double length = 1e300, kink = 1e300;
    for (std::size_t i = 0; i < size; ++i)
      for (std::size_t j = i + size / 2; j <= i + (size + 1) / 2 && j < size; ++j) {
        const double d = std::hypot(p[i][0] - p[j][0], p[i][1] - p[j][1], p[i][2] - p[j][2]);
        if (d < length) length = d, shortest = {static_cast<Index>(i), static_cast<Index>(j)};
        const double k = kink_by_planes(p, i, j);
        if (k < kink) kink = k, flattest = {static_cast<Index>(i), static_cast<Index>(j)};
      }
    EXPECT_TRUE(chords_of(triangles_of(p, PolygonTriangulation::halving_chord), size).contains(shortest));
    EXPECT_TRUE(chords_of(triangles_of(p, PolygonTriangulation::halving_kink), size).contains(flattest));
    differ += shortest != flattest ? 1 : 0;
  }
  EXPECT_GT(differ, 20);
}

TEST(Polygons, HaveNoForbiddenChords) {
  std::mt19937_64 bits(4);
  int without = 0;
  for (int run = 0; run < 400; ++run) {
    const std::size_t size = 4 + random_below(bits, 5);
    const Points p = random_polygon(size, bits);
    std::vector<Chord> forbidden;
    for (Index a = 0; a < size; ++a)
      for (Index b = a + 2; b < size; ++b)
        if (unit_random(bits) < 0.4) forbidden.push_back({b, a});
    // Tests whether a triangulation exists by trying all triangles on the edge from the last point to the first,
    // recursively.
    const auto can = [&](const auto& self, Index a, Index b) -> bool {
      if (b - a == 1) return true;
      const bool is_edge = a == 0 && b == size - 1;
      if (!is_edge && std::find(forbidden.begin(), forbidden.end(), Chord{b, a}) != forbidden.end()) return false;
      for (Index c = a + 1; c < b; ++c)
        if (self(self, a, c) && self(self, c, b)) return true;
      return false;
    };
    const bool possible = can(can, 0, static_cast<Index>(size - 1));
    without += possible ? 0 : 1;
    for (const PolygonTriangulation method : kMethods) {
      const Triangles triangles = triangles_of(p, method, forbidden);
      expect_bounded_by_polygon(triangles, size);
      const bool has_barycentre = method == PolygonTriangulation::barycentric || !possible;
      EXPECT_EQ(triangles.size(), has_barycentre ? size : size - 2);
      for (const auto& [a, b] : chords_of(triangles, size))
        EXPECT_EQ(std::find(forbidden.begin(), forbidden.end(), Chord{b, a}), forbidden.end());
    }
  }
  EXPECT_GT(without, 10);
}

TEST(Polygons, HaveABarycentreThatDoesNotDependOnHowTheirEdgesAreDivided) {
  const Points square = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  const Points divided = {{0, 0, 0}, {0.1, 0, 0}, {0.7, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  const auto centre = polygon_barycentre<3>(square), same = polygon_barycentre<3>(divided);
  EXPECT_NEAR(centre[0], 1.0, 1e-15);
  EXPECT_NEAR(centre[1], 0.5, 1e-15);
  EXPECT_NEAR(same[0], 1.0, 1e-15);
  EXPECT_NEAR(same[1], 0.5, 1e-15);
  EXPECT_EQ(polygon_barycentre<3>(Points(4, Point<3>{1, 2, 3})), (Point<3>{1, 2, 3}));
}

TEST(Polygons, TellErrors) {
  const Points two(2);
  EXPECT_THROW(triangles_of(two, PolygonTriangulation::fan), Error);
  const Points four = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const std::vector<Chord> beyond = {{0, 4}};
  EXPECT_THROW(triangles_of(four, PolygonTriangulation::fan, beyond), Error);
}

/// All pairs of cubes that share a square in one image. `axis` is orthogonal to the square and has three samples; along
/// another axis there are two samples per pair.
OwnedImage<float, 3> all_pairs(int axis) {
  const int along = (axis + 1) % 3;
  std::array<std::size_t, 3> sizes{2, 2, 2};
  sizes[axis] = 3;
  sizes[along] = 2 * 4096;
  OwnedImage<float, 3> image{Grid<3>::unit(sizes), {}};
  std::mt19937_64 bits(5);
  for_each_sample<3>(image.grid, [&](std::size_t, const std::array<std::size_t, 3>& index) {
    const std::size_t pair = index[along] / 2, third = static_cast<std::size_t>(3 - axis - along);
    const std::size_t corner = index[axis] * 4 + index[along] % 2 * 2 + index[third];
    const double away = 0.05 + 0.9 * unit_random(bits);
    image.values.push_back(static_cast<float>((pair >> corner & 1u) != 0 ? away : -away));
  });
  return image;
}

TEST(ContoursFromPolygons, AreManifoldsForAllPairsOfCubes) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto image = all_pairs(axis);
    for (const NamedOptions& way : all_estimators())
      for (const bool close : {false, true}) {
        SCOPED_TRACE(way.name);
        ExtractOptions options = way.options;
        if (options.ambiguity > Ambiguity::high && (axis > 0 || close)) continue;  // reduces their number
        options.close = close;
        const auto facets = extract_facets<float>(image.view(), 0.0, options);
        const FacetReport expected = check(facets);
        for (const PolygonTriangulation method : kMethods) {
          SCOPED_TRACE("method " + std::to_string(static_cast<int>(method)));
          const auto contour = triangulate(facets, method);
          const MeshReport report = expect_oriented_manifold(contour);
          EXPECT_EQ(report.euler, expected.euler);
          EXPECT_EQ(report.boundary_simplices, expected.border);
          // If resolved from the data, a polygon may meet so many squares twice that no triangulation of its points
          // exists.
          if (method != PolygonTriangulation::barycentric && options.ambiguity <= Ambiguity::high) {
            EXPECT_EQ(contour.vertices.size(), facets.vertices.size()) << "a polygon had forbidden chords alone";
          }
        }
      }
  }
}

TEST(ContoursFromPolygons, AreFansAndZigzagsWhateverChordsAreForbidden) {
  // All triangles of a fan have a common point; in a zigzag no point is in more than three triangles.
  const auto image = all_pairs(0);
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high}) {
    const auto facets = extract_facets<float>(image.view(), 0.0, by_ambiguity(ambiguity));
    const auto fans = triangulate(facets, PolygonTriangulation::fan);
    const auto zigzags = triangulate(facets, PolygonTriangulation::zigzag);
    std::size_t first = 0;
    for (std::size_t f = 0; f < facets.count(2); ++f) {
      const std::size_t triangles = facets.down(2, f).size() - 2;
      std::map<Index, std::size_t> of_fan, of_zigzag;
      for (std::size_t s = first; s < first + triangles; ++s)
        for (std::size_t j = 0; j < 3; ++j) {
          ++of_fan[fans.simplices[s][j]];
          ++of_zigzag[zigzags.simplices[s][j]];
        }
      const auto by_count = [](const auto& a, const auto& b) { return a.second < b.second; };
      EXPECT_EQ(std::max_element(of_fan.begin(), of_fan.end(), by_count)->second, triangles);
      EXPECT_LE(std::max_element(of_zigzag.begin(), of_zigzag.end(), by_count)->second, 3u);
      first += triangles;
    }
  }
}

TEST(ContoursFromPolygons, OfNoiseAreManifoldsWithMissingValuesAndWithout) {
  for (const double missing : {0.0, 0.05}) {
    const auto image = noise_with_missing<float, 3>(Grid<3>::unit({12, 13, 14}), 6, missing);
    for (const NamedOptions& way : all_estimators()) {
      SCOPED_TRACE(way.name);
      ExtractOptions options = way.options;
      options.normals = Normals::differences;
      const auto facets = extract_facets<double>(image.view(), 0.5, options);
      options.triangulation = Triangulation::barycentric;
      const auto barycentric = extract<double>(image.view(), 0.5, options);
      const MeshReport expected = check(barycentric);
      for (const PolygonTriangulation method : kMethods) {
        const auto contour = triangulate(facets, method);
        const MeshReport report = expect_oriented_manifold(contour);
        if (method == PolygonTriangulation::barycentric) {
          EXPECT_EQ(contour.vertices.size(), barycentric.vertices.size());
          EXPECT_EQ(contour.simplices.size(), barycentric.simplices.size());
        }
        EXPECT_EQ(report.euler, expected.euler);
        EXPECT_EQ(report.components, expected.components);
        ASSERT_EQ(contour.normals.size(), contour.vertices.size());
        for (const auto& n : contour.normals) {
          const double length = std::hypot(n[0], n[1], n[2]);
          EXPECT_TRUE(length == 0 || std::abs(length - 1) < 1e-12);
        }
      }
    }
  }
}

TEST(ContoursFromPolygons, WithBarycentresAreTheBarycentricContour) {
  const auto image = sample_field<float, 3>(centred_grid<3>(17, 1.3), Gyroid<3>{4.0});
  ExtractOptions options;
  options.triangulation = Triangulation::barycentric;
  const auto expected = extract<double>(image.view(), 0.1, options);
  const auto contour =
      triangulate(extract_facets<double>(image.view(), 0.1, options), PolygonTriangulation::barycentric);
  EXPECT_EQ(contour.vertices.size(), expected.vertices.size());
  EXPECT_EQ(contour.simplices.size(), expected.simplices.size());
  EXPECT_NEAR(measure(contour), measure(expected), 1e-9 * measure(expected));
}

TEST(ContoursFromPolygons, FaceTheWayThatIsAskedFor) {
  const Ball<3> ball;
  const auto image = sample_field<float, 3>(centred_grid<3>(20, 1.5), ball);
  for (const PolygonTriangulation method : kMethods)
    for (const GradientDirection direction : {GradientDirection::descent, GradientDirection::ascent}) {
      ExtractOptions options;
      options.direction = direction;
      const auto contour = triangulate(extract_facets<double>(image.view(), 0.0, options), method);
      // Negative if the contour's orientation contradicts its `direction`.
      EXPECT_EQ(contour.direction, direction);
      EXPECT_NEAR(enclosed_content(contour), ball.content(), 0.05 * ball.content());
    }
}

TEST(ContoursFromPolygons, AreTheSameForAnyNumberOfThreads) {
  const auto image = noise<float, 3>(30, 8);
  const auto facets = extract_facets<float>(image.view(), 0.5);
  for (const PolygonTriangulation method : kMethods) {
    const auto one = triangulate(facets, method, {1}), four = triangulate(facets, method, {4});
    EXPECT_EQ(one.vertices, four.vertices);
    EXPECT_EQ(one.simplices, four.simplices);
  }
}

TEST(ContoursFromPolygons, CanBeCancelled) {
  const auto facets = extract_facets<float>(view_of(noise<float, 3>(20, 8)), 0.5);
  try {
    triangulate(facets, PolygonTriangulation::fan, {1, [](double) { return false; }});
    FAIL() << "not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

}  // namespace
}  // namespace tegl::test
