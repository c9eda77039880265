// SPDX-License-Identifier: BSD-3-Clause
//
// The kinds of normals: the Sobel kernel against the thesis's, flat and geometric normals from the shape only,
// gradients at the vertices of any contour, and the error of each on analytic fields, its order, and in noise.
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "ambiguity/variants.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/eigen.hpp"
#include "tegl/extract.hpp"
#include "tegl/normals.hpp"
#include "tegl/slice.hpp"
#include "tegl/stream.hpp"

namespace tegl::test {
namespace {

template <int N, class Real>
double length(const std::array<Real, N>& v) {
  double square = 0;
  for (const Real x : v) square += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(square);
}

template <int N, class Real>
double largest_difference(const Buffer<std::array<Real, N>>& a, const Buffer<std::array<Real, N>>& b) {
  double largest = a.size() == b.size() ? 0.0 : 1e300;
  for (std::size_t v = 0; v < a.size() && v < b.size(); ++v)
    for (int i = 0; i < N; ++i)
      largest = std::max(largest, std::abs(static_cast<double>(a[v][i]) - static_cast<double>(b[v][i])));
  return largest;
}

ExtractOptions with(Normals kind, ExtractOptions options = {}) {
  options.normals = kind;
  return options;
}

// ---- Sobel ----

/// The kernels as printed in the thesis, continued to 4D by their rule: weights by the number of other axes along which
/// a sample is displaced, and the divisor.
template <int N>
std::pair<std::vector<double>, double> printed_kernel() {
  if constexpr (N == 2) return {{2, 1}, 8};
  if constexpr (N == 3) return {{6, 3, 2}, 52};
  if constexpr (N == 4) return {{12, 6, 4, 3}, 240};
}

/// Applies the whole kernel at once; for samples inside the image and steps of 1.
template <int N>
std::array<double, N> printed_sobel(const Image<double, N>& image, const std::array<std::size_t, N>& index) {
  const auto [weights, divisor] = printed_kernel<N>();
  std::array<double, N> gradient{};
  std::array<int, N> offset;
  offset.fill(-1);
  for (bool more = true; more;) {
    std::array<std::size_t, N> at = index;
    for (int a = 0; a < N; ++a) at[a] += static_cast<std::size_t>(offset[a]);
    for (int a = 0; a < N; ++a) {
      std::size_t away = 0;
      for (int b = 0; b < N; ++b) away += b != a && offset[b] != 0 ? 1 : 0;
      gradient[a] += offset[a] * weights[away] * image(at) / divisor;
    }
    int a = 0;
    for (; a < N && ++offset[a] > 1; ++a) offset[a] = -1;
    more = a < N;
  }
  return gradient;
}

template <int N>
void expect_printed_kernel(std::size_t samples) {
  const auto image = noise<double, N>(samples, 4);
  ExtractOptions options;
  options.epsilon = 0.01;
  const auto contour = extract<double>(image.view(), 0.5, with(Normals::sobel, options));
  std::size_t compared = 0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    std::array<std::size_t, N> low{}, high{};
    double alpha = 0;
    int between = 0;
    bool inside = true;
    for (int a = 0; a < N; ++a) {
      const double x = contour.vertices[v][a];
      low[a] = high[a] = static_cast<std::size_t>(x);
      if (x != std::floor(x)) {
        ++high[a];
        ++between;
        alpha = x - std::floor(x);
      }
      inside = inside && low[a] > 0 && high[a] + 1 < samples;
    }
    if (between != 1 || !inside) continue;
    ++compared;
    const auto here = printed_sobel<N>(image.view(), low);
    const auto there = printed_sobel<N>(image.view(), high);
    std::array<double, N> expected;
    for (int a = 0; a < N; ++a) expected[a] = -(here[a] + alpha * (there[a] - here[a]));
    const double size = length<N, double>(expected);
    for (int a = 0; a < N; ++a) ASSERT_NEAR(contour.normals[v][a], expected[a] / size, 1e-9) << "vertex " << v;
  }
  EXPECT_GT(compared, 50u);
}

TEST(Sobel, IsTheThesisKernelIn2dAnd3dAndItsRuleIn4d) {
  expect_printed_kernel<2>(20);
  expect_printed_kernel<3>(8);
  expect_printed_kernel<4>(6);
}

/// An uneven, reversed, sheared grid.
template <int N>
Grid<N> odd_grid() {
  Grid<N> grid;
  for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(static_cast<std::size_t>(5 + a), 1.0, 0.7);
  std::vector<double> uneven;
  for (int i = 0; i < 7; ++i) uneven.push_back(std::pow(1.3, i));
  grid.axes[0] = Axis::rectilinear(uneven);
  grid.axes[1] = Axis::uniform(6, 5.0, -0.6);
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b) grid.linear[a][b] = a == b ? 1.0 + 0.2 * a : 0.1 * (a - 2 * b);
  return grid;
}

