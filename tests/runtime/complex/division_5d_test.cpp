// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of divided 5D images: the contour in a simplex is certified for all signatures, the extraction compared with
// that of complexes in 2D to 4D, and 5D contours are checked by invariants, analytic values and their cuts.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Dense>

#include "complex/division_cases.hpp"
#include "complex/image_points.hpp"
#include "division/divided_contour.hpp"
#include "division/simplex_contour.hpp"
#include "errors.hpp"
#include "invariants.hpp"
#include "periodic/periodic_layers.hpp"
#include "periodic/periods.hpp"
#include "tegl/check.hpp"
#include "tegl/components.hpp"
#include "tegl/measure.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using namespace test;

constexpr std::array kDivisions = {Division::kuhn, Division::symmetric};

/// The ends of an edge of an N-simplex by its number.
template <int N>
std::vector<std::array<int, 2>> edge_ends() {
  std::vector<std::array<int, 2>> ends(detail::SimplexContour<N>::kEdges);
  for (int i = 0; i <= N; ++i)
    for (int j = i + 1; j <= N; ++j) ends[detail::edge_number<N>(i, j)] = {i, j};
  return ends;
}

/// Sorts the numbers; returns whether that is an odd permutation.
template <std::size_t Size>
bool sort_odd(std::array<int, Size>& numbers) {
  bool odd = false;
  for (std::size_t i = 1; i < Size; ++i)
    for (std::size_t j = i; j > 0 && numbers[j] < numbers[j - 1]; --j) {
      std::swap(numbers[j], numbers[j - 1]);
      odd = !odd;
    }
  return odd;
}

/// The oriented faces of the contour in an N-simplex that are in one simplex of it: +1 or -1 by sorted edges.
template <int N>
std::map<std::array<int, N - 1>, int> border_of(unsigned signature) {
  std::map<std::array<int, N - 1>, int> border;
  for (const auto& simplex : detail::SimplexContour<N>::instance().of(signature))
    for (std::size_t omitted = 0; omitted < N; ++omitted) {
      std::array<int, N - 1> face;
      for (std::size_t j = 0, k = 0; j < N; ++j)
        if (j != omitted) face[k++] = simplex[j];
      const bool odd = sort_odd(face);
      border[face] += odd != (omitted % 2 != 0) ? -1 : 1;
    }
  std::erase_if(border, [](const auto& each) { return each.second == 0; });
  return border;
}

TEST(SimplexContour, HasTheSizeOfAProductOfSimplices) {
  const auto& contour = detail::SimplexContour<5>::instance();
  constexpr std::array kSizes = {0u, 1u, 4u, 6u, 4u, 1u, 0u};
  for (unsigned signature = 0; signature < 64; ++signature)
    EXPECT_EQ(contour.of(signature).size(), kSizes[static_cast<std::size_t>(std::popcount(signature))]);
}

TEST(SimplexContour, InFacetsIsTheContourOfTheFacetForAllSignatures) {
  // So neighbours agree, and the border of a contour is in the facets.
  const auto ends = edge_ends<5>();
  for (unsigned signature = 0; signature < 64; ++signature) {
    std::map<std::array<int, 4>, int> expected;
    for (int omitted = 0; omitted <= 5; ++omitted) {
      unsigned of_facet = 0;
      std::array<int, 5> vertices;
      for (int v = 0, k = 0; v <= 5; ++v)
        if (v != omitted) {
          of_facet |= (signature >> v & 1u) << k;
          vertices[static_cast<std::size_t>(k++)] = v;
        }
      const auto ends_in_facet = edge_ends<4>();
      for (const auto& simplex : detail::SimplexContour<4>::instance().of(of_facet)) {
        std::array<int, 4> face;
        for (std::size_t j = 0; j < 4; ++j) {
          const auto [a, b] = ends_in_facet[simplex[j]];
          face[j] = static_cast<int>(
              detail::edge_number<5>(vertices[static_cast<std::size_t>(a)], vertices[static_cast<std::size_t>(b)]));
        }
        // The facet opposite to vertex `omitted` has the sign (-1)^omitted, and the direction towards high is last in
        // the frames of both contours.
        const bool odd = sort_odd(face) != (omitted % 2 != 0);
        EXPECT_TRUE(expected.emplace(face, odd ? -1 : 1).second);
      }
    }
    EXPECT_EQ(border_of<5>(signature), expected) << signature;
    for (const auto& simplex : detail::SimplexContour<5>::instance().of(signature))
      for (const std::uint8_t edge : simplex)
        EXPECT_NE(signature >> ends[edge][0] & 1u, signature >> ends[edge][1] & 1u) << signature;
  }
}

