// SPDX-License-Identifier: BSD-3-Clause
//
// Delaunay triangulations of scattered points, also in degenerate position, and contours of them.
#include "tegl/delaunay.hpp"

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "errors.hpp"
#include "invariants.hpp"
#include "tegl/measure.hpp"

namespace tegl {
namespace {

using namespace test;

template <int N>
using Points = std::vector<std::array<double, N>>;

template <int N>
Points<N> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> anywhere(-1.0, 1.0);
  Points<N> points(count);
  for (auto& point : points)
    for (double& x : point) x = anywhere(random);
  return points;
}

template <int N>
Points<N> grid(std::size_t samples) {
  Points<N> points;
  std::array<std::size_t, N> index{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(std::pow(samples, N) + 0.5); ++i) {
    auto& point = points.emplace_back();
    for (int a = 0; a < N; ++a) point[a] = static_cast<double>(index[a]) / static_cast<double>(samples - 1) * 2 - 1;
    for (int a = 0; a < N && ++index[a] == samples; ++a) index[a] = 0;
  }
  return points;
}

template <int N>
constexpr CellType kSimplex = N == 2   ? CellType::triangle
                              : N == 3 ? CellType::tetrahedron
                                       : CellType::simplex4;

/// Points with whole coordinates on concentric spheres, so that many are on one sphere without others inside.
template <int N>
Points<N> on_spheres(int most) {
  Points<N> points;
  std::array<int, N> at;
  at.fill(-most);
  for (bool is_in = true; is_in;) {
    int square = 0;
    for (const int x : at) square += x * x;
    if (square <= most * most && square % 3 != 1) {
      auto& point = points.emplace_back();
      for (int a = 0; a < N; ++a) point[a] = static_cast<double>(at[a]) / most;
    }
    int a = 0;
    while (a < N && ++at[a] > most) at[a++] = -most;
    is_in = a < N;
  }
  return points;
}

/// The volume of the part of a simplex with values above the isovalue, times N!: by the definition of linear
/// interpolation, a sum over the corners that are high.
template <int N>
double content_above(const Points<N>& points, const std::vector<double>& values, const Index* corners,
                     double isovalue) {
  Eigen::Matrix<double, N, N> edges;
  for (int k = 0; k < N; ++k)
    for (int i = 0; i < N; ++i) edges(i, k) = points[corners[k + 1]][i] - points[corners[0]][i];
  std::array<double, N + 1> f;
  bool all_high = true;
  for (int i = 0; i <= N; ++i) {
    f[i] = values[corners[i]] - isovalue;
    all_high = all_high && f[i] >= 0;
  }
  double part = all_high ? 1.0 : 0.0;
  for (int i = 0; i <= N && !all_high; ++i) {
    if (f[i] < 0) continue;
    double term = 1.0;
    for (int j = 0; j <= N; ++j)
      if (j != i) term *= f[i] / (f[i] - f[j]);
    part += term;
  }
  return part * std::abs(edges.determinant());
}

template <int N>
double content_above(const Complex<N>& complex, const Points<N>& points, double isovalue) {
  const std::vector<Index> corners = delaunay_corners<N>(points);
  double sum = 0.0;
  for (std::size_t c = 0; c < corners.size(); c += N + 1)
    sum += content_above<N>(points, complex.values(), corners.data() + c, isovalue);
  for (int n = 2; n <= N; ++n) sum /= n;
  return sum;
}

template <int N>
void expect_closed_contour(const Complex<N>& complex, const Points<N>& points) {
  const auto contour = extract<double>(complex, 0.5);
  EXPECT_GT(contour.simplices.size(), 20u);
  const MeshReport report = check(contour);
  EXPECT_EQ(report.boundary_simplices, 0u);
  EXPECT_EQ(report.nonmanifold_simplices, 0u);
  EXPECT_EQ(report.bad_links, 0u);
  EXPECT_EQ(report.orientation_conflicts, 0u);
  const double content = content_above<N>(complex, points, 0.5);
  EXPECT_NEAR(content, measure(contour).content.value_or(-1.0), 1e-7 * content);
}

/// Sets noise that is low near the border, and expects a closed manifold around the part that is above by definition.
template <int N>
void expect_closed_noise(const Points<N>& points, const std::string& name, std::size_t least_cells = 0) {
  if (!has_delaunay()) GTEST_SKIP() << "no Qhull";
  SCOPED_TRACE(name + " in " + std::to_string(N) + "D");
  Complex<N> complex = delaunay<N>(points);
  std::mt19937 random(5);
  std::vector<double> values;
  for (const auto& point : points) {
    double most = 0.0, square = 0.0;
    for (const double x : point) {
      most = std::max(most, std::abs(x));
      square += x * x;
    }
    const bool is_inside = name == "spheres" ? square < 0.5 : most < 0.75;
    values.push_back(is_inside ? std::uniform_real_distribution<double>()(random) : 0.0);
  }
  complex.set_values(values);
  EXPECT_GE(complex.cell_count(), least_cells);
  expect_closed_contour<N>(complex, points);
  if (name == "random") return;
  // the same cells by the constructor, which computes the orientation of each from rounded coordinates
  Complex<N> again(points, kSimplex<N>, delaunay_corners<N>(points));
  again.set_values(values);
  expect_closed_contour<N>(again, points);
}

TEST(Delaunay, NoiseOnRandomPointsHasAClosedOrientedManifold) {
  expect_closed_noise<2>(random_points<2>(2000, 1), "random");
  expect_closed_noise<3>(random_points<3>(3000, 2), "random");
  expect_closed_noise<4>(random_points<4>(1500, 3), "random");
}

TEST(Delaunay, GridsWhosePointsAreOnCommonSpheresAreTriangulated) {
  expect_closed_noise<2>(grid<2>(21), "grid");
  expect_closed_noise<3>(grid<3>(11), "grid");
  expect_closed_noise<4>(grid<4>(6), "grid");
  expect_closed_noise<4>(grid<4>(7), "grid");
}

TEST(Delaunay, PointsOnCommonSpheresAreTriangulated) {
  expect_closed_noise<2>(on_spheres<2>(15), "spheres");
  expect_closed_noise<3>(on_spheres<3>(6), "spheres");
  expect_closed_noise<4>(on_spheres<4>(4), "spheres");
}

TEST(Delaunay, AHundredThousandCells) {
  constexpr std::size_t kCells = 100000;
  expect_closed_noise<2>(random_points<2>(51000, 1), "random", kCells);
  expect_closed_noise<3>(random_points<3>(16000, 2), "random", kCells);
  expect_closed_noise<4>(random_points<4>(5000, 3), "random", kCells);
  expect_closed_noise<2>(grid<2>(226), "grid", kCells);
  expect_closed_noise<3>(grid<3>(28), "grid", kCells);
  expect_closed_noise<4>(grid<4>(10), "grid", kCells);
  expect_closed_noise<2>(on_spheres<2>(175), "spheres", kCells);
  expect_closed_noise<3>(on_spheres<3>(19), "spheres", kCells);
  expect_closed_noise<4>(on_spheres<4>(7), "spheres", kCells);
}

TEST(Delaunay, TheFlatCellsOfAGridKeepTheirOrientationOverTime) {
  if (!has_delaunay()) GTEST_SKIP() << "no Qhull";
  const Points<3> points = grid<3>(8);
  const Complex<3> complex(points, CellType::tetrahedron, delaunay_corners<3>(points));
  std::mt19937 random(9);
  std::vector<double> values;
  for (int k = 0; k < 4; ++k)
    for (const auto& p : points)
      values.push_back(std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}) < 0.9
                           ? std::uniform_real_distribution<double>()(random)
                           : 0.0);
  const MeshReport report = check(extract<double>(in_time<3>(complex, std::array{0.0, 0.3, 0.7, 1.1}, values), 0.5));
  EXPECT_EQ(report.orientation_conflicts, 0u);
}