template <int N>
void expect_exact_slopes() {
  const Grid<N> grid = odd_grid<N>();
  Eigen::Matrix<double, N, 1> slope;
  for (int a = 0; a < N; ++a) slope(a) = a % 2 == 0 ? 0.7 + a : -1.1;
  auto image = sample_field<double, N>(grid, [&](const Point<N>& x) {
    double sum = 0;
    for (int a = 0; a < N; ++a) sum += slope(a) * x[a];
    return sum;
  });
  const double isovalue = image.values[image.values.size() / 2] + 0.01;
  for (const bool missing : {false, true}) {
    // A line without two neighbouring samples is skipped; the others still give the slope.
    for (std::size_t i = 7; i < image.values.size() && missing; i += 31)
      image.values[i] = std::numeric_limits<double>::quiet_NaN();
    for (ExtractOptions options : variants()) {
      options.close = !missing;
      const auto contour = extract<double>(image.view(), isovalue, with(Normals::sobel, options));
      ASSERT_GT(contour.vertices.size(), 5u);
      const Eigen::Matrix<double, N, 1> expected = -(as_eigen(grid.linear).inverse().transpose() * slope).normalized();
      for (const auto& normal : contour.normals)
        for (int a = 0; a < N; ++a) ASSERT_NEAR(normal[a], expected(a), 1e-10) << "missing " << missing;
    }
  }
}

TEST(Sobel, OfALinearFieldIsExactOnGridsOfAnyKindToTheBorder) {
  expect_exact_slopes<2>();
  expect_exact_slopes<3>();
  expect_exact_slopes<4>();
}

TEST(Sobel, IsTheSameForAnyNumberOfThreadsAndForCutsFromTheImage) {
  const auto image = noise<float, 4>({9, 8, 7, 6}, 17);
  ExtractOptions one = with(Normals::sobel), many = one;
  one.work.threads = 1;
  many.work.threads = 4;
  const auto contour = extract<float>(image.view(), 0.5, one);
  EXPECT_EQ(contour.normals, extract<float>(image.view(), 0.5, many).normals);
  const auto cut = slice(contour, Hyperplane<4>::across(3, 2.0));
  const auto direct = slice_image(image.view(), 0.5, Hyperplane<4>::across(3, 2.0), one);
  ASSERT_EQ(cut.normals.size(), direct.normals.size());
  double sum = 0, direct_sum = 0;
  for (std::size_t v = 0; v < cut.normals.size(); ++v) {
    sum += static_cast<double>(cut.normals[v][0]);
    direct_sum += static_cast<double>(direct.normals[v][0]);
  }
  EXPECT_NEAR(sum, direct_sum, 1e-3);
}

TEST(Sobel, OfSteepFieldsAndInfiniteSamplesIsANumber) {
  auto image = noise<double, 3>(8, 9);
  for (std::size_t i = 0; i < image.values.size(); i += 7) image.values[i] = std::numeric_limits<double>::max();
  for (std::size_t i = 3; i < image.values.size(); i += 11) image.values[i] = -std::numeric_limits<double>::infinity();
  const auto contour = extract<double>(image.view(), 0.5, with(Normals::sobel));
  ASSERT_GT(contour.normals.size(), 100u);
  for (const auto& normal : contour.normals) {
    const double size = length<3, double>(normal);
    ASSERT_TRUE(size == 0.0 || std::abs(size - 1.0) < 1e-12) << size;
  }
}