TEST(SimplexContour, IsPositiveForAllValues) {
  // With the test of its border: the simplices fill the contour without overlaps, whatever the values.
  std::mt19937 random(4);
  std::uniform_real_distribution<double> size(1e-3, 1.0);
  const auto ends = edge_ends<5>();
  for (unsigned signature = 1; signature < 63; ++signature)
    for (int trial = 0; trial < 50; ++trial) {
      Eigen::Matrix<double, 5, 6> points = Eigen::Matrix<double, 5, 6>::Random();
      if (points.rightCols<5>().colwise().operator-(points.col(0)).determinant() < 0) points.col(1).swap(points.col(2));
      std::array<double, 6> values;
      for (unsigned v = 0; v < 6; ++v) values[v] = (signature >> v & 1u) != 0 ? size(random) : -size(random);
      for (const auto& simplex : detail::SimplexContour<5>::instance().of(signature)) {
        Eigen::Matrix<double, 5, 5> corners;
        for (int j = 0; j < 5; ++j) {
          const auto [a, b] = ends[simplex[static_cast<std::size_t>(j)]];
          const double alpha = values[static_cast<std::size_t>(a)] /
                               (values[static_cast<std::size_t>(a)] - values[static_cast<std::size_t>(b)]);
          corners.col(j) = points.col(a) + alpha * (points.col(b) - points.col(a));
        }
        Eigen::Matrix<double, 5, 5> frame;
        frame.leftCols<4>() = corners.rightCols<4>().colwise() - corners.col(0);
        auto [high, low] = ends[simplex[0]];
        if (values[static_cast<std::size_t>(high)] < 0) std::swap(high, low);
        frame.col(4) = points.col(high) - points.col(low);
        EXPECT_GT(frame.determinant(), 0) << signature;
      }
    }
}

/// The contour of an image whose cells are divided, cell by cell as in 5D.
template <int N>
Contour<N, double> extract_by_cells(const OwnedImage<double, N>& image, Division division, double isovalue,
                                    const ExtractOptions& options = {}, const AxisPeriods<N>& periods = {}) {
  Contour<N, double> contour;
  contour.direction = options.direction;
  const Image<double, N> view = image.view();
  const Grid<N> longer = detail::longer_grid(image.grid, periods);
  detail::DividedSamples<N> samples{longer};
  for (std::size_t a = 0; a < N; ++a) samples.periodic |= unsigned{periods[a] != 0.0} << a;
  if (samples.periodic != 0) samples.periods = detail::world_periods<N>(image.grid, periods);
  const ExtractedSize size = detail::extract_divided_cells<N, double>(
      samples,
      [&](const std::array<std::size_t, N>& from, std::size_t count, double* out) {
        std::array<std::size_t, N> at = from;
        for (std::size_t a = 0; a < N; ++a) at[a] %= view.size(static_cast<int>(a));
        for (std::size_t i = 0; i < count; ++i, at[0] = (at[0] + 1) % view.size(0)) out[i] = view(at);
      },
      division, isovalue, options, &contour);
  EXPECT_EQ(size.size.vertices, contour.vertices.size());
  EXPECT_EQ(size.size.simplices, contour.simplices.size());
  return contour;
}

