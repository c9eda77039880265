// SPDX-License-Identifier: BSD-3-Clause
//
// Normals from gradients: exact for linear fields on all kinds of grids, radial on spheres, the differences of theory
// section 10 on uneven axes, one per vertex for all options, and equal for any number of threads.
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "ambiguity/variants.hpp"
#include "fields.hpp"
#include "tegl/eigen.hpp"
#include "tegl/extract.hpp"
#include "tegl/normals.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

ExtractOptions with_normals(ExtractOptions options = {}, Normals kind = Normals::differences) {
  options.normals = kind;
  return options;
}

template <int N, class Real>
double norm_of(const std::array<Real, N>& v) {
  double square = 0;
  for (const Real x : v) square += static_cast<double>(x) * static_cast<double>(x);
  return std::sqrt(square);
}

/// An uneven, reversed, sheared grid.
template <int N>
Grid<N> reversed_grid() {
  std::array<std::size_t, N> sizes;
  for (int a = 0; a < N; ++a) sizes[a] = static_cast<std::size_t>(7 + a);
  Grid<N> grid = Grid<N>::unit(sizes);
  std::vector<double> uneven;
  for (std::size_t i = 0; i < sizes[0]; ++i) uneven.push_back(std::pow(1.3, static_cast<double>(i)));
  grid.axes[0] = Axis::rectilinear(uneven);
  grid.axes[1] = Axis::uniform(sizes[1], 5.0, -0.6);
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b) grid.linear[a][b] = a == b ? 1.0 + 0.2 * a : 0.1 * (a - 2 * b);
  grid.offset[0] = 3.0;
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
  const Grid<N> grid = reversed_grid<N>();
  const auto image = sample_field<double, N>(grid, Plane<N>{});
  Eigen::Matrix<double, N, 1> slope;
  for (int a = 0; a < N; ++a) {
    Point<N> unit{};
    unit[a] = 1;
    slope(a) = Plane<N>{}(unit);
  }
  const Eigen::Matrix<double, N, 1> expected = (as_eigen(grid.linear).inverse().transpose() * slope).normalized();
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
      ASSERT_NEAR((norm_of<N, float>(contour.normals[v])), 1.0, 1e-5);
      double along = 0;
      for (int a = 0; a < N; ++a)
        along += static_cast<double>(contour.normals[v][a]) * static_cast<double>(contour.vertices[v][a]);
      ASSERT_GT((along / norm_of<N, float>(contour.vertices[v])), 0.995) << "outwards, where values are low";
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
      options.work.threads = 1;
      const auto bare = extract<float>(image.view(), 0.5, options);
      const auto contour = extract<float>(image.view(), 0.5, with_normals(options));
      EXPECT_TRUE(bare.normals.empty());
      EXPECT_EQ(contour.vertices, bare.vertices);
      EXPECT_EQ(contour.simplices, bare.simplices);
      ASSERT_EQ(contour.normals.size(), contour.vertices.size());
      for (const auto& normal : contour.normals) {
        const double size = norm_of<N, float>(normal);
        ASSERT_TRUE(size == 0.0 || std::abs(size - 1.0) < 1e-5) << size;
      }
      options.work.threads = 3;
      EXPECT_EQ(extract<float>(image.view(), 0.5, with_normals(options)).normals, contour.normals);
    }
}

TEST(Normals, AreThereForEveryVertexNextToHolesAndOnCaps) {
  expect_normals_everywhere<2>({70, 40});
  expect_normals_everywhere<3>({67, 9, 12});
  expect_normals_everywhere<4>({9, 6, 5, 8});
}

TEST(Normals, AreZeroWhereTheGradientVanishes) {
  const std::vector<std::uint8_t> values{0, 1, 0, 1, 0, 1, 0, 1};  // differences cancel except at the border
  const auto contour =
      extract<float>(Image<std::uint8_t, 2>(values.data(), Grid<2>::unit({4, 2})), 0.5, with_normals());
  std::size_t zeros = 0;
  for (const auto& normal : contour.normals) zeros += (norm_of<2, float>(normal)) == 0.0 ? 1 : 0;
  EXPECT_EQ(zeros, 2u);
}

