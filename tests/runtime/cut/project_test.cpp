// SPDX-License-Identifier: BSD-3-Clause
//
// Projections of 4D contours: compared with the swept regions of analytic fields, and closed for any contour.
#include "tegl/project.hpp"

#include <cmath>
#include <limits>

#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/extract.hpp"

namespace tegl {
namespace {

using test::expect_closed_manifold;
using test::Point;

/// A ball of radius 0.5 that moves along x from -0.6 to 0.6 for t = -1 to 1.
struct MovingBall {
  double operator()(const Point<4>& x) const { return 0.5 - std::hypot(x[0] - 0.6 * x[3], x[1], x[2]); }
};

Contour<4, double> moving_ball(bool close) {
  Grid<4> grid;
  grid.axes = {Axis::uniform(33, -1.28, 0.08), Axis::uniform(17, -0.64, 0.08), Axis::uniform(17, -0.64, 0.08),
               Axis::uniform(21, -1.0, 0.1)};
  grid.axes[3].name = "time";
  grid.axes[3].unit = "s";
  ExtractOptions options;
  options.close = close;
  return extract<double>(view_of(test::sample_field<double>(grid, MovingBall())), 0.0, options);
}

TEST(Outline, OfAMovingBallIsTheSurfaceOfACapsule) {
  constexpr double kPi = std::numbers::pi;
  const auto surface = outline(moving_ball(true));
  const MeshReport report = expect_closed_manifold(surface);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.euler, 2);
  EXPECT_NEAR(test::enclosed_content(surface), kPi * 0.25 * 1.2 + 4.0 / 3.0 * kPi * 0.125, 0.08);
  EXPECT_NEAR(test::measure(surface), kPi * 1.2 + kPi, 0.3);
  // The time at which each position was touched: for the tube at x / 0.6.
  ASSERT_EQ(surface.vertex_attributes.size(), 1u);
  EXPECT_EQ(surface.vertex_attributes[0].name, "time");
  EXPECT_EQ(surface.vertex_attributes[0].unit, "s");
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    const auto& x = surface.vertices[v];
    EXPECT_NEAR(std::hypot(x[1], x[2], std::max(0.0, std::abs(x[0]) - 0.6)), 0.5, 0.06);
    if (std::abs(x[0]) < 0.4) {
      EXPECT_NEAR(surface.vertex_attributes[0].values[v], x[0] / 0.6, 0.2);
    }
  }
}

TEST(Outline, OfAnOpenContourIsOpenWhereThatIs) {
  const auto surface = outline(moving_ball(false));
  const auto report = test::expect_oriented_manifold(surface);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.euler, 0);  // a tube
  EXPECT_GT(report.boundary_simplices, 0u);
}

TEST(Outline, FacesAwayFromWhatIsSweptForDescentAndIntoItForAscent) {
  auto contour = moving_ball(true);
  EXPECT_GT(test::enclosed_content(outline(contour)), 1.0);
  for (auto& simplex : contour.simplices) std::swap(simplex[0], simplex[1]);
  contour.direction = GradientDirection::ascent;
  const auto surface = outline(contour);
  EXPECT_GT(test::enclosed_content(surface), 1.0);
  EXPECT_EQ(surface.direction, GradientDirection::ascent);
  expect_closed_manifold(surface);
}

TEST(Outline, OfA4BallIsASphereAlongAnyDirection) {
  const auto image = test::sample_field<double>(test::centred_grid<4>(21, 1.0), test::Ball<4>{{}, 0.8});
  const auto contour = extract<double>(image.view(), 0.0);
  for (const Vector<4>& direction : {Vector<4>{0, 0, 0, 1}, Vector<4>{1, 0, 0, 0}, Vector<4>{0, -1, 0, 0},
                                     Vector<4>{1, 2, -1, 1}, Vector<4>{-3, 1, 0, 1}}) {
    const auto surface = outline(contour, {direction, 0.0});
    expect_closed_manifold(surface);
    EXPECT_NEAR(test::enclosed_content(surface), (test::Ball<3>{{}, 0.8}.content()), 0.12)
        << testing::PrintToString(direction);
    for (std::size_t v = 0; v < surface.vertices.size(); ++v)
      EXPECT_NEAR(surface.vertex_attributes[0].values[v], 0.0, 0.3);
  }
}

