// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes over time: contours in space and time by prisms, and their cuts.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "compare.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "meshes.hpp"
#include "tegl/complex.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using namespace test;

ExtractOptions barycentric(Ambiguity ambiguity = Ambiguity::low) {
  ExtractOptions options;
  options.triangulation = Triangulation::barycentric;
  options.ambiguity = ambiguity;
  return options;
}

const std::vector<double> kTimes = {0.0, 0.7, 1.0, 2.5, 3.1};

/// Noise at all times, low on the border of the grid.
template <int N>
std::vector<double> noise_over_time(const MeshData<N>& mesh, double of_samples_at_isovalue = 0.0) {
  std::vector<double> all;
  std::mt19937_64 random(17);
  for (std::size_t k = 0; k < kTimes.size(); ++k)
    for (double value : closed_noise(mesh, 40 + k)) {
      if (value >= 0 && static_cast<double>(random() % 1000) < 1000 * of_samples_at_isovalue) value = 0.5;
      all.push_back(value);
    }
  return all;
}

template <int N>
Complex<N> at_step(const Complex<N>& complex, const std::vector<double>& values, std::size_t k) {
  Complex<N> result = complex;
  const std::size_t count = complex.points().size();
  result.set_values(std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(k * count),
                                        values.begin() + static_cast<std::ptrdiff_t>((k + 1) * count)));
  return result;
}

template <int N, class Real>
void expect_cuts_at_steps(const Complex<N>& complex, const std::vector<double>& values, Ambiguity ambiguity) {
  const Complex<N + 1> swept = in_time(complex, kTimes, values);
  const auto contour = extract<Real>(swept, 0.5, barycentric(ambiguity));
  for (std::size_t k = 0; k < kTimes.size(); ++k) {
    const auto cut = slice(contour, Hyperplane<N + 1>::across(N, kTimes[k]));
    const auto step = extract<Real>(at_step(complex, values, k), 0.5, barycentric(ambiguity));
    EXPECT_GT(step.simplices.size(), 100u);
    EXPECT_TRUE(same_surface(cut, step)) << "time " << kTimes[k];
  }
  for (const double t : {0.31, 0.99, 1.8}) {
    const auto cut = slice(contour, Hyperplane<N + 1>::across(N, t));
    EXPECT_GT(cut.simplices.size(), 100u);
    expect_closed_manifold(cut);
  }
}

TEST(InTime, CutsAtStepsAreTheContoursOfTheSteps) {
  const auto points = grid_points<3>({9, 9, 9}, 0.15);
  for (const MeshData<3>& mesh : {mixed_mesh(points, 7), kuhn_mesh(points), wedge_mesh(points), cube_mesh(points)})
    for (const Ambiguity a : {Ambiguity::low, Ambiguity::high})
      expect_cuts_at_steps<3, float>(mesh.complex(), noise_over_time(mesh), a);
}

TEST(InTime, CutsAtStepsHoldWhereValuesEqualTheIsovalue) {
  const auto mesh = mixed_mesh(grid_points<3>({9, 9, 9}, 0.15), 7);
  expect_cuts_at_steps<3, float>(mesh.complex(), noise_over_time(mesh, 0.2), Ambiguity::low);
  expect_cuts_at_steps<3, double>(mesh.complex(), noise_over_time(mesh, 0.2), Ambiguity::high);
}

TEST(InTime, CutsOfTwoDimensionalMeshesAreThoseOfTheSteps) {
  const auto points = grid_points<2>({50, 50}, 0.2);
  for (const MeshData<2>& mesh : {kuhn_mesh(points), cube_mesh(points)})
    expect_cuts_at_steps<2, float>(mesh.complex(), noise_over_time(mesh), Ambiguity::low);
}

TEST(InTime, NoiseThatBeginsAndEndsLowHasAClosedOrientedManifold) {
  const auto points = grid_points<3>({9, 9, 9}, 0.15);
  for (const MeshData<3>& mesh :
       {mixed_mesh(points, 7), kuhn_mesh(points), wedge_mesh(points), pyramid_mesh(points), cube_mesh(points, true)}) {
    std::vector<double> values = noise_over_time(mesh);
    const std::size_t count = mesh.points.size();
    for (std::size_t p = 0; p < count; ++p) values[p] = values[values.size() - count + p] = -1.0;
    Complex<4> swept = in_time(mesh.complex(), kTimes, values);
    for (const Ambiguity a : {Ambiguity::low, Ambiguity::high}) {
      const auto contour = extract<double>(swept, 0.5, barycentric(a));
      EXPECT_GT(contour.simplices.size(), 20000u);
      expect_closed_manifold(contour);
      EXPECT_GT(measure(contour).content.value(), 0.0);
    }
    const auto before = extract(swept, 0.5);
    swept.find_edges();
    ExtractOptions options;
    for (const unsigned threads : {1u, 2u, 3u}) {
      options.work.threads = threads;
      const auto after = extract(swept, 0.5, options);
      EXPECT_TRUE(before.vertices == after.vertices);
      EXPECT_TRUE(before.simplices == after.simplices);
    }
  }
}