/// The gradient by straightforward code: differences of doubles in world coordinates.
template <Value T, int N>
std::array<double, N> plain_gradient(const Image<T, N>& image, const std::array<std::size_t, N>& index) {
  std::array<double, N> gradient{};
  for (int a = 0; a < N; ++a) {
    const Axis& axis = image.grid().axes[a];
    double sum = 0;
    int sides = 0;
    for (const int side : {-1, 1}) {
      if (side < 0 ? index[a] == 0 : index[a] + 1 == axis.size()) continue;
      auto next = index;
      next[a] += static_cast<std::size_t>(side);
      const double quotient =
          (static_cast<double>(image(next)) - static_cast<double>(image(index))) / (axis[next[a]] - axis[index[a]]);
      if (!std::isfinite(quotient)) continue;
      sum += quotient;
      ++sides;
    }
    gradient[a] = sides == 0 ? 0.0 : sum / sides;
  }
  return gradient;
}

/// Finds each vertex's edge by its position on a grid of step 1 (axis 0 may be uneven, with integer coordinates).
template <class Real, Value T, int N>
void expect_plain_normals(const OwnedImage<T, N>& image, double isovalue, double tolerance) {
  ExtractOptions options;
  options.epsilon = 0.01;  // keeps vertices inside their edges
  const auto contour = extract<Real>(image.view(), isovalue, with_normals(options));
  const Axis& first = image.grid.axes[0];
  std::size_t compared = 0;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
    std::array<std::size_t, N> low{}, high{};
    double alpha = 0;
    int between = 0;
    for (int a = 0; a < N; ++a) {
      const double x = contour.vertices[v][a];
      std::size_t i = 0;
      if (a == 0)
        while (i + 1 < first.size() && first[i + 1] <= x) ++i;
      else
        i = static_cast<std::size_t>(x);
      low[a] = high[a] = i;
      const Axis& axis = image.grid.axes[a];
      if (axis[i] == x) continue;
      ++high[a];
      ++between;
      alpha = (x - axis[i]) / (axis[i + 1] - axis[i]);
    }
    if (N == 4 && between > 1) continue;  // a vertex inside a tile
    ++compared;
    const auto here = plain_gradient<T, N>(image.view(), low);
    const auto there = plain_gradient<T, N>(image.view(), high);
    std::array<double, N> expected;
    for (int a = 0; a < N; ++a) expected[a] = -(here[a] + alpha * (there[a] - here[a]));
    const double size = norm_of<N, double>(expected);
    for (int a = 0; a < N; ++a)
      ASSERT_NEAR(contour.normals[v][a], size > 0 ? expected[a] / size : 0.0, tolerance) << "vertex " << v;
  }
  EXPECT_GE(compared, contour.vertices.size() / 2);
}

template <Value T, int N>
void expect_plain_normals_of(const std::array<std::size_t, N>& sizes) {
  std::uint64_t seed = 3;
  for (const double missing : {0.0, 0.05}) {
    Grid<N> even = Grid<N>::unit(sizes);
    Grid<N> uneven = even;
    std::vector<double> coordinates;
    for (std::size_t i = 0; i < sizes[0]; ++i) coordinates.push_back(static_cast<double>(i * i + i));
    uneven.axes[0] = Axis::rectilinear(coordinates);
    for (const Grid<N>& grid : {even, uneven}) {
      SCOPED_TRACE(testing::Message() << N << "D, missing " << missing << ", even " << grid.axes[0].is_uniform());
      auto image = OwnedImage<T, N>{grid, noise<T, N>(sizes, seed++).values};
      if constexpr (std::is_floating_point_v<T>)
        for (std::size_t i = 5; i < image.values.size() && missing > 0; i += 23)
          image.values[i] = std::numeric_limits<T>::quiet_NaN();
      expect_plain_normals<float>(image, noise_isovalue<T>(), 1e-3);  // rounded positions change alpha
      expect_plain_normals<double>(image, noise_isovalue<T>(), 1e-8);
    }
  }
}

