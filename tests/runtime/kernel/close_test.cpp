// SPDX-License-Identifier: BSD-3-Clause
//
// Contours closed at the image border are the boundary of the high set: watertight, of the correct content, with caps
// exactly in the border.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "ambiguity/variants.hpp"
#include "compare.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/eigen.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

template <class T>
class Close : public ::testing::Test {};
template <int N>
using Dim = std::integral_constant<int, N>;
using Dimensions = ::testing::Types<Dim<2>, Dim<3>, Dim<4>>;
TYPED_TEST_SUITE(Close, Dimensions);

std::vector<ExtractOptions> closed_variants() {
  auto result = variants();
  for (ExtractOptions& options : result) options.close = true;
  return result;
}

template <int N>
Grid<N> box(std::size_t samples) {
  Grid<N> grid;
  for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(samples + static_cast<std::size_t>(a), -1.0, 0.5);
  return grid;
}

template <int N>
double content(const Grid<N>& grid) {
  double product = std::abs(as_eigen(grid.linear).determinant());
  for (const Axis& axis : grid.axes) product *= std::abs(axis[axis.size() - 1] - axis[0]);
  return product;
}

TYPED_TEST(Close, WhereAllIsHighTheResultIsTheBox) {
  constexpr int N = TypeParam::value;
  const auto image = sample_field<float, N>(box<N>(3), [](const Point<N>&) { return 1.0; });
  for (const ExtractOptions& options : closed_variants()) {
    SCOPED_TRACE(describe(options));
    const auto contour = extract<double>(image.view(), 0.0, options);
    const auto report = expect_closed_manifold(contour);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.euler, N == 3 ? 2 : 0);
    EXPECT_NEAR(enclosed_content(contour), content(image.grid), 1e-12 * content(image.grid));
  }
}

TYPED_TEST(Close, WhereAllIsLowTheResultIsEmpty) {
  constexpr int N = TypeParam::value;
  const auto image = sample_field<float, N>(box<N>(3), [](const Point<N>&) { return -1.0; });
  for (const ExtractOptions& options : closed_variants())
    EXPECT_TRUE(extract<float>(image.view(), 0.0, options).vertices.empty());
}

TYPED_TEST(Close, ContentOfALinearFieldIsExact) {
  constexpr int N = TypeParam::value;
  auto grid = box<N>(4);
  grid.axes[1] = Axis::rectilinear({2.0, 1.5, 0.25, -0.5, -1.0});  // descending and not uniform
  grid.linear[0][1] = 0.5;
  grid.linear[0][0] = -2.0;
  // High if the last coordinate is above a plane through the middle.
  const double middle = 0.5 * (grid.axes[N - 1][0] + grid.axes[N - 1][grid.axes[N - 1].size() - 1]);
  const auto image = sample_field<double, N>(grid, [&](const Point<N>& x) {
    double sum = 0.0;
    for (int a = 0; a + 1 < N; ++a)
      sum += 0.1 * (x[a] - 0.5 * (grid.axes[a][0] + grid.axes[a][grid.axes[a].size() - 1]));
    return x[N - 1] - middle + sum;
  });
  for (ExtractOptions options : closed_variants())
    for (const GradientDirection direction : {GradientDirection::descent, GradientDirection::ascent}) {
      options.direction = direction;
      SCOPED_TRACE(describe(options));
      const auto contour = extract<double>(image.view(), 0.0, options);
      expect_closed_manifold(contour);
      EXPECT_NEAR(enclosed_content(contour), 0.5 * content(grid), 1e-10 * content(grid));
    }
}

TYPED_TEST(Close, ABallThatLeavesTheImageIsCutOffAtTheBorder) {
  constexpr int N = TypeParam::value;
  Ball<N> ball;
  ball.radius = 0.8;
  ball.centre.fill(1.0);  // in a corner: one orthant of the ball is inside
  const auto image = sample_field<float, N>(centred_grid<N>(N == 4 ? 17 : 33, 1.0), ball);
  for (const ExtractOptions& options : closed_variants()) {
    SCOPED_TRACE(describe(options));
    const auto contour = extract<double>(image.view(), 0.0, options);
    const auto report = expect_closed_manifold(contour);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.euler, N == 3 ? 2 : 0);
    const double exact = ball.content() / (1 << N);
    EXPECT_NEAR(enclosed_content(contour), exact, 0.04 * exact);
  }
}