TEST(Delaunay, TheSmallestNumberOfPointsIsOneCell) {
  if (!has_delaunay()) GTEST_SKIP() << "no Qhull";
  EXPECT_EQ(delaunay<2>(Points<2>{{0, 0}, {1, 0}, {0, 1}}).cell_count(), 1u);
  EXPECT_EQ(delaunay<3>(Points<3>{{5, 0, 0}, {0, 7, 0}, {0, 0, 9}, {1e-3, 0, 0}}).cell_count(), 1u);
  EXPECT_EQ(delaunay<4>(Points<4>{{}, {1}, {0, 1}, {0, 0, 1}, {0, 0, 0, -1}}).cell_count(), 1u);
  EXPECT_EQ(delaunay<2>(Points<2>{{0, 0}, {1, 0}, {0, 1}, {1, 1}}).cell_count(), 2u);
  expect_error(ErrorCode::InvalidArgument, "3 points that lie in a line; expected points in 2 dimensions", [] {
    (void)delaunay<2>(Points<2>{{0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}});
  });
  expect_error(ErrorCode::InvalidArgument, "4 points that lie in a line", [] {
    (void)delaunay<2>(Points<2>{{0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}, {0.7, 0.7}});
  });
  expect_error(ErrorCode::InvalidArgument, "4 points that lie in a plane", [] {
    (void)delaunay<3>(Points<3>{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {4, 5, 1}});
  });
  expect_error(ErrorCode::InvalidArgument, "5 points that lie in a hyperplane", [] {
    (void)delaunay<4>(Points<4>{{1, 1}, {2, 3}, {0, 1}, {0, 0, 1}, {0, 0, 3}});
  });
}

