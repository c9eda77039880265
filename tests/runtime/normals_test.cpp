// SPDX-License-Identifier: BSD-3-Clause
//
// Normals from gradients: exact for linear fields on grids of any kind, radial on spheres, the differences of theory
// section 10 on uneven axes, one for each vertex whatever the options, and the same for any number of threads.
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "fields.hpp"
#include "tegl/extract.hpp"
#include "tegl/slice.hpp"
#include "variants.hpp"

namespace tegl::test {
namespace {

ExtractOptions with_normals(ExtractOptions options = {}) {
  options.normals = true;
  return options;
}

template <int N, class Real>
double length(const std::array<Real, N>& v) {
  double square = 0;
  for (const Real x : v) square += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(square);
}

/// Uneven, backwards, sheared.
template <int N>
Grid<N> odd_grid() {
  std::array<std::size_t, N> sizes;
  for (int a = 0; a < N; ++a) sizes[a] = static_cast<std::size_t>(7 + a);
  Grid<N> grid = Grid<N>::unit(sizes);
  std::vector<double> uneven;
  for (std::size_t i = 0; i < sizes[0]; ++i) uneven.push_back(std::pow(1.3, static_cast<double>(i)));
  grid.axes[0] = Axis::rectilinear(uneven);
  grid.axes[1] = Axis::uniform(sizes[1], 5.0, -0.6);
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b) grid.linear(a, b) = a == b ? 1.0 + 0.2 * a : 0.1 * (a - 2 * b);
  grid.offset(0) = 3.0;
  return grid;
}

template <int N>
struct Plane {
  double operator()(const Point<N>& x) const {
    double sum = 0;
    for (int a = 0; a < N; ++a) sum += (a % 2 == 0 ? 0.7 + a : -1.1) * x[a];
    return sum;
  }
};

template <int N>
void expect_normals_of_a_plane() {
  const Grid<N> grid = odd_grid<N>();
  const auto image = sample_field<double, N>(grid, Plane<N>{});
  Eigen::Matrix<double, N, 1> slope;
  for (int a = 0; a < N; ++a) {
    Point<N> unit{};
    unit[a] = 1;
    slope(a) = Plane<N>{}(unit);
  }
  const Eigen::Matrix<double, N, 1> expected = (grid.linear.inverse().transpose() * slope).normalized();
  const double isovalue = image.values[image.values.size() / 2] + 0.01;
  for (ExtractOptions options : variants())
    for (const auto direction : {GradientDirection::descent, GradientDirection::ascent}) {
      options.direction = direction;
      options.close = direction == GradientDirection::ascent;
      SCOPED_TRACE(describe(options));
      const auto contour = extract<double>(image.view(), isovalue, with_normals(options));
      ASSERT_GT(contour.vertices.size(), 10u);
      ASSERT_EQ(contour.normals.size(), contour.vertices.size());
      for (const auto& normal : contour.normals)
        for (int a = 0; a < N; ++a)
          ASSERT_NEAR(normal[a], direction == GradientDirection::ascent ? expected(a) : -expected(a), 1e-12);
    }
}

TEST(Normals, OfALinearFieldAreExactOnAnyGrid) {
  expect_normals_of_a_plane<2>();
  expect_normals_of_a_plane<3>();
  expect_normals_of_a_plane<4>();
}

template <int N>
void expect_normals_of_a_sphere() {
  const auto image = sample_field<float, N>(centred_grid<N>(24, 1.0), Ball<N>{{}, 0.7});
  for (const ExtractOptions& options : variants()) {
    SCOPED_TRACE(describe(options));
    const auto contour = extract<float>(image.view(), 0.0, with_normals(options));
    for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
      ASSERT_NEAR((length<N, float>(contour.normals[v])), 1.0, 1e-5);
      double along = 0;
      for (int a = 0; a < N; ++a)
        along += static_cast<double>(contour.normals[v][a]) * static_cast<double>(contour.vertices[v][a]);
      ASSERT_GT((along / length<N, float>(contour.vertices[v])), 0.995) << "outwards, where values are low";
    }
  }
}

TEST(Normals, OfASphereAreRadial) {
  expect_normals_of_a_sphere<2>();
  expect_normals_of_a_sphere<3>();
  expect_normals_of_a_sphere<4>();
}

