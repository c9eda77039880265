// SPDX-License-Identifier: BSD-3-Clause
//
// The distance of two contours: compared with spheres and with brute-force samples, and its invariants.
#include "tegl/deviation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "distance_oracle.hpp"
#include "errors.hpp"
#include "fields.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/hyperplane.hpp"
#include "tegl/simplify.hpp"

namespace tegl::test {
namespace {

template <class T>
class DeviationOf : public ::testing::Test {};
using Dimensions =
    ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(DeviationOf, Dimensions);

template <int N>
Contour<N, double> sphere(double radius, std::size_t samples) {
  const auto image = sample_field<float, N>(centred_grid<N>(samples, 1.3), Ball<N>{{}, radius});
  return extract<double>(image.view(), 0.0);
}

TYPED_TEST(DeviationOf, AContourFromItselfIsZero) {
  constexpr int N = TypeParam::value;
  const auto contour = sphere<N>(1.0, N == 4 ? 9 : 20);
  const Deviation result = deviation(contour, contour);
  EXPECT_LE(result.bound, 1e-12);
  ASSERT_EQ(result.of_from.size(), contour.simplices.size());
  ASSERT_EQ(result.of_to.size(), contour.simplices.size());
}

TYPED_TEST(DeviationOf, ConcentricSpheresIsTheDifferenceOfTheirRadii) {
  constexpr int N = TypeParam::value;
  const auto outer = sphere<N>(1.1, N == 4 ? 8 : 40), inner = sphere<N>(1.0, N == 4 ? 7 : 31);
  for (const auto& [from, to] : {std::pair{&outer, &inner}, std::pair{&inner, &outer}}) {
    const Deviation result = deviation(*from, *to);
    EXPECT_LE(result.least, result.bound);
    EXPECT_NEAR(result.bound, 0.1, N == 4 ? 0.1 : 0.03);
    EXPECT_GE(result.bound, sampled_deviation(*from, *to, 50, 3));
  }
}

TYPED_TEST(DeviationOf, NoiseIsBoundedFromAboveAndBelow) {
  constexpr int N = TypeParam::value;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const auto image = noise<float, N>(N == 4 ? 3 : 7, seed);
    const auto low = extract<double>(image.view(), 0.45), high = extract<double>(image.view(), 0.55);
    const Deviation result = deviation(low, high);
    const double sampled = sampled_deviation(low, high, 100, seed);
    EXPECT_GE(result.bound, sampled) << "seed " << seed;
    EXPECT_GE(result.bound, result.least) << "seed " << seed;
    EXPECT_LE(result.bound, 4.0 * std::max(result.least, sampled)) << "seed " << seed;
  }
}

/// Contours through grid points have flat simplices, which are bounded by their neighbours.
TYPED_TEST(DeviationOf, FlatSimplicesAreBoundedFromAboveAndBelow) {
  constexpr int N = TypeParam::value;
  for (std::uint64_t seed = 0; seed < (N == 4 ? 1 : 3); ++seed) {
    auto image = noise<float, N>(N == 4 ? 3 : 9, seed);
    for (float& value : image.values) value = std::round(4.0f * value);
    for (const bool close : {false, true}) {
      ExtractOptions extraction;
      extraction.close = close;
      const auto contour = extract<double>(image.view(), 2.0, extraction);
      ASSERT_GT(check(contour).degenerate_simplices, 0u);
      SimplifyOptions<N> options;
      options.ratio = 0.5;
      options.measure = false;
      const auto simple = simplify(contour, options).contour;
      for (const auto& [from, to] : {std::pair{&contour, &simple}, std::pair{&simple, &contour}}) {
        const Deviation result = deviation(*from, *to);
        EXPECT_GE(result.bound + 1e-12, result.least) << "seed " << seed;
        for (std::size_t s = 0; s < from->simplices.size(); s += N == 4 ? 31 : 7) {
          Contour<N, double> one = *from;
          one.simplices = {from->simplices[s]};
          ASSERT_GE(result.of_from[s] + 1e-12, sampled_deviation(one, *to, 5, seed)) << "simplex " << s;
        }
      }
    }
  }
}

/// Bounds by connected simplices hold for contours that are simplified a lot, in both directions and by simplex.
TYPED_TEST(DeviationOf, SimplifiedNoiseIsBoundedInBothDirections) {
  constexpr int N = TypeParam::value;
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const auto image = noise<float, N>(N == 4 ? 4 : 9, seed);
    const auto contour = extract<double>(image.view(), 0.5);
    SimplifyOptions<N> options;
    options.ratio = 0.4;
    options.measure = false;
    options.border = SimplifyBorder::within;
    const auto result = simplify(contour, options).contour;
    for (const auto& [from, to] : {std::pair{&contour, &result}, std::pair{&result, &contour}}) {
      const Deviation way = deviation(*from, *to);
      EXPECT_GE(way.bound, way.least) << "seed " << seed;
      EXPECT_LE(way.bound, 2.0 * way.least) << "seed " << seed;
      EXPECT_EQ(way.bound, *std::max_element(way.of_from.begin(), way.of_from.end()));
      // every simplex by itself
      for (std::size_t s = 0; s < from->simplices.size(); s += 1 + from->simplices.size() / 40) {
        auto one = *from;
        one.simplices = {from->simplices[s]};
        ASSERT_GE(way.of_from[s], sampled_deviation(one, *to, 8, s)) << "seed " << seed << ", simplex " << s;
      }
    }
  }
}