TEST(Delaunay, AreaAndVolumeConvergeWithOrderTwo) {
  if (!has_delaunay()) GTEST_SKIP() << "no Qhull";
  constexpr double kPi = std::numbers::pi;
  const auto ball = [](const std::array<double, 3>& x) { return 0.7 - std::hypot(x[0], x[1], x[2]); };
  const auto ring = [](const std::array<double, 3>& x) {
    return 0.25 - std::hypot(std::hypot(x[0], x[1]) - 0.55, x[2]);
  };
  const auto errors = [&](std::size_t count, const auto& field, double area, double volume, int euler) {
    const Points<3> points = random_points<3>(count, 4);
    Complex<3> complex = delaunay<3>(points);
    std::vector<double> values;
    for (const auto& p : points) values.push_back(field(p));
    complex.set_values(values);
    const auto surface = extract<double>(complex, 0.0);
    EXPECT_EQ(expect_closed_manifold(surface).euler, euler);
    return std::array{area - measure(surface).size, volume - measure(surface).content.value()};
  };
  const auto expect_order_two = [&](const auto& field, double area, double volume, int euler) {
    // 8 times as many points have half the distance
    const auto coarse = errors(5000, field, area, volume, euler), fine = errors(40000, field, area, volume, euler);
    for (const std::size_t k : {0u, 1u}) EXPECT_NEAR(2.0, std::log2(coarse[k] / fine[k]), 0.35) << k;
  };
  expect_order_two(ball, 4 * kPi * 0.49, 4.0 / 3.0 * kPi * 0.343, 2);
  expect_order_two(ring, 4 * kPi * kPi * 0.55 * 0.25, 2 * kPi * kPi * 0.55 * 0.0625, 0);
}

TEST(Delaunay, BadPointsAreNamed) {
  if (!has_delaunay()) GTEST_SKIP() << "no Qhull";
  Points<3> points = random_points<3>(50, 6);
  expect_error(ErrorCode::InvalidArgument, "3 points in 3D; expected at least 4",
               [&] { (void)delaunay<3>(std::span(points).first(3)); });
  points[17] = points[5];
  expect_error(ErrorCode::InvalidArgument, "points 5 and 17 are equal", [&] { (void)delaunay<3>(points); });
  points[17][1] = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorCode::InvalidArgument, "point 17 has the coordinate nan", [&] { (void)delaunay<3>(points); });
  Points<3> flat = random_points<3>(50, 7);
  for (auto& p : flat) p[2] = 0.25;
  expect_error(ErrorCode::InvalidArgument, "50 points that lie in a plane", [&] { (void)delaunay<3>(flat); });
  Points<2> line;
  for (int i = 0; i < 9; ++i) line.push_back({double(i), 2.0 * i});
  expect_error(ErrorCode::InvalidArgument, "in a line", [&] { (void)delaunay<2>(line); });
  Points<2> close = random_points<2>(50, 8);
  close.push_back({close[3][0] + 1e-15, close[3][1]});
  expect_error(ErrorCode::InvalidArgument, "so close to other points", [&] { (void)delaunay<2>(close); });
}

}  // namespace
}  // namespace tegl