TEST(Normals, AreThoseOfPlainCode) {
  expect_plain_normals_of<float, 2>({150, 9});
  expect_plain_normals_of<double, 2>({2, 2});
  expect_plain_normals_of<float, 3>({67, 5, 4});
  expect_plain_normals_of<double, 3>({3, 4, 5});
  expect_plain_normals_of<std::uint8_t, 3>({20, 4, 4});
  expect_plain_normals_of<std::int8_t, 3>({20, 4, 4});
  expect_plain_normals_of<std::uint16_t, 3>({20, 4, 4});
  expect_plain_normals_of<std::int16_t, 3>({20, 4, 4});
  expect_plain_normals_of<std::int32_t, 3>({20, 4, 4});
  expect_plain_normals_of<float, 4>({9, 4, 3, 4});
  expect_plain_normals_of<float, 4>({21, 3, 3, 3});
}

/// Contiguous samples are read by vector registers: of a row if its edges are dense, otherwise of four edges, except
/// near the ends of rows. Others are read one by one. `broken`: some samples are missing, infinite, or so large that
/// differences are.
template <class Real, Value T, int N>
void expect_the_same_normals_apart(const std::array<std::size_t, N>& sizes, bool broken = false) {
  auto image = noise<T, N>(sizes, 29);
  if constexpr (std::is_floating_point_v<T>) {
    constexpr std::array<T, 3> kValues = {std::numeric_limits<T>::quiet_NaN(), std::numeric_limits<T>::infinity(),
                                          std::numeric_limits<T>::lowest()};
    for (std::size_t i = 3; i < image.values.size() && broken; i += 17) image.values[i] = kValues[i % 3];
  }
  std::vector<T> apart(2 * image.values.size());
  for (std::size_t i = 0; i < image.values.size(); ++i) apart[2 * i] = image.values[i];
  auto strides = image.view().strides();
  for (std::ptrdiff_t& stride : strides) stride *= 2;
  const auto expected = extract<Real>(image.view(), noise_isovalue<T>(), with_normals());
  const auto got = extract<Real>(Image<T, N>(apart.data(), image.grid, strides), noise_isovalue<T>(), with_normals());
  ASSERT_GT(expected.normals.size(), 0u);
  ASSERT_EQ(got.normals.size(), expected.normals.size());
  EXPECT_EQ(std::memcmp(got.normals.data(), expected.normals.data(), got.normals.size() * sizeof(got.normals[0])), 0);
}

TEST(Normals, AreTheSameBytesWhetherSamplesLieNextToEachOtherOrNot) {
  for (const std::size_t size : {3u, 4u, 5u, 6u, 9u, 17u, 18u, 19u, 20u, 35u, 150u}) {
    SCOPED_TRACE(testing::Message() << size << " samples along the row");
    expect_the_same_normals_apart<float, float, 3>({size, 9, 7});
    expect_the_same_normals_apart<float, float, 2>({size, 9});
    expect_the_same_normals_apart<float, float, 3>({size, 4, 5});
    expect_the_same_normals_apart<float, float, 3>({size, 5, 4}, true);
    expect_the_same_normals_apart<float, float, 2>({size, 7}, true);
    expect_the_same_normals_apart<double, float, 3>({size, 4, 3});
    expect_the_same_normals_apart<float, double, 3>({size, 3, 3});
    expect_the_same_normals_apart<float, std::uint8_t, 3>({size, 3, 4});
    expect_the_same_normals_apart<float, std::int16_t, 3>({size, 3, 4});
    expect_the_same_normals_apart<float, std::int32_t, 3>({size, 3, 4});
    expect_the_same_normals_apart<float, float, 4>({size, 3, 4, 3});
    expect_the_same_normals_apart<float, float, 4>({size, 4, 3, 3}, true);
  }
}

