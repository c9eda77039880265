// SPDX-License-Identifier: BSD-3-Clause
//
// Sampling at vertices: exact for multilinear fields on all kinds of grids, NaN exactly where the image is undefined,
// and the isovalue if the image is the contour's own.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "fields.hpp"
#include "tegl/eigen.hpp"
#include "tegl/extract.hpp"
#include "tegl/sample.hpp"

namespace tegl::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// An uneven, reversed and sheared grid around the unit ball.
template <int N>
Grid<N> odd_grid() {
  Grid<N> grid;
  for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(static_cast<std::size_t>(5 + a), -2.5, 5.0 / (4 + a));
  std::vector<double> uneven;
  for (int i = 0; i <= 6; ++i) uneven.push_back(2.5 - 5.0 * std::pow(i / 6.0, 1.4));
  grid.axes[0] = Axis::rectilinear(uneven);
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b) grid.linear[a][b] = a == b ? 1.0 + 0.1 * a : 0.03 * (a - 2 * b);
  grid.offset[0] = 0.1;
  return grid;
}

/// A function that is linear in world coordinates, for any grid.
template <int N>
double plane(const std::array<double, N>& x) {
  double sum = 0.25;
  for (int a = 0; a < N; ++a) sum += (a % 2 == 0 ? 0.7 + a : -1.1) * x[a];
  return sum;
}

template <int N>
OwnedImage<double, N> plane_image(const Grid<N>& grid) {
  OwnedImage<double, N> image{grid, std::vector<double>(sample_count(grid))};
  for_each_sample<N>(grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    Eigen::Matrix<double, N, 1> x;
    for (int a = 0; a < N; ++a) x(a) = grid.axes[a][index[a]];
    x = (as_eigen(grid.linear) * x + as_eigen(grid.offset)).eval();
    std::array<double, N> world;
    for (int a = 0; a < N; ++a) world[a] = x(a);
    image.values[i] = plane<N>(world);
  });
  return image;
}

template <int N, class Real>
void expect_linear_fields_to_be_exact(std::size_t samples, double tolerance) {
  const auto ball = sample_field<float, N>(centred_grid<N>(samples, 1.3), Ball<N>{});
  const auto contour = extract<Real>(ball.view(), 0.0);
  const auto image = plane_image<N>(odd_grid<N>());
  const Attribute attribute = sample(image.view(), contour, "plane", "K");
  EXPECT_EQ(attribute.name, "plane");
  EXPECT_EQ(attribute.unit, "K");
  EXPECT_EQ(attribute.width, 1);
  ASSERT_EQ(attribute.values.size(), contour.vertices.size());
  ASSERT_GT(contour.vertices.size(), 10u);
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    std::array<double, N> x;
    for (int a = 0; a < N; ++a) x[a] = static_cast<double>(contour.vertices[v][a]);
    ASSERT_NEAR(attribute.values[v], plane<N>(x), tolerance) << "vertex " << v;
  }
}

TEST(Sample, OfALinearFieldIsExactOnUnevenBackwardAndShearedGrids) {
  expect_linear_fields_to_be_exact<2, double>(20, 1e-13);
  expect_linear_fields_to_be_exact<3, double>(12, 1e-13);
  expect_linear_fields_to_be_exact<4, double>(8, 1e-13);
  expect_linear_fields_to_be_exact<5, double>(5, 1e-13);
  expect_linear_fields_to_be_exact<3, float>(12, 1e-13);  // vertices are rounded, values at them are not
}

/// Points on edges of the grid have the isovalue for all types; points inside tiles need not.
template <Value T, int N>
void expect_the_isovalue(std::size_t samples) {
  const auto image = noise<T, N>(samples, 5);
  const double isovalue = noise_isovalue<T>();
  const auto contour = extract<double>(image.view(), isovalue);
  const Attribute attribute = sample(image.view(), contour, "own");
  const double scale = std::is_floating_point_v<T> ? 1.0 : std::ldexp(1.0, 8 * sizeof(T));
  std::size_t on_edges = 0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    int between = 0;
    for (const double x : contour.vertices[v]) between += x != std::floor(x) ? 1 : 0;
    if (between > 1) continue;
    ++on_edges;
    ASSERT_NEAR(attribute.values[v], isovalue, 1e-12 * scale);
  }
  EXPECT_GT(on_edges, contour.vertices.size() / 2);
}

TEST(Sample, OfTheContoursOwnImageIsTheIsovalue) {
  expect_the_isovalue<std::uint8_t, 2>(30);
  expect_the_isovalue<std::int8_t, 3>(8);
  expect_the_isovalue<std::uint16_t, 3>(8);
  expect_the_isovalue<std::int16_t, 3>(8);
  expect_the_isovalue<std::int32_t, 3>(8);
  expect_the_isovalue<float, 3>(8);
  expect_the_isovalue<double, 4>(5);
}