TEST(Normals, OnUnevenAxesAreMeansOfDifferenceQuotientsInterpolatedAlongTheEdge) {
  Grid<2> grid;
  grid.axes[0] = Axis::rectilinear({0.0, 1.0, 3.0, 4.0});
  grid.axes[1] = Axis::uniform(3, 0.0, 2.0);
  const std::vector<float> values{1, 2, 8, 9, 0, 1, 7, 9, 3, 4, 6, 8};
  const Image<float, 2> image(values.data(), grid);
  const auto contour = extract<double>(image, 4.0, with_normals());
  // The edge from (1, 2) to (3, 2): values 1 and 7, hence alpha 1/2.
  const std::array<double, 2> first{0.5 * ((1 - 0) / 1.0 + (7 - 1) / 2.0), 0.5 * ((1 - 2) / 2.0 + (4 - 1) / 2.0)};
  const std::array<double, 2> second{0.5 * ((7 - 1) / 2.0 + (9 - 7) / 1.0), 0.5 * ((7 - 8) / 2.0 + (6 - 7) / 2.0)};
  const std::array<double, 2> mean{(first[0] + second[0]) / 2, (first[1] + second[1]) / 2};
  bool found = false;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    if (contour.vertices[v] != std::array<double, 2>{2.0, 2.0}) continue;
    found = true;
    for (int a = 0; a < 2; ++a) EXPECT_NEAR(contour.normals[v][a], -mean[a] / std::hypot(mean[0], mean[1]), 1e-15);
  }
  EXPECT_TRUE(found);
}

template <int N>
void expect_normals_everywhere(const std::array<std::size_t, N>& sizes) {
  std::uint64_t seed = 1;
  for (ExtractOptions options : variants())
    for (const bool close : {false, true}) {
      options.close = close;
      SCOPED_TRACE(describe(options));
      auto image = noise_with_missing<float, N>(Grid<N>::unit(sizes), seed++, 0.05);
      for (std::size_t i = 3; i < image.values.size(); i += 97)
        image.values[i] = std::numeric_limits<float>::infinity();
      options.threads = 1;
      const auto bare = extract<float>(image.view(), 0.5, options);
      const auto contour = extract<float>(image.view(), 0.5, with_normals(options));
      EXPECT_TRUE(bare.normals.empty());
      EXPECT_EQ(contour.vertices, bare.vertices);
      EXPECT_EQ(contour.simplices, bare.simplices);
      ASSERT_EQ(contour.normals.size(), contour.vertices.size());
      for (const auto& normal : contour.normals) {
        const double size = length<N, float>(normal);
        ASSERT_TRUE(size == 0.0 || std::abs(size - 1.0) < 1e-5) << size;
      }
      options.threads = 3;
      EXPECT_EQ(extract<float>(image.view(), 0.5, with_normals(options)).normals, contour.normals);
    }
}

TEST(Normals, AreThereForEveryVertexNextToHolesAndOnCaps) {
  expect_normals_everywhere<2>({70, 40});
  expect_normals_everywhere<3>({67, 9, 12});
  expect_normals_everywhere<4>({9, 6, 5, 8});
}

TEST(Normals, AreZeroWhereTheGradientVanishes) {
  const std::vector<std::uint8_t> values{0, 1, 0, 1, 0, 1, 0, 1};  // differences cancel but at the border
  const auto contour =
      extract<float>(Image<std::uint8_t, 2>(values.data(), Grid<2>::unit({4, 2})), 0.5, with_normals());
  std::size_t zeros = 0;
  for (const auto& normal : contour.normals) zeros += (length<2, float>(normal)) == 0.0 ? 1 : 0;
  EXPECT_EQ(zeros, 2u);
}

TEST(Normals, AreRefusedWhereNoneAreMade) {
  const auto image = noise<float, 3>(4, 1);
  std::vector<std::array<float, 3>> vertices(1000);
  std::vector<std::array<Index, 3>> simplices(1000);
  const auto code_of = [](const auto& make) {
    try {
      make();
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::Cancelled;
  };
  const ContourRoom<3, float> room{vertices, simplices};
  EXPECT_EQ(code_of([&] { extract_into(image.view(), 0.5, room, with_normals()); }), ErrorCode::InvalidArgument);
  EXPECT_EQ(code_of([&] { slice_image(image.view(), 0.5, 1.5, with_normals()); }), ErrorCode::InvalidArgument);
  EXPECT_EQ(count(image.view(), 0.5, with_normals()), count(image.view(), 0.5));
}

}  // namespace
}  // namespace tegl::test