template <int N>
void expect_as_complexes(std::size_t samples, bool close) {
  ExtractOptions options;
  options.close = close;
  options.direction = close ? GradientDirection::ascent : GradientDirection::descent;
  auto image = noise<N>(samples, 8);
  if (close)
    for (double& value : image.values) value = 1.0 - value;  // high at the border
  for (const Division division : kDivisions) {
    SCOPED_TRACE(testing::Message() << N << "D " << name_of(division) << (close ? ", closed" : ""));
    const auto contour = extract_by_cells(image, division, 0.5, options);
    const auto expected = extract<double>(divided_complex(image.view(), division), 0.5, options);
    const MeshReport report = expect_closed_manifold(contour), of_complex = check(expected);
    EXPECT_EQ(report.components, of_complex.components);
    EXPECT_EQ(report.euler, of_complex.euler);
    if (!close) {
      EXPECT_EQ(report.vertices, of_complex.vertices);
    }
    const auto measures = measure(contour), of_expected = measure(expected);
    EXPECT_NEAR(measures.size, of_expected.size, 1e-9 * of_expected.size);
    EXPECT_NEAR(measures.content.value(), of_expected.content.value(), 1e-9);
  }
}

TEST(Division5d, CellByCellIsTheContourOfComplexes) {
  for (const bool close : {false, true}) {
    expect_as_complexes<2>(20, close);
    expect_as_complexes<3>(9, close);
    expect_as_complexes<4>(5, close);
  }
}

TEST(Division5d, NoiseHasAClosedOrientedManifold) {
  for (const Division division : kDivisions) {
    const auto image = noise<5>(division == Division::kuhn ? 5 : 4, 3);
    const auto contour = extract_divided<double>(image.view(), division, 0.5);
    EXPECT_GT(contour.simplices.size(), 10000u);
    const MeshReport report = expect_closed_manifold(contour);
    EXPECT_EQ(report.degenerate_simplices, 0u);
    EXPECT_GT(measure(contour).content.value(), 0.0);
    const ContourSize size = count_divided(image.view(), division, 0.5);
    EXPECT_EQ(size.vertices, contour.vertices.size());
    EXPECT_EQ(size.simplices, contour.simplices.size());
  }
}

TEST(Division5d, SmallIntegersHaveAClosedOrientedManifold) {
  for (const Division division : kDivisions) {
    OwnedImage<std::uint8_t, 5> image{noise<5>(4, 1).grid, {}};
    std::mt19937 random(7);
    for (const double value : noise<5>(4, 1).values)
      image.values.push_back(static_cast<std::uint8_t>(value == 0.0 ? 0 : random() % 3));
    ExtractOptions options;
    options.epsilon = 0.01;
    for (const double isovalue : {1.0, 2.0}) {
      expect_closed_manifold(extract_divided<float>(image.view(), division, isovalue));
      EXPECT_EQ(expect_closed_manifold(extract_divided(image.view(), division, isovalue, options)).degenerate_simplices,
                0u);
    }
  }
}

TEST(Division5d, ABallHasASphereOfOrderTwo) {
  constexpr double kPi = std::numbers::pi;
  const double size = 8.0 / 3.0 * kPi * kPi * std::pow(0.7, 4), content = 8.0 / 15.0 * kPi * kPi * std::pow(0.7, 5);
  for (const Division division : kDivisions) {
    const auto errors = [&](std::size_t samples) {
      const auto image = sampled<5>(samples, ball<5>);
      const auto contour = extract_divided<double>(image.view(), division, 0.0);
      const Measures<5> measures = measure(contour);
      return std::array{std::abs(measures.size - size), std::abs(measures.content.value() - content)};
    };
    const auto small = sampled<5>(5, ball<5>);
    EXPECT_EQ(expect_closed_manifold(extract_divided<double>(small.view(), division, 0.0)).euler, 2);
    const std::size_t coarse = division == Division::kuhn ? 6 : 5, fine = division == Division::kuhn ? 9 : 7;
    const double ratio = static_cast<double>(fine - 1) / static_cast<double>(coarse - 1);
    const auto of_coarse = errors(coarse), of_fine = errors(fine);
    for (const std::size_t k : {0u, 1u})
      EXPECT_NEAR(2.0, std::log(of_coarse[k] / of_fine[k]) / std::log(ratio), 0.5)
          << name_of(division) << (k == 0 ? ", size" : ", content");
  }
}