/// Beside missing samples each vertex lies on an edge between two existing ones.
template <class Real>
void expect_missing_samples_to_spoil_nothing() {
  Grid<3> grid = Grid<3>::unit({12, 11, 10});
  grid.linear = {{{0.9, 0.2, 0.0}, {-0.3, 1.1, 0.1}, {0.0, 0.2, 1.3}}};
  const auto image = noise_with_missing<float, 3>(grid, 3, 0.2);
  const auto contour = extract<Real>(image.view(), 0.5);
  const Attribute attribute = sample(image.view(), contour, "own");
  ASSERT_GT(contour.vertices.size(), 100u);
  const double tolerance = sizeof(Real) == 4 ? 1e-4 : 1e-9;
  for (const double value : attribute.values) ASSERT_NEAR(value, 0.5, tolerance);
}

TEST(Sample, IsNotSpoiltByMissingSamplesThatDoNotCount) {
  expect_missing_samples_to_spoil_nothing<double>();
  expect_missing_samples_to_spoil_nothing<float>();
}

/// A contour of isolated points at given positions.
Contour<2, double> points(const std::vector<std::array<double, 2>>& places) {
  Contour<2, double> contour;
  contour.vertices.assign(places.begin(), places.end());
  return contour;
}

TEST(Sample, IsNaNOutsideAndWhereSamplesAreMissing) {
  const std::vector<double> values = {0, 1, 2, 10, kNan, 12, 20, 21, 22};
  const Image<double, 2> image(values.data(), Grid<2>::unit({3, 3}));
  const auto contour = points(
      {{0.0, 0.0}, {2.0, 2.0}, {1.5, 0.0}, {1.5, 0.5}, {1.0, 1.0}, {2.0, 1.5}, {2.2, 1.0}, {0.0, -0.2}, {kNan, 0}});
  const Attribute attribute = sample(image, contour, "v");
  const std::vector<double> expected = {0, 22, 1.5, kNan, kNan, 17, kNan, kNan, kNan};
  for (std::size_t i = 0; i < expected.size(); ++i)
    if (std::isnan(expected[i]))
      EXPECT_TRUE(std::isnan(attribute.values[i])) << "point " << i << ": " << attribute.values[i];
    else
      EXPECT_EQ(attribute.values[i], expected[i]) << "point " << i;
}

TEST(Sample, TakesTheBorderForItselfUpToAThousandthOfAStep) {
  const std::vector<double> values = {0, 1, 2, 10, 11, 12};
  const Image<double, 2> image(values.data(), Grid<2>::unit({3, 2}));
  const Attribute attribute = sample(image, points({{-0.0009, 0.0}, {2.0009, 1.0}, {-0.0011, 0.0}, {1, 1.0011}}), "v");
  EXPECT_EQ(attribute.values[0], 0.0);
  EXPECT_EQ(attribute.values[1], 12.0);
  EXPECT_TRUE(std::isnan(attribute.values[2]));
  EXPECT_TRUE(std::isnan(attribute.values[3]));
}

TEST(Sample, AlongAnAxisOfOneSampleHasItsValuesThereAlone) {
  const std::vector<double> values = {0, 1, 2};
  Grid<2> grid = Grid<2>::unit({3, 1});
  grid.axes[1] = Axis::uniform(1, 4.0, 2.0);
  const Attribute attribute = sample(Image<double, 2>(values.data(), grid), points({{1.5, 4.0}, {1.5, 5.0}}), "v");
  EXPECT_EQ(attribute.values[0], 1.5);
  EXPECT_TRUE(std::isnan(attribute.values[1]));
}

TEST(Sample, IsTheSameForAnyNumberOfThreadsAndStrides) {
  const auto image = noise<float, 3>(24, 8);
  const auto contour = extract<float>(image.view(), 0.5);
  const Attribute one = sample(image.view(), contour, "v", "", {.threads = 1});
  const Attribute many = sample(image.view(), contour, "v", "", {.threads = 4});
  std::vector<float> turned(image.values.begin(), image.values.end());
  std::reverse(turned.begin(), turned.end());
  const Image<float, 3> backwards(turned.data() + turned.size() - 1, image.grid, {-1, -24, -24 * 24});
  const Attribute same = sample(backwards, contour, "v");
  ASSERT_GT(one.values.size(), 10000u);
  EXPECT_EQ(std::memcmp(one.values.data(), many.values.data(), one.values.size() * sizeof(double)), 0);
  EXPECT_EQ(std::memcmp(one.values.data(), same.values.data(), one.values.size() * sizeof(double)), 0);
}

TEST(Sample, StopsWhereProgressSaysSo) {
  const auto image = noise<float, 3>(6, 8);
  const auto contour = extract<float>(image.view(), 0.5);
  try {
    sample(image.view(), contour, "v", "", {.progress = [](double) { return false; }});
    FAIL() << "not stopped";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

}  // namespace
}  // namespace tegl::test