TEST(InTime, MissingValuesLeaveAManifoldWithBoundary) {
  const auto mesh = mixed_mesh(grid_points<3>({8, 8, 8}, 0.15), 7);
  std::vector<double> values = noise_over_time(mesh);
  std::mt19937_64 random(2);
  for (double& value : values)
    if (random() % 20 == 0) value = std::numeric_limits<double>::quiet_NaN();
  const auto contour = extract<double>(in_time(mesh.complex(), kTimes, values), 0.5);
  EXPECT_GT(expect_oriented_manifold(contour).boundary_simplices, 100u);
}

/// A ball of radius 0.5 whose mesh moves with it has the same cut at all times, moved.
TEST(InTime, PointsMayMove) {
  const auto mesh = mixed_mesh(grid_points<3>({16, 16, 16}), 7);
  const Complex<3> complex = mesh.complex();
  std::vector<double> values;
  std::vector<std::array<double, 3>> points;
  for (const double t : kTimes)
    for (const auto& point : mesh.points) {
      values.push_back(0.5 - std::hypot(point[0], point[1], point[2]));
      points.push_back({point[0] + 2 * t, point[1] - t, point[2]});
    }
  const auto contour = extract<double>(in_time<3>(complex, kTimes, values, points), 0.0);
  const double volume = measure(extract<double>(at_step(complex, values, 0), 0.0)).content.value();
  for (const double t : {0.2, 0.7, 2.0}) {
    const auto cut = slice(contour, Hyperplane<4>::across(3, t));
    EXPECT_EQ(2, expect_closed_manifold(cut).euler);
    const Measures<3> measures = measure(cut);
    EXPECT_NEAR(volume, measures.content.value(), 1e-3);
    EXPECT_NEAR(2 * t, measures.centroid[0], 1e-2);
    EXPECT_NEAR(-t, measures.centroid[1], 1e-2);
  }
}

TEST(InTime, MovedPointsKeepLayersOnlyIfTheirTimesStay) {
  const auto mesh = kuhn_mesh(grid_points<2>({12, 12}, 0.2));
  const Complex<2> complex = mesh.complex();
  const std::size_t count = mesh.points.size();
  const std::vector<double> values = noise_over_time(mesh, 0.2);
  std::vector<Index> corners;
  for (std::size_t k = 0; k + 1 < kTimes.size(); ++k)
    for (std::size_t at = 0; at < mesh.corners.size(); at += 3)
      for (const std::size_t layer : {k, k + 1})
        for (std::size_t v = 0; v < 3; ++v) corners.push_back(static_cast<Index>(layer * count + mesh.corners[at + v]));
  Complex<3> swept = in_time(complex, kTimes, values);
  const auto of_wedges = [&] {
    Complex<3> wedges(swept.points(), CellType::wedge, corners);
    wedges.set_values(values);
    return extract<double>(wedges, 0.5, barycentric());
  };
  const auto contour = extract<double>(swept, 0.5, barycentric());
  EXPECT_TRUE(contour.simplices == of_wedges().simplices);
  EXPECT_FALSE(contour.vertices == of_wedges().vertices) << "vertices of layers are off the times";
  // the same times
  auto points = swept.points();
  std::vector<std::array<double, 2>> moved;
  for (auto& point : points) {
    point[0] += 3.0 * point[2];
    moved.push_back({point[0], point[1]});
  }
  swept.set_points(points);
  EXPECT_TRUE(extract<double>(in_time<2>(complex, kTimes, values, moved), 0.5, barycentric()).vertices ==
              extract<double>(swept, 0.5, barycentric()).vertices);
  EXPECT_FALSE(of_wedges().vertices == extract<double>(swept, 0.5, barycentric()).vertices);
  // other times
  for (auto& point : points) point[2] += 0.1 * point[0];
  swept.set_points(points);
  EXPECT_TRUE(of_wedges().vertices == extract<double>(swept, 0.5, barycentric()).vertices);
}

TEST(InTime, BadTimesAndNumbersOfValuesAreErrors) {
  const MeshData<3> mesh = kuhn_mesh(grid_points<3>({2, 2, 2}));
  const Complex<3> complex = mesh.complex();
  const auto refuse = [&](const std::string& part, std::vector<double> times, std::size_t values, std::size_t points) {
    const std::vector<double> all(values);
    const std::vector<std::array<double, 3>> moving(points);
    expect_error(ErrorCode::InvalidArgument, part, [&] { (void)in_time<3>(complex, times, all, moving); });
  };
  refuse("1 times; expected at least 2", {0.0}, 8, 0);
  refuse("time 2 is 1, after 1; expected ascending times", {0.0, 1.0, 1.0}, 24, 0);
  refuse("time 1 is inf", {0.0, std::numeric_limits<double>::infinity()}, 16, 0);
  refuse("15 values; expected 16: 8 points at 2 times", {0.0, 1.0}, 15, 0);
  refuse("8 moving points; expected 16", {0.0, 1.0}, 16, 8);
  std::vector<std::array<double, 3>> moving(16, {0, 0, 0});
  moving[10][1] = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorCode::InvalidArgument, "point 10: (0, nan, 0, 1); expected finite coordinates", [&] {
    (void)in_time<3>(complex, std::vector<double>{0.0, 1.0}, std::vector<double>(16), moving);
  });
}

}  // namespace
}  // namespace tegl