TEST(Division5d, AtTheBorderTheContourEndsOrIsClosed) {
  for (const Division division : kDivisions) {
    const auto image = sampled<5>(division == Division::kuhn ? 4 : 3,
                                  [](const std::array<double, 5>& x) { return 1.3 + ball<5>(x) + 0.1 * x[0]; });
    const MeshReport open = expect_oriented_manifold(extract_divided<double>(image.view(), division, 0.5));
    EXPECT_GT(open.boundary_simplices, 0u);
    ExtractOptions options;
    options.close = true;
    for (const double isovalue : {0.5, -9.0}) {  // below all values: the whole box
      const auto closed = extract_divided<double>(image.view(), division, isovalue, options);
      EXPECT_EQ(expect_closed_manifold(closed).euler, 2);
      const double content = measure(closed).content.value();
      EXPECT_GT(content, isovalue < 0 ? 32.0 - 1e-9 : 1.0);
      EXPECT_LT(content, isovalue < 0 ? 32.0 + 1e-9 : 31.0);
    }
  }
}

/// Noise with this share of missing samples.
template <int N>
OwnedImage<double, N> with_missing(std::size_t samples, double share, unsigned seed) {
  auto image = sampled<N>(samples, [random = std::mt19937(seed), share](const std::array<double, N>&) mutable {
    const double value = std::uniform_real_distribution<double>()(random);
    return std::uniform_real_distribution<double>()(random) < share ? std::numeric_limits<double>::quiet_NaN() : value;
  });
  return image;
}

template <int N>
AxisPeriods<N> all_periodic(const Grid<N>& grid, int axes = N) {
  std::vector<int> all;
  for (int a = 0; a < axes; ++a) all.push_back(a);
  return sample_periods(grid, all);
}

template <int N>
void expect_missing_and_periodic_as_complexes(std::size_t samples, double share, int periodic_axes, bool close) {
  ExtractOptions options;
  options.close = close;
  const auto image = with_missing<N>(samples, share, 21);
  const AxisPeriods<N> periods = periodic_axes == 0 ? AxisPeriods<N>{} : all_periodic<N>(image.grid, periodic_axes);
  for (const Division division : kDivisions) {
    SCOPED_TRACE(testing::Message() << N << "D " << name_of(division) << ", missing " << share << ", " << periodic_axes
                                    << " periodic axes" << (close ? ", closed" : ""));
    const auto contour = extract_by_cells(image, division, 0.5, options, periods);
    const auto expected = extract_divided<double>(image.view(), division, 0.5, options, periods);
    const MeshReport report = expect_oriented_manifold(contour), of_complex = expect_oriented_manifold(expected);
    EXPECT_GT(of_complex.simplices, 10u);
    EXPECT_EQ(contour.periods.size(), expected.periods.size());
    EXPECT_EQ(report.components, of_complex.components);
    EXPECT_EQ(report.euler, of_complex.euler);
    if (!close) {
      EXPECT_EQ(report.vertices, of_complex.vertices);
      EXPECT_NEAR(measure(contour).size, measure(expected).size, 1e-9 * measure(expected).size);
    }
  }
}

TEST(Division5d, MissingValuesAndPeriodicAxesAreThoseOfComplexes) {
  for (const bool close : {false, true})
    for (const double share : {0.0, 0.05, 0.2})
      for (const int periodic : {0, 1, 2}) {
        expect_missing_and_periodic_as_complexes<2>(20, share, periodic, close);
        expect_missing_and_periodic_as_complexes<3>(8, share, periodic, close);
        expect_missing_and_periodic_as_complexes<4>(5, 0.3 * share, periodic, close);
      }
  expect_missing_and_periodic_as_complexes<3>(8, 0.05, 3, false);
  expect_missing_and_periodic_as_complexes<4>(4, 0.01, 4, false);
}