// ---- gradients at the vertices of any contour ----

template <int N, class Real>
void expect_gradients_of_the_extraction(const Grid<N>& grid, double missing, double tolerance) {
  const auto image = noise_with_missing<float, N>(grid, 5, missing);
  for (const Normals kind : {Normals::differences, Normals::sobel})
    for (const auto direction : {GradientDirection::descent, GradientDirection::ascent}) {
      ExtractOptions options = with(kind);
      options.direction = direction;
      options.close = missing == 0.0;
      const auto contour = extract<Real>(image.view(), 0.5, options);
      const auto normals = gradient_normals(image.view(), contour, kind);
      ASSERT_GT(normals.size(), 20u);
      // If the gradient nearly vanishes, its direction is undefined, as at the vertex.
      EXPECT_LT((largest_difference<N, Real>(normals, contour.normals)), tolerance);
    }
}

TEST(GradientNormals, AreThoseOfTheExtraction) {
  expect_gradients_of_the_extraction<2, double>(Grid<2>::unit({30, 31}), 0.0, 1e-7);
  expect_gradients_of_the_extraction<3, double>(Grid<3>::unit({9, 8, 7}), 0.0, 1e-7);
  expect_gradients_of_the_extraction<3, double>(Grid<3>::unit({9, 8, 7}), 0.1, 1e-7);
  expect_gradients_of_the_extraction<3, float>(Grid<3>::unit({9, 8, 7}), 0.0, 2e-2);
  expect_gradients_of_the_extraction<3, double>(odd_grid<3>(), 0.0, 1e-7);
  expect_gradients_of_the_extraction<4, double>(odd_grid<4>(), 0.0, 1e-7);
}

TEST(GradientNormals, RefuseTheKindNone) {
  const auto image = noise<float, 2>(4, 1);
  const auto contour = extract<float>(image.view(), 0.5);
  try {
    gradient_normals(image.view(), contour, Normals::none);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
  }
}

TEST(GradientNormals, AreZeroOutsideOfTheImage) {
  const auto image = sample_field<double, 3>(centred_grid<3>(9, 1.3), Ball<3>{});
  auto contour = extract<double>(image.view(), 0.0);
  contour.vertices[0][0] = 2.0;
  const auto normals = gradient_normals(image.view(), contour);
  EXPECT_EQ((length<3, double>(normals[0])), 0.0);
  EXPECT_NEAR((length<3, double>(normals[1])), 1.0, 1e-12);
}

// ---- flat and geometric ----

template <int N>
void expect_flat_normals(std::size_t samples) {
  const auto image = noise<double, N>(samples, 3);
  for (const auto direction : {GradientDirection::descent, GradientDirection::ascent}) {
    ExtractOptions options;
    options.direction = direction;
    const auto contour = extract<double>(image.view(), 0.5, options);
    const auto normals = flat_normals(contour);
    ASSERT_EQ(normals.size(), contour.simplices.size());
    for (std::size_t s = 0; s < normals.size(); ++s) {
      const auto edges = edge_vectors(contour, s);
      const Eigen::Matrix<double, N, 1> normal = Eigen::Map<const Eigen::Matrix<double, N, 1>>(normals[s].data());
      ASSERT_NEAR(normal.norm(), 1.0, 1e-12);
      ASSERT_LT((edges.transpose() * normal).cwiseAbs().maxCoeff(), 1e-12);
      Eigen::Matrix<double, N, N> frame;
      frame.template leftCols<N - 1>() = edges;
      frame.col(N - 1) = normal;
      ASSERT_GT(frame.determinant(), 0.0);  // the side that the orientation faces
    }
  }
}

TEST(FlatNormals, ArePerpendicularToTheirSimplexAndFaceItsSide) {
  expect_flat_normals<2>(20);
  expect_flat_normals<3>(8);
  expect_flat_normals<4>(5);
}

TEST(FlatNormals, OfSimplicesWithoutSizeAreZero) {
  Contour<3, float> contour;
  contour.vertices = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  contour.simplices = {{0, 1, 2}};
  EXPECT_EQ(flat_normals(contour)[0], (std::array<float, 3>{}));
  const auto at_vertices = geometric_normals(contour);
  for (const auto& normal : at_vertices) EXPECT_EQ(normal, (std::array<float, 3>{}));
}