TEST(Normals, OfRowsThatOverlapAreThoseOfACopy) {
  const auto values = noise<float, 2>({64, 64}, 31).values;
  for (const std::array<std::ptrdiff_t, 3> strides :
       {std::array<std::ptrdiff_t, 3>{1, 0, 40}, {1, 1, 1}, {1, 5, -5}, {1, 0, 0}, {1, 3, 40}}) {
    SCOPED_TRACE(testing::Message() << "strides " << strides[0] << ' ' << strides[1] << ' ' << strides[2]);
    OwnedImage<float, 3> copy;
    copy.grid = Grid<3>::unit({40, 6, 6});
    const float* const first = values.data() + 1024;
    for (std::ptrdiff_t z = 0; z < 6; ++z)
      for (std::ptrdiff_t y = 0; y < 6; ++y)
        for (std::ptrdiff_t x = 0; x < 40; ++x)
          copy.values.push_back(first[x * strides[0] + y * strides[1] + z * strides[2]]);
    const auto expected = extract<float>(copy.view(), noise_isovalue<float>(), with_normals());
    const auto got =
        extract<float>(Image<float, 3>(first, copy.grid, strides), noise_isovalue<float>(), with_normals());
    ASSERT_GT(expected.normals.size(), 0u);
    EXPECT_EQ(got.normals, expected.normals);
  }
}

TEST(Normals, OfSteepAndFlatFieldsHaveLengthOne) {
  for (const float scale : {1e-38F, 1e-25F, 1e25F, 3e37F}) {
    auto image = noise<float, 3>({40, 6, 6}, 9);
    for (float& value : image.values) value *= scale;
    const auto contour = extract<float>(image.view(), 0.5 * static_cast<double>(scale), with_normals());
    ASSERT_GT(contour.normals.size(), 100u);
    for (const auto& normal : contour.normals) ASSERT_NEAR((norm_of<3, float>(normal)), 1.0, 1e-5) << scale;
  }
}

TEST(Normals, OfTheLargestNumbersAreNumbers) {
  for (const bool mapped : {false, true}) {
    Grid<3> grid = Grid<3>::unit({9, 8, 7});
    if (mapped) grid.linear[0][1] = 0.25;
    auto image = noise<double, 3>(grid, 9);
    for (double& value : image.values)
      value = value < 0.3 ? std::numeric_limits<double>::lowest()
                          : (value > 0.6 ? std::numeric_limits<double>::max() : value);
    const auto contour = extract<double>(image.view(), 0.5, with_normals());
    ASSERT_GT(contour.normals.size(), 100u);
    for (const auto& normal : contour.normals) {
      const double size = norm_of<3, double>(normal);
      ASSERT_TRUE(size == 0.0 || std::abs(size - 1.0) < 1e-12) << size;
    }
  }
}

/// One-sided differences that exceed the largest number.
template <int N>
void expect_normals_of_the_steepest(const std::array<std::size_t, N>& sizes) {
  Grid<N> grid = Grid<N>::unit(sizes);
  for (Axis& axis : grid.axes) axis = Axis::uniform(axis.size(), 0.0, 0.6);
  auto image = noise_with_missing<double, N>(grid, 21, 0.1);
  for (double& value : image.values) value = (2.0 * value - 1.0) * 1.5e308;
  for (ExtractOptions options : variants())
    for (const Normals kind : {Normals::differences, Normals::sobel}) {
      options.close = true;
      SCOPED_TRACE(describe(options));
      const auto contour = extract<double>(image.view(), 1e307, with_normals(options, kind));
      ASSERT_GT(contour.normals.size(), 100u);
      const auto by_gradients = gradient_normals(image.view(), contour, kind);
      for (std::size_t v = 0; v < contour.normals.size(); ++v)
        for (const auto& normal : {contour.normals[v], by_gradients[v]}) {
          const double size = norm_of<N, double>(normal);
          ASSERT_TRUE(size == 0.0 || std::abs(size - 1.0) < 1e-12) << "vertex " << v << ": " << size;
        }
    }
}

TEST(Normals, NextToMissingValuesAreNumbersHoweverSteepTheField) {
  expect_normals_of_the_steepest<2>({30, 20});
  expect_normals_of_the_steepest<3>({12, 9, 8});
  expect_normals_of_the_steepest<4>({7, 6, 5, 6});
}

