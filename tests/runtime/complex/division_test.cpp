// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images whose cells are divided into simplices: manifolds, counts, convergence, and the same topology as
// contours resolved by means.
#include "tegl/division.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "complex/division_cases.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "tegl/measure.hpp"

namespace tegl {
namespace {

using namespace test;

template <int N>
std::vector<Division> divisions() {
  if (N == 4) return {Division::kuhn, Division::symmetric};
  return {Division::kuhn, Division::alternating, Division::symmetric, Division::hybrid};
}

template <int N>
void expect_closed_noise(std::size_t samples) {
  const auto image = noise<N>(samples, 3);
  for (const Division division : divisions<N>()) {
    SCOPED_TRACE(testing::Message() << N << "D " << name_of(division));
    const Complex<N> complex = divided_complex(image.view(), division, 0.5);
    const auto contour = extract<double>(complex, 0.5);
    EXPECT_GT(contour.simplices.size(), 100u);
    expect_closed_manifold(contour);
    EXPECT_GT(measure(contour).content.value(), 0.0);
    // nothing is ambiguous
    ExtractOptions options;
    options.ambiguity = Ambiguity::high;
    EXPECT_EQ(extract<double>(complex, 0.5, options).simplices.size(), contour.simplices.size());
  }
}

TEST(Division, NoiseHasAClosedOrientedManifold) {
  expect_closed_noise<2>(30);
  expect_closed_noise<3>(12);
  expect_closed_noise<4>(6);
}

TEST(Division, CellsAreAsManyAsTheThesisCounts) {
  const auto cells = []<int N>(const OwnedImage<double, N>& image, Division division) {
    return divided_complex(image.view(), division, 0.5).cell_count();
  };
  EXPECT_EQ(cells(noise<2>(4, 1), Division::kuhn), 2u * 9u);
  EXPECT_EQ(cells(noise<3>(4, 1), Division::kuhn), 6u * 27u);
  EXPECT_EQ(cells(noise<4>(3, 1), Division::kuhn), 24u * 16u);
  EXPECT_EQ(cells(noise<2>(4, 1), Division::alternating), 2u * 9u);
  EXPECT_EQ(cells(noise<3>(4, 1), Division::alternating), 5u * 27u);
  EXPECT_EQ(cells(noise<2>(4, 1), Division::symmetric), 4u * 9u);
  EXPECT_EQ(cells(noise<3>(4, 1), Division::symmetric), 24u * 27u);
  EXPECT_EQ(cells(noise<4>(3, 1), Division::symmetric), 192u * 16u);
  // a cell with one ambiguous face: four tetrahedra there and five pyramids; its neighbour across the face is the same
  const auto cell = sampled<3>(2, [](const auto& x) { return x[2] < 0 && x[0] * x[1] > 0 ? 1.0 : 0.0; });
  EXPECT_EQ(cells(cell, Division::hybrid), 9u);
  EXPECT_EQ(cells(sampled<3>(2, [](const auto& x) { return x[0]; }), Division::hybrid), 1u);
}

template <int N>
void expect_topology_of_means(std::size_t samples) {
  ExtractOptions mean;
  mean.ambiguity = Ambiguity::mean;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto image = noise<N>(samples, seed);
    const MeshReport expected = check(extract<double>(image.view(), 0.5, mean));
    for (const Division division : {Division::symmetric, Division::hybrid}) {
      if (N == 4 && division == Division::hybrid) continue;
      SCOPED_TRACE(testing::Message() << N << "D " << name_of(division) << ", seed " << seed);
      const MeshReport report = check(extract<double>(divided_complex(image.view(), division, 0.5), 0.5));
      EXPECT_EQ(report.components, expected.components);
      EXPECT_EQ(report.euler, expected.euler);
    }
  }
}

TEST(Division, CentresByMeansGiveTheTopologyOfAmbiguityMean) {
  expect_topology_of_means<2>(40);
  expect_topology_of_means<3>(14);
  expect_topology_of_means<4>(7);
}

TEST(Division, SpheresAndToriHaveTheirEulerCharacteristic) {
  const auto torus = [](const auto& x) {
    return 0.25 - std::hypot(std::hypot(x[0] + 0.011, x[1] - 0.013) - 0.55, x[2] + 0.017);
  };
  for (const Division division : divisions<3>()) {
    const auto euler = [&](const auto& image) {
      return expect_closed_manifold(extract(divided_complex(image.view(), division), 0.0)).euler;
    };
    EXPECT_EQ(euler(sampled<3>(15, ball<3>)), 2);
    EXPECT_EQ(euler(sampled<3>(26, torus)), 0);
  }
}

template <int N, class Field>
void expect_order_two(std::size_t coarse, std::size_t fine, const Field& field, double size, double content) {
  const double ratio = static_cast<double>(fine - 1) / static_cast<double>(coarse - 1);
  for (const Division division : divisions<N>()) {
    const auto errors = [&](std::size_t samples) {
      const auto image = sampled<N>(samples, field);
      const Measures<N> measures = measure(extract<double>(divided_complex(image.view(), division), 0.0));
      return std::array{std::abs(measures.size - size), std::abs(measures.content.value() - content)};
    };
    const auto of_coarse = errors(coarse), of_fine = errors(fine);
    for (const std::size_t k : {0u, 1u})
      EXPECT_NEAR(2.0, std::log(of_coarse[k] / of_fine[k]) / std::log(ratio), 0.35)
          << N << "D " << name_of(division) << (k == 0 ? ", size" : ", content");
  }
}

TEST(Division, SizeAndContentConvergeWithOrderTwo) {
  constexpr double kPi = std::numbers::pi;
  expect_order_two<2>(16, 46, ball<2>, 2 * kPi * 0.7, kPi * 0.49);
  expect_order_two<3>(14, 38, ball<3>, 4 * kPi * 0.49, 4.0 / 3.0 * kPi * 0.343);
  expect_order_two<4>(7, 11, ball<4>, 2 * kPi * kPi * 0.343, 0.5 * kPi * kPi * 0.2401);
  const auto torus = [](const auto& x) { return 0.25 - std::hypot(std::hypot(x[0], x[1]) - 0.55, x[2]); };
  expect_order_two<3>(18, 35, torus, 4 * kPi * kPi * 0.55 * 0.25, 2 * kPi * kPi * 0.55 * 0.0625);
}

TEST(Division, AtMissingValuesTheContourIsAManifold) {
  auto image = noise<3>(9, 5);
  std::mt19937 random(2);
  for (double& value : image.values)
    if (random() % 10 == 0) value = std::numeric_limits<double>::quiet_NaN();
  for (const Division division : divisions<3>())
    expect_oriented_manifold(extract(divided_complex(image.view(), division, 0.5), 0.5));
}

TEST(Division, Of4dImagesOnlySomeExist) {
  const auto image = noise<4>(3, 1);
  expect_error(ErrorCode::InvalidArgument, "division hybrid of a 4D image; expected kuhn or symmetric",
               [&] { (void)divided_complex(image.view(), Division::hybrid); });
}

}  // namespace
}  // namespace tegl