/// Steep parts of the contour lean over the caps at their edges. Two triangulations, so that no simplex alone is near.
TYPED_TEST(DeviationOf, OfVerticesThatMovedALittleIsLittleBesideWalls) {
  constexpr int N = TypeParam::value;
  std::array<std::size_t, N> sizes;
  sizes.fill(N == 4 ? 4 : 8);
  const auto image = sample_field<float, N>(Grid<N>::unit(sizes), [](const Point<N>& x) {
    double height = 1.37 - x[0];
    for (int a = 1; a < N; ++a) height += 0.02 / a * x[a];
    return height;
  });
  ExtractOptions options;
  options.close = true;
  const auto contour = extract<double>(image.view(), 0.0, options);
  options.triangulation = Triangulation::barycentric;
  auto moved = extract<double>(image.view(), 0.0, options);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> step(-1e-10, 1e-10);
  for (auto& vertex : moved.vertices)
    for (double& x : vertex) x += step(random);
  EXPECT_LE(deviation(contour, moved).bound, 1e-5);
  EXPECT_LE(deviation(moved, contour).bound, 1e-5);
}

TYPED_TEST(DeviationOf, IsTheSameForAnyNumberOfThreads) {
  constexpr int N = TypeParam::value;
  const auto from = sphere<N>(1.1, N == 4 ? 7 : 40), to = sphere<N>(1.0, N == 4 ? 6 : 31);
  DeviationOptions<N> one, four;
  one.work.threads = 1;
  four.work.threads = 4;
  const Deviation a = deviation(from, to, one), b = deviation(from, to, four);
  EXPECT_EQ(a.bound, b.bound);
  EXPECT_EQ(a.least, b.least);
  EXPECT_EQ(a.of_from, b.of_from);
  EXPECT_EQ(a.of_to, b.of_to);
}

TYPED_TEST(DeviationOf, IsMeasuredInUnitsOfTheScale) {
  constexpr int N = TypeParam::value;
  auto from = sphere<N>(1.1, N == 4 ? 7 : 20), to = sphere<N>(1.0, N == 4 ? 6 : 18);
  DeviationOptions<N> options;
  Vector<N> factors;
  for (int a = 0; a < N; ++a) factors[a] = options.scale[a] = 1.0 + a;
  const double scaled = deviation(from, to, options).bound;
  from = scale_axes(std::move(from), factors);
  to = scale_axes(std::move(to), factors);
  EXPECT_NEAR(deviation(from, to).bound, scaled, 1e-9);
}

