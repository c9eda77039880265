// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of images whose cells are divided into simplices: manifolds, counts, convergence, and the same topology as
// contours resolved by means.
#include "tegl/division.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "complex/division_cases.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "tegl/measure.hpp"

namespace tegl {
namespace {

using namespace test;

template <int N>
std::vector<Division> divisions() {
  if (N >= 4) return {Division::kuhn, Division::symmetric};
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

/// Caps touch each other in a point beside a missing sample also if no edge is crossed there.
template <int N>
void expect_closed_beside_missing(unsigned images) {
  for (unsigned seed = 0; seed < images; ++seed) {
    std::mt19937 random(N * images + seed);
    OwnedImage<double, N> image;
    std::size_t count = 1;
    for (int a = 0; a < N; ++a) {
      image.grid.axes[a] = Axis::uniform(2 + random() % (N == 4 ? 2 : 5));
      count *= image.grid.axes[a].size();
    }
    for (std::size_t i = 0; i < count; ++i)
      image.values.push_back(random() % 8 == 0 ? std::numeric_limits<double>::quiet_NaN()
                                               : static_cast<double>(random() % 3));
    for (const double isovalue : {0.0, 0.5})
      for (const Division division : divisions<N>()) {
        SCOPED_TRACE(testing::Message() << N << "D, seed " << seed << ", " << name_of(division) << ", " << isovalue);
        ExtractOptions options;
        options.close = true;
        const auto contour = extract_divided<double>(image.view(), division, isovalue, options);
        expect_oriented_manifold(contour);
        const ContourSize size = count_divided(image.view(), division, isovalue, options);
        EXPECT_EQ(size.vertices, contour.vertices.size());
        EXPECT_EQ(size.simplices, contour.simplices.size());
      }
  }
}

TEST(Division, CapsBesideMissingValuesAreAManifold) {
  expect_closed_beside_missing<2>(60);
  expect_closed_beside_missing<3>(60);
  expect_closed_beside_missing<4>(12);
}

TEST(Division, Of4dImagesOnlySomeExist) {
  const auto image = noise<4>(3, 1);
  expect_error(ErrorCode::InvalidArgument, "division hybrid of a 4D image; expected kuhn or symmetric",
               [&] { (void)divided_complex(image.view(), Division::hybrid); });
}

/// Number of samples along the other axes of `along_first`.
template <int N>
constexpr std::size_t kAcross = N == 5 ? 2 : 4;

/// A grid of `axis` along axis 0, and of few samples with steps of 1 along the others.
template <int N>
OwnedImage<double, N> along_first(const Axis& axis) {
  std::array<std::size_t, N> sizes;
  sizes.fill(kAcross<N>);
  sizes[0] = axis.size();
  OwnedImage<double, N> image{Grid<N>::unit(sizes), {}};
  image.grid.axes[0] = axis;
  std::size_t count = 1;
  for (const std::size_t size : sizes) count *= size;
  image.values.resize(count);
  return image;
}

template <int N>
void expect_places_beside_samples(const Axis& axis, double period) {
  AxisPeriods<N> periods{};
  periods[0] = period;
  const double turn = axis.is_descending() ? -period : period;
  const auto count = axis.size();
  auto image = along_first<N>(axis);
  for (const Division division : divisions<N>()) {
    if (division == Division::alternating && count % 2 != 0) continue;
    for (std::size_t high = 0; high < count; ++high) {
      SCOPED_TRACE(testing::Message() << N << "D " << name_of(division) << ", high at " << axis[high]);
      for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = i % count == high ? 1.0 : 0.0;
      const double before = high > 0 ? axis[high - 1] : axis[count - 1] - turn;
      const double behind = high + 1 < count ? axis[high + 1] : axis[0] + turn;
      const std::array expected = {before + 0.4 * (axis[high] - before), behind + 0.4 * (axis[high] - behind)};
      std::array<std::size_t, 2> found{};
      const auto contour = extract_divided<double>(image.view(), division, 0.4, {}, periods);
      expect_oriented_manifold(contour);
      for (const auto& vertex : contour.vertices) {
        std::size_t matches = 0;
        for (const std::size_t side : {0u, 1u})
          if (std::abs(std::remainder(vertex[0] - expected[side], period)) < 1e-9) {
            ++found[side];
            ++matches;
          }
        ASSERT_EQ(matches, 1u) << vertex[0] << "; expected " << expected[0] << " or " << expected[1];
      }
      EXPECT_GT(found[0], 0u);
      EXPECT_EQ(found[0], found[1]);
    }
  }
}

TEST(Division, AcrossTheSeamVerticesLieBetweenTheirSamples) {
  const std::array<std::pair<Axis, double>, 5> axes = {{{Axis::uniform(3, 0.0, 2.0), 6.0},  // a step is a third
                                                        {Axis::uniform(4, 1.0, -0.5), 2.0},
                                                        {Axis::uniform(4, 0.0, 1.0), 5.9},
                                                        {Axis::rectilinear({0.0, 5.0, 6.5}), 11.0},
                                                        {Axis::rectilinear({7.0, 5.0, 4.5, 0.0}), 10.0}}};
  for (const auto& [axis, period] : axes) {
    SCOPED_TRACE(testing::Message() << axis.size() << " samples, period " << period);
    expect_places_beside_samples<2>(axis, period);
    expect_places_beside_samples<3>(axis, period);
    expect_places_beside_samples<4>(axis, period);
    expect_places_beside_samples<5>(axis, period);
  }
}

TEST(Division, StepsOfHalfAPeriodAreErrorsIn2dTo4d) {
  const auto expect_refused = [&]<int N>(const OwnedImage<double, N>& image, double period, const char* message) {
    AxisPeriods<N> periods{};
    periods[0] = period;
    expect_error(ErrorCode::InvalidArgument, message,
                 [&] { (void)extract_divided(image.view(), Division::kuhn, 0.5, {}, periods); });
    expect_error(ErrorCode::InvalidArgument, message,
                 [&] { (void)count_divided(image.view(), Division::kuhn, 0.5, {}, periods); });
  };
  const Axis uneven = Axis::rectilinear({0.0, 1.0, 10.0});
  expect_refused(
      along_first<2>(uneven), 12.0,
      "the period of axis 0 (x) is 12, and the step from 1 to 10 is 9; expected steps of less than half the");
  const Axis even = Axis::uniform(4, 0.0, 1.0);  // its step across the seam
  expect_refused(along_first<3>(even), 10.0,
                 "the period of axis 0 (x) is 10, and the step across the seam, from 3 to 10, is 7");
  expect_refused(along_first<4>(even), 6.0,
                 "the period of axis 0 (x) is 6, and the step across the seam, from 3 to 6, is 3");
  const Axis descending = Axis::uniform(4, 0.0, -1.0);
  expect_refused(along_first<2>(descending), 10.0,
                 "the period of axis 0 (x) is 10, and the step across the seam, from -3 to -10, is 7");
}

TEST(Division, In5dStepsMayBeLongerThanHalfAPeriod) {
  expect_places_beside_samples<5>(Axis::uniform(4, 0.0, 1.0), 10.0);
}

/// A central difference along axis 0.
template <int N>
GradientKernel central_kernel() {
  GradientKernel kernel;
  std::size_t size = 1;
  for (int a = 0; a < N; ++a) size *= 3;
  kernel.weights.assign(size, 0.0);
  kernel.weights[size / 2 - 1] = -0.5;
  kernel.weights[size / 2 + 1] = 0.5;
  return kernel;
}

/// `gradient`: at a vertex, of any length. In 5D the last vertices may be in the middle of an edge of the contour,
/// where it is separated beside missing values: they have the mean of two normals.
template <int N, class Gradient>
void expect_normals(const Contour<N, double>& contour, const Gradient& gradient) {
  ASSERT_EQ(contour.normals.size(), contour.vertices.size());
  ASSERT_GT(contour.normals.size(), 3u);
  std::size_t means = 0;
  for (std::size_t v = 0; v < contour.normals.size(); ++v) {
    std::array<double, N> expected = gradient(contour.vertices[v]);
    double square = 0.0;
    for (const double x : expected) square += x * x;
    double error = 0.0;
    for (std::size_t a = 0; a < N; ++a) {
      expected[a] /= (contour.direction == GradientDirection::ascent ? 1.0 : -1.0) * std::sqrt(square);
      error = std::max(error, std::abs(contour.normals[v][a] - expected[a]));
    }
    if (N == 5 && (means > 0 || error >= 1e-8)) {
      ++means;
      ASSERT_LT(error, 0.05) << v;
    } else {
      ASSERT_LT(error, 1e-8) << v;
    }
  }
  EXPECT_LE(means, contour.vertices.size() / 100);
}

template <int N>
void expect_gradients_of_products() {
  // The gradient is linear, and one-sided differences beside missing values are exact.
  const auto field = [](const std::array<double, N>& x) {
    double sum = x[0] * x[1];
    for (std::size_t a = 2; a < N; ++a) sum += 0.5 * x[a];
    return sum;
  };
  auto image = sampled<N>(5, field);
  for (const std::array<std::size_t, 5>& missing :
       {std::array<std::size_t, 5>{2, 2, 2, 2, 2}, {0, 2, 4, 2, 0}, {4, 4, 2, 0, 2}, {2, 0, 0, 2, 4}}) {
    if (N == 2 && missing[0] != missing[1]) continue;  // two of them would leave a sample without neighbours
    std::size_t number = 0;
    for (int a = N - 1; a >= 0; --a) number = 5 * number + missing[static_cast<std::size_t>(a)];
    image.values[number] = std::numeric_limits<double>::quiet_NaN();
  }
  // The grid is sheared: axis 1 has half of axis 0 added.
  image.grid.linear[1][0] = 0.5;
  for (const Division division : divisions<N>())
    for (const Normals kind : {Normals::differences, Normals::kernel})
      for (const GradientDirection direction : {GradientDirection::ascent, GradientDirection::descent}) {
        if (N == 5 && (kind == Normals::kernel) != (direction == GradientDirection::ascent)) continue;
        SCOPED_TRACE(testing::Message() << N << "D " << name_of(division) << ", kind " << static_cast<int>(kind));
        ExtractOptions options;
        options.normals = kind;
        options.kernel = central_kernel<N>();
        options.direction = direction;
        expect_normals<N>(extract_divided<double>(image.view(), division, 0.1, options),
                          [](const std::array<double, N>& x) {
                            std::array<double, N> gradient;
                            gradient.fill(0.5);
                            const double along_axis_1 = x[1] - 0.5 * x[0];
                            gradient[0] = along_axis_1 - 0.5 * x[0];
                            gradient[1] = x[0];
                            return gradient;
                          });
      }
}

TEST(Division, NormalsAreLinearAlongTheEdgesAlsoBesideMissingValues) {
  expect_gradients_of_products<2>();
  expect_gradients_of_products<3>();
  expect_gradients_of_products<4>();
  expect_gradients_of_products<5>();
}

template <int N>
void expect_gradients_across_the_seam() {
  constexpr std::array kAlong = {0.0, 2.0, 5.0, 1.0};
  auto image = along_first<N>(Axis::uniform(4, 0.0, 1.0));
  for (std::size_t i = 0; i < image.values.size(); ++i)
    image.values[i] = kAlong[i % 4] + static_cast<double>(i / 4 % kAcross<N>);
  AxisPeriods<N> periods{};
  periods[0] = 4.0;
  for (const Division division : divisions<N>())
    for (const Normals kind : {Normals::differences, Normals::kernel, Normals::sobel}) {
      SCOPED_TRACE(testing::Message() << N << "D " << name_of(division) << ", kind " << static_cast<int>(kind));
      ExtractOptions options;
      options.normals = kind;
      options.kernel = central_kernel<N>();
      std::size_t across = 0;
      expect_normals<N>(extract_divided<double>(image.view(), division, 1.3, options, periods),
                        [&](const std::array<double, N>& x) {
                          const auto at = [&](double sample) {
                            const auto i = static_cast<std::size_t>(sample);
                            return 0.5 * (kAlong[(i + 1) % 4] - kAlong[(i + 3) % 4]);
                          };
                          const double from = std::max(0.0, std::floor(x[0]));
                          across += x[0] > 3.0 ? 1 : 0;
                          std::array<double, N> gradient{};
                          gradient[0] = at(from) + (x[0] - from) * (at(from + 1.0) - at(from));
                          gradient[1] = 1.0;
                          return gradient;
                        });
      EXPECT_GT(across, 0u);
    }
}

TEST(Division, NormalsAcrossTheSeamAreThoseOfThePeriodicImage) {
  expect_gradients_across_the_seam<2>();
  expect_gradients_across_the_seam<3>();
  expect_gradients_across_the_seam<4>();
  expect_gradients_across_the_seam<5>();
}

template <int N>
void expect_early_error(const OwnedImage<double, N>& image) {
  ExtractOptions options;
  options.normals = Normals::kernel;
  options.kernel.weights = {1.0, 2.0};
  std::size_t reports = 0;
  options.work.progress = [&](double) { return ++reports > 0; };
  expect_error(ErrorCode::InvalidArgument, "kernel of 2 weights",
               [&] { (void)extract_divided(image.view(), Division::kuhn, 0.5, options); });
  expect_error(ErrorCode::InvalidArgument, "kernel of 2 weights",
               [&] { (void)count_divided(image.view(), Division::kuhn, 0.5, options); });
  EXPECT_EQ(reports, 0u);
}

TEST(Division, WrongKernelsAreFoundBeforeAnyWork) {
  expect_early_error(noise<3>(4, 1));
  expect_early_error(noise<5>(3, 1));
}

}  // namespace
}  // namespace tegl