template <int N>
void expect_normals_of_a_plane(std::size_t samples) {
  const auto image = sample_field<double, N>(centred_grid<N>(samples, 1.0), [](const Point<N>& x) {
    double sum = 0.03;
    for (int a = 0; a < N; ++a) sum += (1.0 + a) * x[a];
    return sum;
  });
  const auto contour = extract<double>(image.view(), 0.0);
  std::array<double, N> expected;
  for (int a = 0; a < N; ++a) expected[a] = -(1.0 + a);
  const double size = length<N, double>(expected);
  for (const NormalWeights weights : {NormalWeights::area, NormalWeights::angle, NormalWeights::equal})
    for (const auto& normal : geometric_normals(contour, weights))
      for (int a = 0; a < N; ++a) ASSERT_NEAR(normal[a], expected[a] / size, 1e-9);
}

TEST(GeometricNormals, OfAPlaneAreItsOwn) {
  expect_normals_of_a_plane<2>(15);
  expect_normals_of_a_plane<3>(10);
  expect_normals_of_a_plane<4>(6);
}

/// The corner of a cube in 3-space, whose three squares are divided through the corner or beside it.
TEST(GeometricNormals, ByAngleDoNotDependOnHowAFlatFacetIsDivided) {
  const double third = 1.0 / std::sqrt(3.0);
  int other_by_area = 0;
  for (unsigned through = 0; through < 8; ++through) {
    Contour<3, double> contour;
    for (unsigned v = 0; v < 8; ++v)
      contour.vertices.push_back({1.0 * (v & 1u), 1.0 * (v >> 1 & 1u), 1.0 * (v >> 2 & 1u)});
    // Squares of the faces x = 1, y = 1, z = 1 around corner 7, seen from outside.
    constexpr std::array<std::array<Index, 4>, 3> kSquares = {{{7, 5, 1, 3}, {7, 3, 2, 6}, {7, 6, 4, 5}}};
    for (unsigned f = 0; f < 3; ++f) {
      const auto& q = kSquares[f];
      if ((through >> f & 1u) != 0) {
        contour.simplices.push_back({q[0], q[2], q[1]});
        contour.simplices.push_back({q[0], q[3], q[2]});
      } else {
        contour.simplices.push_back({q[0], q[3], q[1]});
        contour.simplices.push_back({q[1], q[3], q[2]});
      }
    }
    const auto by_angle = geometric_normals(contour, NormalWeights::angle)[7];
    for (const double x : by_angle) ASSERT_NEAR(x, by_angle[0] > 0 ? third : -third, 1e-12);
    const auto by_area = geometric_normals(contour, NormalWeights::area)[7];
    other_by_area += std::abs(std::abs(by_area[0]) - third) > 0.01 ? 1 : 0;
  }
  EXPECT_GT(other_by_area, 0) << "areas depend on it";
}

/// The corner of a tesseract, whose cubes are divided into a corner tetrahedron there (and others elsewhere), or into
/// six tetrahedra around their diagonal through it: the solid angles at a cube's corner add up to pi / 2 in both.
TEST(GeometricNormals, BySolidAngleDoNotDependOnHowAFlatCubeIsDivided) {
  for (unsigned through = 0; through < 16; ++through) {
    Contour<4, double> contour;
    for (unsigned v = 0; v < 16; ++v)
      contour.vertices.push_back({1.0 * (v & 1u), 1.0 * (v >> 1 & 1u), 1.0 * (v >> 2 & 1u), 1.0 * (v >> 3 & 1u)});
    const auto add = [&](std::array<Index, 4> simplex, int axis) {
      contour.simplices.push_back(simplex);
      const auto last = contour.simplices.size() - 1;
      if (flat_normals(contour)[last][axis] < 0) std::swap(contour.simplices[last][0], contour.simplices[last][1]);
    };
    for (int across = 0; across < 4; ++across) {  // the cube x_across = 1, at corner 15
      std::array<Index, 3> along;
      for (int a = 0, k = 0; a < 4; ++a)
        if (a != across) along[k++] = 1u << a;
      if ((through >> across & 1u) == 0) {
        add({15, 15 ^ along[0], 15 ^ along[1], 15 ^ along[2]}, across);
        continue;
      }
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          if (i != j) add({15, 15 ^ along[i], 15 ^ along[i] ^ along[j], 15 ^ along[0] ^ along[1] ^ along[2]}, across);
    }
    const auto normal = geometric_normals(contour, NormalWeights::angle)[15];
    for (const double x : normal) ASSERT_NEAR(x, 0.5, 1e-12) << "cubes " << through;
  }
}