/// A simplex in the hyperplane of the last axis, with corners at the origin and at 1 along each other axis.
template <int N>
Contour<N, double> one_simplex() {
  Contour<N, double> contour;
  contour.vertices.resize(N, std::array<double, N>{});
  std::array<Index, N> simplex;
  for (int i = 0; i < N; ++i) {
    if (i > 0) contour.vertices[i][i - 1] = 1.0;
    simplex[i] = static_cast<Index>(i);
  }
  contour.simplices.push_back(simplex);
  return contour;
}

/// Orients simplices in that hyperplane as one_simplex does.
template <int N>
void face_as_one_simplex(Contour<N, double>& contour) {
  for (auto& simplex : contour.simplices) {
    Eigen::Matrix<double, N - 1, N - 1> edges;
    for (int i = 1; i < N; ++i)
      for (int a = 0; a + 1 < N; ++a)
        edges(a, i - 1) = contour.vertices[simplex[i]][a] - contour.vertices[simplex[0]][a];
    if (edges.determinant() < 0) std::swap(simplex[0], simplex[1]);
  }
}

/// Slices of that simplex of equal content, from one point to the next along its first edge.
template <int N>
Contour<N, double> in_slices(const std::vector<std::pair<double, double>>& slices, double height) {
  Contour<N, double> contour;
  for (const auto& [first, end] : slices) {
    auto slice = one_simplex<N>();
    slice.vertices[0][0] = first;
    slice.vertices[1][0] = end;
    std::array<Index, N> simplex = slice.simplices[0];
    for (Index& v : simplex) v += static_cast<Index>(contour.vertices.size());
    for (auto& vertex : slice.vertices) {
      vertex[N - 1] = height;
      contour.vertices.push_back(vertex);
    }
    contour.simplices.push_back(simplex);
  }
  return contour;
}

/// A double cover does not compensate for a hole.
TYPED_TEST(DeviationOf, SeesAHoleAsLargeAsADoubleCover) {
  constexpr int N = TypeParam::value;
  const auto from = one_simplex<N>();
  for (const double height : {0.0, 0.01, 0.1}) {
    const auto to = in_slices<N>({{0.0, 0.25}, {0.5, 0.75}, {0.5, 0.75}, {0.75, 1.0}}, height);
    const double truth =
        std::hypot(0.125, height) / (N == 2 ? 1.0 : 2.0);  // less than the distance of the hole's centre
    const Deviation result = deviation(from, to);
    EXPECT_GE(result.bound, truth) << "height " << height;
    EXPECT_GE(result.bound, sampled_deviation(from, to, 2000, 5)) << "height " << height;
    EXPECT_LE(result.bound, 1.0) << "height " << height;
  }
}

/// Detects a missing corner that hardly changes the sum of contents.
TYPED_TEST(DeviationOf, SeesACornerThatIsCutOff) {
  constexpr int N = TypeParam::value;
  const auto from = one_simplex<N>();
  for (const double share : {1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 4e-3, 1e-2, 1e-1}) {
    // The simplex without the corner at 0: a slice that ends before each of the other corners.
    Contour<N, double> to;
    std::vector<std::array<double, N>> low, high;  // where the edges from 0 are cut, and where they end
    for (int a = 0; a + 1 < N; ++a) {
      std::array<double, N> point{};
      point[a] = share;
      low.push_back(point);
      point[a] = 1.0;
      high.push_back(point);
    }
    to.vertices.assign(low.begin(), low.end());
    to.vertices.insert(to.vertices.end(), high.begin(), high.end());
    for (int k = 0; k + 1 < N; ++k) {  // the prism between both: low 0 … k, high k … N - 2
      std::array<Index, N> simplex;
      for (int i = 0; i < N; ++i) simplex[i] = static_cast<Index>(i <= k ? i : N - 1 + i - 1);
      to.simplices.push_back(simplex);
    }
    face_as_one_simplex(to);
    const double truth = share / std::sqrt(N - 1.0);
    const Deviation result = deviation(from, to);
    EXPECT_GE(result.bound, truth * (1 - 1e-12)) << share;
    EXPECT_GE(result.bound, result.least) << share;
    EXPECT_NEAR(result.least, truth, 1e-12) << share;
    EXPECT_LE(result.bound, 3.0 * truth + 1e-4) << share;
    EXPECT_LE(deviation(to, from).bound, 1e-10) << share;  // a rim of 1e-11 of the border is missing
  }
}