TEST(Division5d, BesideMissingValuesTheContourIsAManifold) {
  for (const Division division : kDivisions)
    for (const auto& [share, close] : {std::pair{0.003, true}, {0.02, false}, {0.06, true}}) {
      SCOPED_TRACE(testing::Message() << name_of(division) << ", missing " << share << (close ? ", closed" : ""));
      ExtractOptions options;
      options.close = close;
      const auto image = with_missing<5>(division == Division::kuhn && share < 0.05 ? 4 : 3, share, 31);
      const auto contour = extract_divided<double>(image.view(), division, 0.5, options);
      EXPECT_GT(expect_oriented_manifold(contour).simplices, 100u);
      const ContourSize size = count_divided(image.view(), division, 0.5, options);
      EXPECT_EQ(size.vertices, contour.vertices.size());
      EXPECT_EQ(size.simplices, contour.simplices.size());
    }
}

TEST(Division5d, KuhnLeavesOutSimplicesWithMissingCornersAndSymmetricWholeCells) {
  // The sum of the coordinates is 2.3 between the corners of a cell with two and with three ones. The simplices without
  // the lowest corner do not exist: each has the lowest and the highest corner.
  OwnedImage<double, 5> image{Grid<5>::unit({2, 2, 2, 2, 2}), {}};
  for (unsigned v = 0; v < 32; ++v) image.values.push_back(std::popcount(v));
  const auto whole = extract_divided<double>(image.view(), Division::kuhn, 2.3);
  image.values[0b00001] = std::numeric_limits<double>::quiet_NaN();
  // 24 of the 120 paths begin with axis 0
  const auto rest = extract_divided<double>(image.view(), Division::kuhn, 2.3);
  EXPECT_EQ(rest.simplices.size() * 5, whole.simplices.size() * 4);
  EXPECT_TRUE(extract_divided<double>(image.view(), Division::symmetric, 2.3).simplices.empty());
  image.values[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(extract_divided<double>(image.view(), Division::kuhn, 2.3).simplices.empty());
}

TEST(Division5d, TheTorusHasClosedContours) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const auto over_torus = [&](std::size_t samples, auto f) {
    auto image = sampled<5>(samples, [](const std::array<double, 5>&) { return 0.0; });
    for (Axis& axis : image.grid.axes) axis = Axis::uniform(samples, 0.0, kTurn / static_cast<double>(samples));
    image.values.clear();
    detail::for_each_sample<5>(image.grid.sizes(), [&](const std::array<std::size_t, 5>& at) {
      std::array<double, 5> x;
      for (std::size_t a = 0; a < 5; ++a) x[a] = image.grid.axes[a][at[a]];
      image.values.push_back(f(x));
    });
    return image;
  };
  // two flat T^4
  const auto flat = over_torus(4, [](const std::array<double, 5>& x) { return std::cos(x[3]); });
  // a ball around each point of a lattice: S^4
  const auto balls = over_torus(5, [](const std::array<double, 5>& x) {
    double sum = 0;
    for (const double each : x) sum += std::cos(each);
    return sum;
  });
  for (const Division division : kDivisions) {
    SCOPED_TRACE(name_of(division));
    const auto periods = all_periodic<5>(flat.grid);
    const auto sheets = extract_divided<double>(flat.view(), division, 0.1, {}, periods);
    const MeshReport of_sheets = expect_closed_manifold(sheets);
    EXPECT_EQ(of_sheets.components, 2u);
    EXPECT_EQ(of_sheets.euler, 0);
    EXPECT_NEAR(measure(sheets).size, 2.0 * std::pow(kTurn, 4), 1e-6);
    EXPECT_EQ(sheets.periods.size(), 5u);
    if (division == Division::symmetric) continue;  // 3 125 cells
    const auto around = all_periodic<5>(balls.grid);
    const auto ball = extract_divided<double>(balls.view(), division, 3.5, {}, around);
    const MeshReport of_ball = expect_closed_manifold(ball);
    EXPECT_EQ(of_ball.components, 1u);
    EXPECT_EQ(of_ball.euler, 2);
    EXPECT_GT(measure(ball).content.value(), 0.0);
    // below the saddles at 3, five handles connect the ball with itself around the torus
    const MeshReport with_handles =
        expect_closed_manifold(extract_divided<double>(balls.view(), division, 2.2, {}, around));
    EXPECT_EQ(with_handles.components, 1u);
    EXPECT_EQ(with_handles.euler, 2 * (1 - 5));
  }
}