/// The open contour is unchanged and comes first.
TYPED_TEST(Close, AddsCapsToTheOpenContour) {
  constexpr int N = TypeParam::value;
  const auto image = noise<std::uint8_t, N>(N == 4 ? 5 : 9, 21);
  for (ExtractOptions options : closed_variants()) {
    SCOPED_TRACE(describe(options));
    const auto closed = extract<double>(image.view(), 127.5, options);
    options.close = false;
    const auto open = extract<double>(image.view(), 127.5, options);
    ASSERT_GT(closed.simplices.size(), open.simplices.size());
    EXPECT_TRUE(std::equal(open.vertices.begin(), open.vertices.end(), closed.vertices.begin()));
    EXPECT_TRUE(std::equal(open.simplices.begin(), open.simplices.end(), closed.simplices.begin()));
    for (std::size_t s = open.simplices.size(); s < closed.simplices.size(); ++s) {
      bool in_border = false;
      for (int a = 0; a < N; ++a)
        for (const double border : {0.0, static_cast<double>(image.grid.axes[a].size() - 1)})
          in_border = in_border || std::all_of(closed.simplices[s].begin(), closed.simplices[s].end(),
                                               [&](Index v) { return closed.vertices[v][a] == border; });
      EXPECT_TRUE(in_border) << "simplex " << s;
    }
  }
}

/// An image padded by a layer of low samples has the same high set, slightly enlarged.
TYPED_TEST(Close, HasTheTopologyOfThePaddedImage) {
  constexpr int N = TypeParam::value;
  constexpr std::size_t kSize = N == 4 ? 4 : 7;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const auto image = noise<float, N>(kSize, seed);
    std::array<std::size_t, N> padded_sizes;
    padded_sizes.fill(kSize + 2);
    OwnedImage<float, N> padded{Grid<N>::unit(padded_sizes), {}};
    padded.values.assign(sample_count(padded.grid), -1.0f);
    for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
      std::size_t at = 0;
      for (int a = N - 1; a >= 0; --a) at = at * (kSize + 2) + index[a] + 1;
      padded.values[at] = image.values[i];
    });
    for (ExtractOptions options : closed_variants()) {
      SCOPED_TRACE(describe(options));
      const auto closed = check(extract<double>(image.view(), 0.6, options));
      options.close = false;
      const auto around = check(extract<double>(padded.view(), 0.6, options));
      EXPECT_EQ(closed.components, around.components);
      EXPECT_EQ(closed.euler, around.euler);
    }
  }
}

TYPED_TEST(Close, LeavesTheContourOpenAtMissingValues) {
  constexpr int N = TypeParam::value;
  auto image = sample_field<float, N>(centred_grid<N>(6, 1.0), [](const Point<N>& x) { return 0.3 - x[0]; });
  // One missing corner of the image: its tile has neither contour nor caps.
  image.values[0] = std::numeric_limits<float>::quiet_NaN();
  for (const ExtractOptions& options : closed_variants()) {
    SCOPED_TRACE(describe(options));
    const auto contour = extract<double>(image.view(), 0.0, options);
    const auto report = expect_oriented_manifold(contour);
    EXPECT_GT(report.boundary_simplices, 0u);
    // Open around the missing tile only: every boundary face lies on that tile.
    for (const auto& face : boundary_faces(contour))
      for (const Index v : face)
        for (int a = 0; a < N; ++a) EXPECT_LE(contour.vertices[v][a], image.grid.axes[a][1]);
  }
}

/// Caps and contour have a common boundary at missing values, for any pattern of these.
TYPED_TEST(Close, CapsFitTheContourAroundMissingValues) {
  constexpr int N = TypeParam::value;
  std::array<std::size_t, N> sizes;
  sizes.fill(N == 4 ? 5 : 9);
  sizes[0] = 66;
  for (const double share : {0.01, 0.1}) {
    const auto image = noise_with_missing<float, N>(Grid<N>::unit(sizes), 22, share);
    for (const ExtractOptions& options : closed_variants()) {
      SCOPED_TRACE(describe(options) + ", missing " + std::to_string(share));
      const auto report = check(extract<double>(image.view(), 0.4, options));
      EXPECT_GT(report.simplices, 0u);
      EXPECT_EQ(report.unused_vertices, 0u);
      EXPECT_EQ(report.nonmanifold_simplices, 0u);
      EXPECT_EQ(report.orientation_conflicts, 0u);
    }
  }
}

}  // namespace
}  // namespace tegl::test