TEST(Outline, OfNoiseIsAClosedOrientedManifold) {
  std::size_t triangles = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const auto image = test::noise<float, 4>(5, seed);
    const auto coarse = test::coarse_noise<std::uint8_t, 4>(Grid<4>::unit({5, 5, 5, 5}), seed, 3);
    for (const bool close : {false, true}) {
      ExtractOptions options;
      options.close = close;
      for (const Vector<4>& direction : {Vector<4>{0, 0, 0, 1}, Vector<4>{1, 2, 3, 4}})
        for (const double eye : {0.0, 3.0})
          for (const auto& contour : {extract(image.view(), 0.5, options), extract(coarse.view(), 1.0, options)}) {
            const auto surface = outline(contour, {direction, eye});
            const MeshReport report = test::expect_oriented_manifold(surface);
            if (close) {
              EXPECT_EQ(report.boundary_simplices, 0u);
            }
            triangles += surface.simplices.size();
          }
    }
  }
  EXPECT_GT(triangles, 10000u);
}

TEST(Outline, OfWhatStandsStillIsEmpty) {
  const auto ball = test::Ball<3>{{}, 0.7};
  const auto still = [&](const Point<4>& x) { return ball({x[0], x[1], x[2]}); };
  const auto image = test::sample_field<double>(test::centred_grid<4>(13, 1.0), still);
  EXPECT_TRUE(outline(extract<double>(image.view(), 0.0)).simplices.empty());
  EXPECT_TRUE(outline(extract<float>(image.view(), 0.0)).simplices.empty());
}

TEST(Project, GivesHeightsAndSides) {
  const auto contour = moving_ball(false);
  const auto projected = project(contour);
  ASSERT_EQ(projected.vertices.size(), contour.vertices.size());
  EXPECT_TRUE(projected.tetrahedra == contour.simplices);
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    for (int a = 0; a < 3; ++a) ASSERT_EQ(projected.vertices[v][a], contour.vertices[v][a]);
    ASSERT_EQ(projected.vertex_attributes[0].values[v], contour.vertices[v][3]);
  }
  // The ball enters regions ahead of it and leaves regions behind it.
  double told = 0, as_expected = 0;
  ASSERT_EQ(projected.simplex_attributes[0].name, "side");
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) {
    double ahead = 0.0;
    for (const Index v : contour.simplices[s]) ahead += (contour.vertices[v][0] - 0.6 * contour.vertices[v][3]) / 4;
    if (std::abs(ahead) < 0.2) continue;
    ++told;
    as_expected += projected.simplex_attributes[0].values[s] == (ahead > 0 ? -1.0 : 1.0);
  }
  // Tetrahedra of distorted parts of the contour face other directions.
  EXPECT_GT(told, 1000.0);
  EXPECT_GT(as_expected, 0.8 * told);
}

TEST(Project, DrawsWhatIsFurtherTowardsTheMiddle) {
  Contour<4, double> contour;
  contour.vertices = {{-1, -1, -1, 5}, {1, 1, 1, 5}, {1, 0, 0, 7}, {1, 1, -1, 9}};
  contour.simplices = {{0, 1, 2, 3}};
  const auto projected = project(contour, {unit_vector<4>(3), 2.0});
  EXPECT_EQ(projected.vertices[1], (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(projected.vertices[2], (std::array<double, 3>{0.5, 0, 0}));  // twice as far from the eye
  EXPECT_NEAR(projected.vertices[3][0], 1.0 / 3.0, 1e-15);
}

TEST(Project, KeepsAttributesAndRefusesWhatIsNoView) {
  Contour<4, float> contour;
  contour.vertices = {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 1}};
  contour.simplices = {{0, 1, 2, 3}};
  contour.vertex_attributes = {{"t", "old", 1, {9, 9, 9, 9}}, {"age", "", 1, {1, 2, 3, 4}}};
  const auto projected = project(contour);
  ASSERT_EQ(projected.vertex_attributes.size(), 2u);
  EXPECT_EQ(projected.vertex_attributes[0].name, "age");
  EXPECT_EQ(projected.vertex_attributes[1].values[3], 1.0);
  EXPECT_THROW((void)project(contour, {Vector<4>{}, 0.0}), Error);
  EXPECT_THROW((void)project(contour, {unit_vector<4>(3), -1.0}), Error);
  EXPECT_THROW((void)outline(contour, {unit_vector<4>(3), std::numeric_limits<double>::infinity()}), Error);
  EXPECT_THROW((void)outline(contour, {}, {1, [](double) { return false; }}), Error);
  EXPECT_TRUE(outline(Contour<4, float>{}).simplices.empty());
}

}  // namespace
}  // namespace tegl