TEST(GeometricNormals, AreTheSameForAnyNumberOfThreadsAndZeroForVerticesInNoSimplex) {
  const auto image = noise<float, 3>(24, 8);
  auto contour = extract<float>(image.view(), 0.5);
  contour.vertices.push_back({1, 2, 3});
  const auto one = geometric_normals(contour, NormalWeights::angle, {.threads = 1});
  EXPECT_EQ(one, geometric_normals(contour, NormalWeights::angle, {.threads = 4}));
  EXPECT_EQ(flat_normals(contour, {.threads = 1}), flat_normals(contour, {.threads = 4}));
  EXPECT_EQ(one.back(), (std::array<float, 3>{}));
  EXPECT_NEAR((length<3, float>(one.front())), 1.0, 1e-6);
}

TEST(GeometricNormals, StopWhereProgressSaysSo) {
  const auto image = noise<float, 3>(6, 8);
  const auto contour = extract<float>(image.view(), 0.5);
  const WorkOptions stop{.threads = 0, .progress = [](double) { return false; }};
  EXPECT_THROW(geometric_normals(contour, NormalWeights::area, stop), Error);
  EXPECT_THROW(flat_normals(contour, stop), Error);
  EXPECT_THROW(gradient_normals(image.view(), contour, Normals::sobel, stop), Error);
}

// ---- how exact ----

/// The root mean square of the angles between normals and those of a ball around the world origin.
template <int N>
double angular_error(const Contour<N, double>& contour, const Buffer<std::array<double, N>>& normals) {
  double sum = 0;
  for (std::size_t v = 0; v < normals.size(); ++v) {
    double square = 0;
    const double size = length<N, double>(contour.vertices[v]);
    for (int a = 0; a < N; ++a) square += std::pow(normals[v][a] - contour.vertices[v][a] / size, 2);
    const double angle = 2.0 * std::asin(std::min(1.0, std::sqrt(square) / 2.0));
    sum += angle * angle;
  }
  return std::sqrt(sum / static_cast<double>(normals.size()));
}

enum class GridKind { regular, smooth, rough, sheared };

/// Samples over [-1.3, 1.3], slightly off centre: regular; rectilinear with slowly varying steps; with alternating
/// steps; sheared.
template <int N>
Grid<N> grid_of(GridKind kind, std::size_t samples) {
  Grid<N> grid = centred_grid<N>(samples, 1.35);
  for (int a = 0; a < N; ++a) {
    const double step = grid.axes[a].step();
    std::vector<double> uneven;
    for (std::size_t i = 0; i < samples; ++i) {
      const double x = grid.axes[a].origin() + static_cast<double>(i) * step + step * 0.17 * (a + 1);
      uneven.push_back(kind == GridKind::smooth ? x + 0.15 * std::sin(2.0 * x) : x + (i % 2 == 0 ? 0.2 * step : 0.0));
    }
    grid.axes[a] = kind == GridKind::smooth || kind == GridKind::rough
                       ? Axis::rectilinear(uneven)
                       : Axis::uniform(samples, grid.axes[a].origin() + step * 0.17 * (a + 1), step);
    if (kind == GridKind::sheared && a + 1 < N) grid.linear[a][a + 1] = 0.3;
  }
  return grid;
}

