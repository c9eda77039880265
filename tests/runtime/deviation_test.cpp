// SPDX-License-Identifier: BSD-3-Clause
//
// The distance of two contours: against spheres, against samples taken the slow way, and as it has to be.
#include "tegl/deviation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "distance_oracle.hpp"
#include "errors.hpp"
#include "fields.hpp"
#include "tegl/extract.hpp"
#include "tegl/hyperplane.hpp"

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
    EXPECT_NEAR(result.bound, 0.1, N == 4 ? 0.25 : 0.03);
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

TYPED_TEST(DeviationOf, IsTheSameForAnyNumberOfThreads) {
  constexpr int N = TypeParam::value;
  const auto from = sphere<N>(1.1, N == 4 ? 7 : 40), to = sphere<N>(1.0, N == 4 ? 6 : 31);
  DeviationOptions<N> one, four;
  one.threads = 1;
  four.threads = 4;
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
  Eigen::Matrix<double, N, 1> factors;
  for (int a = 0; a < N; ++a) factors[a] = options.scale[a] = 1.0 + a;
  const double scaled = deviation(from, to, options).bound;
  scale_axes(from, factors);
  scale_axes(to, factors);
  EXPECT_NEAR(deviation(from, to).bound, scaled, 1e-9);
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

TEST(Deviation, StopsWhenAskedTo) {
  const auto contour = sphere<3>(1.0, 20);
  DeviationOptions<3> options;
  options.threads = 1;
  options.progress = [](double) { return false; };
  expect_error(ErrorCode::Cancelled, "cancelled", [&] { deviation(contour, contour, options); });
}

}  // namespace
}  // namespace tegl::test
