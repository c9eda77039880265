// SPDX-License-Identifier: BSD-3-Clause
//
// `check` of complexes of 4-simplices: manifolds pass, and single defects are counted.
#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

using Simplices = std::vector<std::array<Index, 5>>;

/// Checks the complex with coordinates in general position.
MeshReport report_of(const Simplices& simplices) {
  std::size_t vertices = 0;
  for (const auto& simplex : simplices)
    for (const Index v : simplex) vertices = std::max<std::size_t>(vertices, v + std::size_t{1});
  std::mt19937_64 random(1);
  std::vector<double> coordinates(5 * vertices);
  for (double& x : coordinates) x = unit_random(random);
  return check(4, {simplices.empty() ? nullptr : simplices.data()->data(), 5 * simplices.size()}, 5, coordinates);
}

/// The boundary of the 5-simplex, oriented.
Simplices smallest_sphere() {
  Simplices result;
  for (Index omitted = 0; omitted < 6; ++omitted) {
    std::array<Index, 5> simplex;
    for (Index v = 0, k = 0; v < 6; ++v)
      if (v != omitted) simplex[k++] = v;
    if (omitted % 2 != 0) std::swap(simplex[0], simplex[1]);
    result.push_back(simplex);
  }
  return result;
}

/// Cones over a contour of tetrahedra from one additional vertex, or from two, one on either side.
Simplices cones(const Contour<4>& base, int count) {
  Simplices result;
  for (int c = 0; c < count; ++c)
    for (const auto& s : base.simplices) {
      result.push_back({static_cast<Index>(base.vertices.size()) + static_cast<Index>(c), s[0], s[1], s[2], s[3]});
      if (c == 1) std::swap(result.back()[1], result.back()[2]);
    }
  return result;
}

template <class Field>
Contour<4> contour_of(const Field& field) {
  return extract(view_of(sample_field<float, 4>(centred_grid<4>(9, 1.6), field)), 0.0);
}

TEST(Check4d, TheSmallest4SphereIsOne) {
  const MeshReport report = report_of(smallest_sphere());
  EXPECT_TRUE(is_closed_oriented_manifold(report));
  EXPECT_EQ(report.dim, 4);
  EXPECT_EQ(report.vertices, 6u);
  EXPECT_EQ(report.euler, 2);
  EXPECT_EQ(report.degenerate_simplices, 0u);
}

TEST(Check4d, ASimplexIsABall) {
  const MeshReport report = report_of({{0, 1, 2, 3, 4}});
  EXPECT_TRUE(is_oriented_manifold(report));
  EXPECT_EQ(report.boundary_simplices, 5u);
  EXPECT_EQ(report.euler, 1);
}

TEST(Check4d, ConesOver3SpheresAreBallsAndTwoMakeA4Sphere) {
  const Contour<4> sphere = contour_of(Ball<4>{});
  const MeshReport ball = report_of(cones(sphere, 1)), whole = report_of(cones(sphere, 2));
  EXPECT_TRUE(is_oriented_manifold(ball));
  EXPECT_EQ(ball.boundary_simplices, sphere.simplices.size());
  EXPECT_EQ(ball.euler, 1);
  EXPECT_TRUE(is_closed_oriented_manifold(whole));
  EXPECT_EQ(whole.euler, 2);
}

TEST(Check4d, AnApexOverACircleTimesASphereIsFoundThoughAllNumbersAreThoseOfA4Sphere) {
  const Contour<4> tube = contour_of(RingTube<4>{});
  ASSERT_TRUE(is_closed_oriented_manifold(check(tube)));
  ASSERT_EQ(check(tube).components, 1u);
  EXPECT_EQ(report_of(cones(tube, 1)).bad_links, 1u);
  const MeshReport suspension = report_of(cones(tube, 2));
  EXPECT_EQ(suspension.bad_links, 2u);
  EXPECT_EQ(suspension.euler, 2);
  EXPECT_EQ(suspension.boundary_simplices, 0u);
  EXPECT_EQ(suspension.nonmanifold_simplices, 0u);
  EXPECT_EQ(suspension.orientation_conflicts, 0u);
}

TEST(Check4d, SimplicesThatMeetInLessThanATetrahedronHaveBadLinksThere) {
  EXPECT_EQ(report_of({{0, 1, 2, 3, 4}, {4, 5, 6, 7, 8}}).bad_links, 1u);
  EXPECT_EQ(report_of({{0, 1, 2, 3, 4}, {3, 4, 5, 6, 7}}).bad_links, 2u);
  EXPECT_EQ(report_of({{0, 1, 2, 3, 4}, {2, 3, 4, 5, 6}}).bad_links, 3u);
  EXPECT_EQ(report_of({{0, 1, 2, 3, 4}, {0, 1, 2, 3, 5}}).bad_links, 0u);
}

TEST(Check4d, ThreeSimplicesOnATetrahedronAreNoManifold) {
  const MeshReport report = report_of({{0, 1, 2, 3, 4}, {0, 1, 2, 3, 5}, {0, 1, 2, 3, 6}});
  EXPECT_EQ(report.nonmanifold_simplices, 1u);
  EXPECT_EQ(report.bad_links, 4u);
}

TEST(Check4d, ATurnedSimplexIsInConflictWithAllItsNeighbours) {
  Simplices simplices = smallest_sphere();
  std::swap(simplices[2][3], simplices[2][4]);
  EXPECT_EQ(report_of(simplices).orientation_conflicts, 5u);
}

/// Simplices around vertex 0, consecutive ones sharing a tetrahedron: a ball; the link of vertex 0 is a ball too.
Simplices fan(Index count) {
  Simplices result;
  for (Index i = 1; i <= count; ++i) result.push_back({0, i, i + 1, i + 2, i + 3});
  return result;
}

TEST(Check4d, LinksOfMoreVerticesThanCanBeShownCountAsBad) {
  EXPECT_EQ(report_of(fan(1000)).bad_links, 0u);
  EXPECT_EQ(report_of(fan(65534 - 3)).bad_links, 0u);
  EXPECT_EQ(report_of(fan(65535 - 3)).bad_links, 1u);
}

TEST(Check4d, FlatSimplicesAreCounted) {
  const std::vector<double> coordinates = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 1, 1, 0, 0};
  const std::array<Index, 5> simplex = {0, 1, 2, 3, 4};
  EXPECT_EQ(check(4, simplex, 5, coordinates).degenerate_simplices, 1u);
}

}  // namespace
}  // namespace tegl::test