/// A ball in world coordinates, as a square root with non-vanishing derivatives.
template <int N>
OwnedImage<double, N> ball_in_world(const Grid<N>& grid) {
  return sample_field<double, N>(grid, [&](const Point<N>& x) {
    Eigen::Matrix<double, N, 1> at;
    for (int a = 0; a < N; ++a) at(a) = x[a];
    return 0.8 - (as_eigen(grid.linear) * at).norm();
  });
}

struct Expected {
  GridKind grid;
  double gradient_order;  ///< minimum
};

template <int N>
void expect_orders(std::size_t samples) {
  const double second = N == 4 ? 1.5 : 1.7;  // 4D grids are coarse
  for (const Expected& expected : {Expected{GridKind::regular, second}, Expected{GridKind::smooth, second},
                                   Expected{GridKind::sheared, second}, Expected{GridKind::rough, 0.8}}) {
    double errors[2][2], geometric[2];
    for (int level = 0; level < 2; ++level) {
      const auto image = ball_in_world<N>(grid_of<N>(expected.grid, level == 0 ? samples : 2 * samples - 1));
      for (const Normals kind : {Normals::differences, Normals::sobel}) {
        const auto contour = extract<double>(image.view(), 0.0, with(kind));
        errors[kind == Normals::sobel ? 1 : 0][level] = angular_error<N>(contour, contour.normals);
        geometric[level] = angular_error<N>(contour, geometric_normals(contour));
      }
    }
    SCOPED_TRACE(testing::Message() << N << "D, grid " << static_cast<int>(expected.grid) << ": differences "
                                    << errors[0][0] << ' ' << errors[0][1] << ", Sobel " << errors[1][0] << ' '
                                    << errors[1][1] << ", geometric " << geometric[0] << ' ' << geometric[1]);
    EXPECT_GT(convergence_order(errors[0][0], errors[0][1]), expected.gradient_order);
    EXPECT_GT(convergence_order(errors[1][0], errors[1][1]), expected.gradient_order);
    EXPECT_GT(convergence_order(geometric[0], geometric[1]), 0.6);
    if (expected.grid != GridKind::rough) {
      EXPECT_LT(errors[0][1], geometric[1]);
    }
  }
}

TEST(NormalErrors, AreOfSecondOrderForGradientsOfFirstOnRoughGridsAndForTheShape) {
  expect_orders<2>(33);
  expect_orders<3>(17);
  expect_orders<4>(11);
}

/// In independent noise, the error of a weighted mean of lines is the error of one line times the root of the sum of
/// squared weights.
template <int N>
void expect_damped_noise(std::size_t samples, double factor) {
  constexpr double kNoise = 1e-3;
  auto image = sample_field<double, N>(Grid<N>::unit([&] {
                                         std::array<std::size_t, N> sizes;
                                         sizes.fill(samples);
                                         return sizes;
                                       }()),
                                       [](const Point<N>& x) { return x[0]; });
  const auto random = noise<double, N>(samples, 12);
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] += kNoise * (random.values[i] - 0.5);
  const auto error = [&](Normals kind) {
    // Near samples, whose gradients by differences are independent of those at the other ends of the edges.
    const auto contour = extract<double>(image.view(), 0.5 * static_cast<double>(samples) + 0.01, with(kind));
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t v = 0; v < contour.normals.size(); ++v) {
      bool inside = true;
      for (int a = 1; a < N; ++a)
        inside = inside && contour.vertices[v][a] >= 1.0 && contour.vertices[v][a] <= static_cast<double>(samples - 2);
      for (int a = 1; a < N && inside; ++a) sum += contour.normals[v][a] * contour.normals[v][a];
      count += inside ? 1 : 0;
    }
    EXPECT_GT(count, 100u);
    return std::sqrt(sum / static_cast<double>(count));
  };
  EXPECT_NEAR(error(Normals::sobel) / error(Normals::differences), factor, 0.12 * factor) << N << 'D';
}

TEST(NormalErrors, InNoiseAreSmallerForSobelByItsWeights) {
  expect_damped_noise<2>(400, std::sqrt(6.0) / 4.0);
  expect_damped_noise<3>(40, std::sqrt(88.0) / 26.0);
  expect_damped_noise<4>(14, std::sqrt(624.0) / 120.0);
}

}  // namespace
}  // namespace tegl::test