TEST(Division5d, AcrossTheSeamTheContourIsThatOfTheLongerImage) {
  // Noise that is low at all borders but those of axes 1 and 3, which repeat their first layers at their ends.
  for (const Division division : kDivisions) {
    const std::size_t samples = division == Division::kuhn ? 5 : 4;
    OwnedImage<double, 5> image = noise<5>(samples, 41);
    std::mt19937 random(42);
    std::size_t i = 0;
    detail::for_each_sample<5>(image.grid.sizes(), [&](const std::array<std::size_t, 5>& at) {
      const auto inside = [&](std::size_t a) { return at[a] > 0 && at[a] + 1 < samples; };
      image.values[i++] = inside(0) && inside(2) && inside(4) ? std::uniform_real_distribution<double>()(random) : 0.0;
    });
    AxisPeriods<5> periods{};
    for (const int a : {1, 3})
      periods[static_cast<std::size_t>(a)] = all_periodic<5>(image.grid)[static_cast<std::size_t>(a)];
    OwnedImage<double, 5> longer{detail::longer_grid(image.grid, periods), {}};
    detail::for_each_sample<5>(longer.grid.sizes(), [&](std::array<std::size_t, 5> at) {
      for (std::size_t& each : at) each %= samples;
      longer.values.push_back(image.view()(at));
    });
    const auto wrapped = extract_divided<double>(image.view(), division, 0.5, {}, periods);
    const auto plain = extract_divided<double>(longer.view(), division, 0.5);
    SCOPED_TRACE(name_of(division));
    expect_closed_manifold(wrapped);
    EXPECT_EQ(wrapped.simplices.size(), plain.simplices.size());
    EXPECT_LT(wrapped.vertices.size(), plain.vertices.size());
    EXPECT_NEAR(measure(wrapped).size, measure(plain).size, 1e-9 * measure(plain).size);
    const Unrolled<5, double> unrolled = unroll(wrapped);
    const MeshReport of_unrolled = expect_oriented_manifold(unrolled.contour), of_plain = check(plain);
    EXPECT_EQ(of_unrolled.simplices, of_plain.simplices);
    EXPECT_EQ(of_unrolled.boundary_simplices, of_plain.boundary_simplices);
    const ContourSize size = count_divided(image.view(), division, 0.5, {}, periods);
    EXPECT_EQ(size.vertices, wrapped.vertices.size());
    EXPECT_EQ(size.simplices, wrapped.simplices.size());
  }
}

TEST(Division5d, NormalsAreTheImagesGradients) {
  // Of a linear function they are exact for all kinds, also on a sheared grid.
  auto image = sampled<5>(4, [](const std::array<double, 5>& x) { return x[0] - 2 * x[1] + 0.5 * x[2] + x[4]; });
  image.grid.linear[1][3] = 0.5;
  const std::array<double, 5> expected = [&] {
    // the gradient in the world: of axis 3, less what the shear adds
    std::array<double, 5> gradient = {1, -2, 0.5, 1, 1};
    double square = 0;
    for (const double x : gradient) square += x * x;
    for (double& x : gradient) x /= -std::sqrt(square);
    return gradient;
  }();
  for (const Division division : kDivisions)
    for (const Normals kind :
         {Normals::differences, Normals::sobel, Normals::prewitt, Normals::forward, Normals::backward}) {
      ExtractOptions options;
      options.normals = kind;
      const auto contour = extract_divided<double>(image.view(), division, 0.2, options);
      ASSERT_EQ(contour.normals.size(), contour.vertices.size());
      ASSERT_GT(contour.normals.size(), 100u);
      for (const auto& normal : contour.normals)
        for (std::size_t a = 0; a < 5; ++a) ASSERT_NEAR(normal[a], expected[a], 1e-9);
    }
}