/// Normals by position; if the contour passes a position twice, one of them.
template <int N, class Real>
std::map<std::array<Real, N>, std::array<Real, N>> by_place(const Contour<N, Real>& contour) {
  std::map<std::array<Real, N>, std::array<Real, N>> result;
  for (std::size_t v = 0; v < contour.vertices.size(); ++v) result[contour.vertices[v]] = contour.normals[v];
  return result;
}

/// Edges along one row are processed in pieces if they number more than some thousand; across it they are few.
TEST(Normals, AndPointsOfLongRowsAreThoseOfTheTransposedImage) {
  constexpr std::size_t kLong = 20000;
  const auto along = noise<float, 2>({kLong, 4}, 23);
  auto across = noise<float, 2>({4, kLong}, 1);
  for (std::size_t i = 0; i < kLong; ++i)
    for (std::size_t j = 0; j < 4; ++j) across.values[4 * i + j] = along.values[kLong * j + i];
  for (const unsigned threads : {1u, 4u}) {
    ExtractOptions options = with_normals();
    options.work.threads = threads;
    const auto contour = extract<float>(along.view(), 0.5, options);
    ASSERT_GT(contour.vertices.size(), 3 * kLong);
    const auto expected = by_place(extract<float>(across.view(), 0.5, options));
    for (std::size_t v = 0; v < contour.vertices.size(); ++v) {
      const auto& [x, y] = contour.vertices[v];
      const auto swapped = expected.find({y, x});
      ASSERT_NE(swapped, expected.end()) << "vertex " << v << " at " << x << ", " << y;
      // Floats: squares are summed in the order of the axes, and small gradients have few digits.
      ASSERT_NEAR(contour.normals[v][0], swapped->second[1], 1e-4) << "vertex " << v;
      ASSERT_NEAR(contour.normals[v][1], swapped->second[0], 1e-4) << "vertex " << v;
    }
  }
}

TEST(Normals, DoNotChangeHowMuchIsCounted) {
  const auto image = noise<float, 3>(4, 1);
  EXPECT_EQ(count(image.view(), 0.5, with_normals()), count(image.view(), 0.5));
}

template <int N>
void expect_normals_of_cuts(const std::array<std::size_t, N>& sizes) {
  const auto image = noise<float, N>(sizes, 17);
  ExtractOptions options = with_normals();
  options.close = true;
  const auto contour = extract<float>(image.view(), 0.5, options);
  for (const double at : {0.0, 1.3, 2.0, static_cast<double>(sizes[N - 1] - 1) - 0.25}) {
    const auto cut = slice(contour, Hyperplane<N>::across(N - 1, at));
    ASSERT_EQ(cut.normals.size(), cut.vertices.size());
    ASSERT_GT(cut.vertices.size(), 10u);
    const auto direct = slice_image(image.view(), 0.5, Hyperplane<N>::across(N - 1, at), options);
    ASSERT_EQ(direct.normals.size(), direct.vertices.size());
    EXPECT_EQ(by_place(direct), by_place(cut)) << "at " << at;
    for (const auto& normal : cut.normals) ASSERT_NEAR((norm_of<N - 1, float>(normal)), 1.0, 1e-5);
  }
}

TEST(Normals, OfCutsAreTheSameFromTheContourAndFromTheImage) {
  expect_normals_of_cuts<3>({30, 9, 7});
  expect_normals_of_cuts<4>({9, 8, 7, 6});
}

TEST(Normals, OfACutOfASphereAreRadial) {
  const auto image = sample_field<float, 4>(centred_grid<4>(24, 1.0), Ball<4>{{}, 0.7});
  const auto cut = slice(extract<float>(image.view(), 0.0, with_normals()), Hyperplane<4>::across(3, 0.21));
  ASSERT_GT(cut.vertices.size(), 100u);
  for (std::size_t v = 0; v < cut.vertices.size(); ++v) {
    double along = 0;
    for (int a = 0; a < 3; ++a)
      along += static_cast<double>(cut.normals[v][a]) * static_cast<double>(cut.vertices[v][a]);
    ASSERT_GT((along / norm_of<3, float>(cut.vertices[v])), 0.99);
  }
}

}  // namespace
}  // namespace tegl::test
