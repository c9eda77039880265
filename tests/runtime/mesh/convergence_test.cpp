// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of smooth fields have the correct topology, and their measure and content converge at second order in the
// grid's step.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "ambiguity/variants.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

/// Errors relative to the exact value at three resolutions with halved steps.
template <int N, class Field, class Quantity>
void expect_second_order(const Field& field, double half_width, std::size_t samples, double exact, double finest,
                         const ExtractOptions& options, const Quantity& quantity) {
  double errors[3];
  for (int level = 0; level < 3; ++level, samples = 2 * samples - 1) {
    // Off the lattice, so that symmetries of the field do not improve the result.
    Grid<N> grid = centred_grid<N>(samples, half_width);
    for (int a = 0; a < N; ++a) {
      const double shift = grid.axes[a].step() * 0.17 * (a + 1);
      grid.axes[a] = Axis::uniform(samples, grid.axes[a].origin() + shift, grid.axes[a].step());
    }
    const auto image = sample_field<double, N>(grid, field);
    errors[level] = quantity(extract<double>(image.view(), 0.0, options)) / exact - 1.0;
  }
  EXPECT_LT(std::abs(errors[2]), finest);
  // Over two halvings, which averages over the grid's position.
  const double order = 0.5 * convergence_order(errors[0], errors[2]);
  EXPECT_GT(order, 1.7) << "errors " << errors[0] << ' ' << errors[1] << ' ' << errors[2];
}

constexpr auto kMeasure = [](const auto& contour) { return test::measure(contour); };
constexpr auto kContent = [](const auto& contour) { return enclosed_content(contour); };

template <int N>
void expect_ball_converges(std::size_t samples, double finest) {
  for (const ExtractOptions& options : variants()) {
    SCOPED_TRACE(describe(options));
    const Ball<N> ball;
    expect_second_order<N>(ball, 1.3, samples, ball.surface(), finest, options, kMeasure);
    expect_second_order<N>(ball, 1.3, samples, ball.content(), finest, options, kContent);
  }
}

TEST(Convergence, LengthAndAreaOfACircleAreOfSecondOrder) { expect_ball_converges<2>(21, 1e-3); }
TEST(Convergence, AreaAndVolumeOfASphereAreOfSecondOrder) { expect_ball_converges<3>(13, 4e-3); }
TEST(Convergence, VolumeAndContentOfA3SphereAreOfSecondOrder) { expect_ball_converges<4>(9, 2e-2); }

TEST(Convergence, AreaOfATorusIsOfSecondOrder) {
  const RingTube<3> torus;
  for (const ExtractOptions& options : variants()) {
    expect_second_order<3>(torus, 1.7, 17, torus.surface(), 1e-2, options, kMeasure);
    expect_second_order<3>(torus, 1.7, 17, torus.content(), 1e-2, options, kContent);
  }
}

template <int N, class Field>
MeshReport report_of(const Field& field, std::size_t samples, double half_width, const ExtractOptions& options) {
  const auto image = sample_field<float, N>(centred_grid<N>(samples, half_width), field);
  return expect_closed_manifold(extract<double>(image.view(), 0.0, options));
}

TEST(Topology, SpheresHaveTheirEulerCharacteristic) {
  for (const ExtractOptions& options : variants()) {
    const auto circle = report_of<2>(Ball<2>{}, 20, 1.3, options);
    const auto sphere = report_of<3>(Ball<3>{}, 20, 1.3, options);
    const auto three_sphere = report_of<4>(Ball<4>{}, 12, 1.3, options);
    EXPECT_EQ(circle.euler, 0);
    EXPECT_EQ(sphere.euler, 2);
    EXPECT_EQ(three_sphere.euler, 0);
    EXPECT_EQ(circle.components + sphere.components + three_sphere.components, 3u);
  }
}

TEST(Topology, TubesAreConnectedWithEulerCharacteristic0) {
  for (const ExtractOptions& options : variants()) {
    SCOPED_TRACE(describe(options));
    for (const MeshReport& report :
         {report_of<3>(RingTube<3>{}, 25, 1.6, options), report_of<4>(RingTube<4>{}, 17, 1.6, options),
          report_of<4>(SphereTube{}, 17, 1.6, options), report_of<4>(TorusTube{}, 17, 1.6, options)}) {
      EXPECT_EQ(report.components, 1u);
      EXPECT_EQ(report.euler, 0);
    }
  }
}

/// Two merging balls over time, closed at the first and the last step: one component. The 2D contour of two moving
/// intervals is a circle; in 3D two discs give a sphere, in 4D two balls a 3-sphere.
template <int N>
void expect_merging_balls_to_be_one_sphere(std::size_t samples) {
  const MergingBalls<N> balls{0.7, 1.5, 1.0};
  Grid<N> grid = centred_grid<N>(samples, 2.4);
  grid.axes[N - 1] = Axis::uniform(samples, 0.0, 1.5 / static_cast<double>(samples - 1));
  const auto image = sample_field<float, N>(grid, balls);
  for (ExtractOptions options : variants()) {
    options.close = true;
    SCOPED_TRACE(describe(options));
    const auto contour = extract<double>(image.view(), 0.0, options);
    const auto report = expect_closed_manifold(contour);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.euler, N == 3 ? 2 : 0);
  }
}

TEST(Topology, MergingBallsAreOneSphereInSpaceTime) {
  expect_merging_balls_to_be_one_sphere<2>(40);
  expect_merging_balls_to_be_one_sphere<3>(28);
  expect_merging_balls_to_be_one_sphere<4>(20);
}

}  // namespace
}  // namespace tegl::test