TEST(Division5d, NormalsAcrossTheSeamAreThoseOfThePeriodicImage) {
  // The image moved by one sample has the normals of the moved contour.
  ExtractOptions options;
  options.normals = Normals::differences;
  for (const Division division : kDivisions) {
    const std::size_t samples = division == Division::kuhn ? 4 : 3;
    auto image = noise<5>(samples, 51);
    std::mt19937 random(52);
    for (double& value : image.values) value = std::uniform_real_distribution<double>()(random);
    auto moved = image;
    std::size_t i = 0;
    detail::for_each_sample<5>(image.grid.sizes(), [&](std::array<std::size_t, 5> at) {
      for (std::size_t& each : at) each = (each + 1) % samples;
      moved.values[i++] = image.view()(at);
    });
    const auto periods = all_periodic<5>(image.grid);
    const auto sorted_normals = [&](const OwnedImage<double, 5>& of) {
      auto normals = extract_divided<double>(of.view(), division, 0.5, options, periods).normals;
      for (auto& normal : normals)
        for (double& x : normal) x = std::round(x * 0x1p30);
      std::sort(normals.begin(), normals.end());
      return normals;
    };
    EXPECT_EQ(sorted_normals(image), sorted_normals(moved));
  }
}

template <class Real>
bool same_bytes(const Contour<5, Real>& first, const Contour<5, Real>& second) {
  return first.vertices.size() == second.vertices.size() && first.simplices == second.simplices &&
         std::memcmp(first.vertices.data(), second.vertices.data(),
                     first.vertices.size() * sizeof(first.vertices[0])) == 0;
}

TEST(Division5d, AnyNumberOfThreadsGivesTheSameBytes) {
  for (const Division division : kDivisions) {
    auto image = noise<5>(division == Division::kuhn ? 5 : 4, 9);
    for (double& value : image.values) value = 1.0 - value;  // high at the border
    for (const bool close : {false, true}) {
      ExtractOptions options;
      options.close = close;
      options.work.threads = 1;
      const auto one = extract_divided(image.view(), division, 0.7, options);
      EXPECT_GT(one.simplices.size(), 1000u);
      options.work.threads = 5;
      EXPECT_TRUE(same_bytes(extract_divided(image.view(), division, 0.7, options), one));
    }
  }
  const auto holes = with_missing<5>(4, 0.01, 9);
  const auto periods = all_periodic<5>(holes.grid, 2);
  ExtractOptions options;
  options.work.threads = 1;
  const auto one = extract_divided(holes.view(), Division::kuhn, 0.5, options, periods);
  options.work.threads = 5;
  EXPECT_TRUE(same_bytes(extract_divided(holes.view(), Division::kuhn, 0.5, options, periods), one));
}

TEST(Division5d, MakingAManifoldReportsProgressAndCanBeCancelled) {
  const auto image = with_missing<5>(4, 0.03, 31);
  const auto expect_reports = [&](const auto& make, double from) {
    // the reports after the contour, until the last one
    std::vector<double> reports;
    ExtractOptions options;
    options.work.threads = 1;
    options.work.progress = [&](double fraction) {
      reports.push_back(fraction);
      return true;
    };
    (void)make(options);
    EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
    EXPECT_EQ(reports.back(), 1.0);
    const auto late = std::count_if(reports.begin(), reports.end(), [&](double each) { return each >= from; });
    EXPECT_GT(late, 5);
    // cancelled after three of these
    std::size_t seen = 0;
    options.work.progress = [&](double fraction) { return fraction < from || ++seen < 4; };
    expect_error(ErrorCode::Cancelled, "cancelled", [&] { (void)make(options); });
  };
  expect_reports(
      [&](const ExtractOptions& options) { return extract_divided(image.view(), Division::kuhn, 0.5, options); }, 0.9);
  expect_reports([&](const ExtractOptions& options) { return extract(image.view(), 0.5, options); }, 1.0);
}