/// Detects a hole that contains no vertex, however small.
TYPED_TEST(DeviationOf, SeesAHoleInTheMiddle) {
  constexpr int N = TypeParam::value;
  const auto from = one_simplex<N>();
  for (const double size : {0.3, 1e-2, 1e-4, 1e-6, 1e-8}) {
    // Between the simplex and a small copy of it around its centroid: a prism over each face, divided into simplices.
    Contour<N, double> to;
    for (const double scale : {1.0, size})
      for (const auto& corner : from.vertices) {
        std::array<double, N> point{};
        for (int a = 0; a + 1 < N; ++a) point[a] = 1.0 / N + scale * (corner[a] - 1.0 / N);
        to.vertices.push_back(point);
      }
    for (int omitted = 0; omitted < N; ++omitted) {
      std::vector<int> face;
      for (int i = 0; i < N; ++i)
        if (i != omitted) face.push_back(i);
      for (int turn = 0; turn + 1 < N; ++turn) {
        std::array<Index, N> simplex;
        int k = 0;
        for (int i = 0; i <= turn; ++i) simplex[k++] = static_cast<Index>(face[i]);
        for (int i = turn; i + 1 < N; ++i) simplex[k++] = static_cast<Index>(N + face[i]);
        to.simplices.push_back(simplex);
      }
    }
    face_as_one_simplex(to);
    const double truth = size / (N * std::sqrt(N - 1.0));  // of the centroid
    const Deviation result = deviation(from, to);
    EXPECT_GE(result.bound, truth * (1 - 1e-9)) << size;
    EXPECT_LE(result.bound, 3.0 * truth + 0.1) << size;
    EXPECT_LE(deviation(to, from).bound, 1e-9) << size;
  }
}

TEST(Deviation, FromNothingIsInfiniteAndOfNothingZero) {
  const auto contour = sphere<3>(1.0, 8);
  EXPECT_TRUE(std::isinf(deviation(contour, Contour<3, double>()).bound));
  EXPECT_EQ(deviation(Contour<3, double>(), contour).bound, 0.0);
}

TEST(Deviation, RefusesScalesAndNumbersThatMakeNoSense) {
  auto contour = sphere<3>(1.0, 8);
  DeviationOptions<3> options;
  options.scale[1] = 0.0;
  expect_error(ErrorCode::InvalidArgument, "0", [&] { deviation(contour, contour, options); });
  auto broken = contour;
  broken.simplices[0][0] = 1u << 30;
  expect_error(ErrorCode::InvalidArgument, "1073741824", [&] { deviation(contour, broken); });
}

/// Progress increases up to the end, and every report can stop the work.
TEST(Deviation, TellsProgressAndStopsAnywhere) {
  const auto from = sphere<4>(1.1, 8), to = sphere<4>(1.0, 7);
  std::vector<double> told;
  DeviationOptions<4> options;
  options.work.threads = 2;
  options.work.progress = [&](double fraction) {
    told.push_back(fraction);
    return true;
  };
  deviation(from, to, options);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_EQ(told.back(), 1.0);
  EXPECT_GT(told.size(), 6u);
  for (const double stop : told) {
    options.work.progress = [&](double fraction) { return fraction < stop; };
    expect_error(ErrorCode::Cancelled, "cancelled", [&] { deviation(from, to, options); });
  }
}

TEST(Deviation, StopsWhenAskedTo) {
  const auto contour = sphere<3>(1.0, 20);
  DeviationOptions<3> options;
  options.work.threads = 1;
  options.work.progress = [](double) { return false; };
  expect_error(ErrorCode::Cancelled, "cancelled", [&] { deviation(contour, contour, options); });
}

}  // namespace
}  // namespace tegl::test