TEST(Division5d, MirroredGridsHaveTheSameSide) {
  auto image = noise<5>(4, 2);
  const auto content = [&] {
    return measure(extract_divided<double>(image.view(), Division::kuhn, 0.4)).content.value();
  };
  const double expected = content();
  EXPECT_GT(expected, 0);
  image.grid.linear[2][2] = -1;
  EXPECT_NEAR(content(), expected, 1e-12);
  image.grid.axes[4] = Axis::uniform(4, 1.0, -2.0 / 3);
  EXPECT_NEAR(content(), expected, 1e-12);
}

TEST(Division5d, AtALayerTheCutIsTheDividedContourOfTheLayer) {
  for (const Division division : kDivisions) {
    const auto image = noise<5>(4, 6);
    const auto contour = extract_divided<double>(image.view(), division, 0.5);
    for (const int axis : {4, 3, 0}) {
      SCOPED_TRACE(testing::Message() << name_of(division) << ", axis " << axis);
      OwnedImage<double, 4> layer;
      const auto part = image.view().part(axis, 1, 1);
      for (int a = 0; a < 4; ++a) layer.grid.axes[a] = image.grid.axes[a < axis ? a : a + 1];
      detail::for_each_sample<4>(layer.grid.sizes(), [&](const std::array<std::size_t, 4>& at) {
        std::array<std::size_t, 5> index{};
        for (int a = 0; a < 4; ++a) index[a < axis ? a : a + 1] = at[a];
        layer.values.push_back(part(index));
      });
      const auto expected = extract<double>(divided_complex(layer.view(), division), 0.5);
      const auto cut = slice(contour, Hyperplane<5>::across(axis, image.grid.axes[axis][1]));
      const MeshReport report = expect_closed_manifold(cut), of_layer = check(expected);
      EXPECT_GT(of_layer.simplices, 100u);
      EXPECT_EQ(report.components, of_layer.components);
      EXPECT_EQ(report.euler, of_layer.euler);
      EXPECT_NEAR(measure(cut).size, measure(expected).size, 1e-9);
      EXPECT_NEAR(measure(cut).content.value(), measure(expected).content.value(), 1e-9);
    }
  }
}

TEST(Division5d, ErrorsNameTheOption) {
  auto image = noise<5>(3, 1);
  const auto extract_with = [&](Division division, const ExtractOptions& options) {
    (void)extract_divided(image.view(), division, 0.5, options);
  };
  expect_error(ErrorCode::InvalidArgument, "division hybrid of a 5D image; expected kuhn or symmetric",
               [&] { extract_with(Division::hybrid, {}); });
  ExtractOptions options;
  options.normals = Normals::context;
  expect_error(ErrorCode::InvalidArgument, "normals context of a divided image; expected gradients of other kinds",
               [&] { extract_with(Division::kuhn, options); });
  options.normals = Normals::none;
  options.triangulation = Triangulation::barycentric;
  expect_error(ErrorCode::InvalidArgument, "triangulation barycentric of a divided 5D image; expected compact",
               [&] { extract_with(Division::kuhn, options); });
  expect_error(ErrorCode::InvalidIsovalue, "isovalue inf",
               [&] { (void)extract_divided(image.view(), Division::kuhn, std::numeric_limits<double>::infinity()); });
  AxisPeriods<5> periods{};
  periods[4] = 0.5;
  expect_error(ErrorCode::InvalidArgument, "the period of axis 4 (u) is 0.5",
               [&] { (void)extract_divided(image.view(), Division::kuhn, 0.5, {}, periods); });
}

TEST(Division5d, AnAxisOfOneSampleHasAnEmptyContour) {
  OwnedImage<double, 5> image{Grid<5>::unit({3, 3, 1, 3, 3}), {}};
  image.values.resize(81);
  image.values[40] = 1.0;
  EXPECT_TRUE(extract_divided(image.view(), Division::symmetric, 0.5).simplices.empty());
}

}  // namespace
}  // namespace tegl
