// SPDX-License-Identifier: BSD-3-Clause
//
// Guarantees of `extract` besides topology: shared and no unused vertices, positions, orientation in the world, any
// strides, any sample values, options, errors.
#include "tegl/extract.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "ambiguity/variants.hpp"
#include "compare.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"

namespace tegl::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class D>
class Extract : public ::testing::Test {};
template <int N>
using Dim = std::integral_constant<int, N>;
using Dimensions = ::testing::Types<Dim<2>, Dim<3>, Dim<4>>;
TYPED_TEST_SUITE(Extract, Dimensions);

/// Calls visit(index of the first sample, axis, value there, value at the other end) for all edges of an image.
template <Value T, int N, class Visit>
void for_each_edge(const Image<T, N>& image, const Visit& visit) {
  for_each_sample<N>(image.grid(), [&](std::size_t, const std::array<std::size_t, N>& index) {
    for (int a = 0; a < N; ++a) {
      if (index[a] + 1 == image.size(a)) continue;
      auto next = index;
      ++next[a];
      visit(index, a, image(index), image(next));
    }
  });
}

/// The points on all critical edges, computed by definition (theory, section 1), sorted.
template <Value T, int N>
std::vector<std::array<double, N>> expected_points(const Image<T, N>& image, double isovalue) {
  std::vector<std::array<double, N>> points;
  for_each_edge(image, [&](const std::array<std::size_t, N>& index, int axis, T a, T b) {
    const double va = static_cast<double>(a);
    const double vb = static_cast<double>(b);
    if ((va >= isovalue) == (vb >= isovalue)) return;
    std::array<double, N> point;
    for (int c = 0; c < N; ++c) point[c] = image.grid().axes[c][index[c]];
    const double end = image.grid().axes[axis][index[axis] + 1];
    point[axis] += (isovalue - va) / (vb - va) * (end - point[axis]);
    points.push_back(point);
  });
  std::sort(points.begin(), points.end());
  return points;
}

TYPED_TEST(Extract, EveryCriticalEdgeHasExactlyOneVertexAtItsPlace) {
  constexpr int N = TypeParam::value;
  auto image = noise<std::int32_t, N>(N == 4 ? 5 : 11, 31);
  image.grid.axes[0] = Axis::uniform(image.grid.axes[0].size(), 3.0, -0.25);
  const auto points = expected_points(image.view(), 12345.0);
  for (const ExtractOptions& options : variants()) {
    SCOPED_TRACE(describe(options));
    const auto vertices = sorted_vertices(extract<double>(image.view(), 12345.0, options));
    // Except for barycentres, which lie off the edges; no vertex occurs twice.
    EXPECT_EQ(std::adjacent_find(vertices.begin(), vertices.end()), vertices.end());
    EXPECT_TRUE(std::includes(vertices.begin(), vertices.end(), points.begin(), points.end()));
    if (N < 4 && options.triangulation == Triangulation::compact) {
      EXPECT_EQ(vertices.size(), points.size());
    }
  }
}

TYPED_TEST(Extract, AnyStridesGiveTheSameContourAsADenseCopy) {
  constexpr int N = TypeParam::value;
  const auto image = noise<float, N>(N == 4 ? 5 : 9, 41);
  const std::size_t n = image.grid.axes[0].size();
  // Equal samples stored backwards, with axes in reverse order and gaps of 3 elements.
  std::vector<float> stored(3 * image.values.size(), -7.0f);
  typename Image<float, N>::Strides strides;
  std::ptrdiff_t step = -3;
  for (int a = N - 1; a >= 0; --a, step *= static_cast<std::ptrdiff_t>(n)) strides[a] = step;
  float* const origin = stored.data() + stored.size() - 1;
  for_each_sample<N>(image.grid, [&](std::size_t i, const std::array<std::size_t, N>& index) {
    std::ptrdiff_t at = 0;
    for (int a = 0; a < N; ++a) at += static_cast<std::ptrdiff_t>(index[a]) * strides[a];
    origin[at] = image.values[i];
  });
  const auto dense = extract<float>(image.view(), 0.5);
  const auto strided = extract<float>(Image<float, N>(origin, image.grid, strides), 0.5);
  EXPECT_EQ(dense.vertices, strided.vertices);
  EXPECT_EQ(dense.simplices, strided.simplices);
}

TYPED_TEST(Extract, ZeroStrideRepeatsOneLayer) {
  constexpr int N = TypeParam::value;
  const auto image = noise<std::uint16_t, N>(6, 42);
  auto repeated = image;
  std::size_t layer = image.values.size() / 6;
  for (std::size_t i = layer; i < image.values.size(); ++i) repeated.values[i] = repeated.values[i - layer];
  auto strides = image.view().strides();
  strides[N - 1] = 0;
  const auto a = extract<double>(repeated.view(), 30000.0);
  const auto b = extract<double>(Image<std::uint16_t, N>(image.values.data(), image.grid, strides), 30000.0);
  EXPECT_GT(a.simplices.size(), 0u);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.simplices, b.simplices);
}

/// If no sample equals the isovalue, -V exchanges high and low samples, and with them the alternatives.
TYPED_TEST(Extract, HighAlternativeIsTheReversedLowOneOfTheNegatedImage) {
  constexpr int N = TypeParam::value;
  const auto image = noise<float, N>(N == 4 ? 6 : 15, 51);
  auto negated = image;
  for (float& value : negated.values) value = -value;
  for (ExtractOptions options : variants()) {
    if (options.ambiguity == Ambiguity::high) continue;
    const auto low = extract<double>(negated.view(), -0.5, options);
    options.ambiguity = Ambiguity::high;
    auto high = extract<double>(image.view(), 0.5, options);
    EXPECT_FALSE(same_surface(low, high));
    for (auto& simplex : high.simplices) std::swap(simplex[0], simplex[1]);
    EXPECT_TRUE(same_surface(low, high));
  }
}

TYPED_TEST(Extract, DescentAndAscentDifferByOrientationAlone) {
  constexpr int N = TypeParam::value;
  const auto image = noise<std::int16_t, N>(5, 52);
  ExtractOptions options;
  const auto descent = extract<float>(image.view(), 0.5, options);
  options.direction = GradientDirection::ascent;
  auto ascent = extract<float>(image.view(), 0.5, options);
  EXPECT_EQ(descent.direction, GradientDirection::descent);
  EXPECT_EQ(ascent.direction, GradientDirection::ascent);
  EXPECT_FALSE(same_surface(descent, ascent));
  for (auto& simplex : ascent.simplices) std::swap(simplex[0], simplex[1]);
  EXPECT_TRUE(same_surface(descent, ascent));
}

TYPED_TEST(Extract, NormalsPointTowardsLowInTheWorldWhateverTheMap) {
  constexpr int N = TypeParam::value;
  const auto plain = sample_field<float, N>(centred_grid<N>(9, 1.4), Ball<N>{});
  for (unsigned descending = 0; descending < 1u << N; ++descending)
    for (const double scale : {1.0, -1.0})
      for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high}) {
        auto image = plain;  // the ball is symmetric: its values do not change with the axes
        for (int a = 0; a < N; ++a)
          if ((descending >> a & 1u) != 0) image.grid.axes[a] = Axis::uniform(9, 1.4, -0.35);
        image.grid.linear[0][0] = 2.0 * scale;
        image.grid.linear[0][1] = 0.5;
        ExtractOptions options;
        options.ambiguity = ambiguity;
        const auto contour = extract<double>(image.view(), 0.0, options);
        const auto outwards = [](const std::array<double, N>& x) { return x; };
        EXPECT_GT(share_facing(contour, outwards), 0.999);
        options.direction = GradientDirection::ascent;
        EXPECT_LT(share_facing(extract<double>(image.view(), 0.0, options), outwards), 0.001);
      }
}

TYPED_TEST(Extract, WorldMapIsAppliedToTheVertices) {
  constexpr int N = TypeParam::value;
  auto image = noise<float, N>(5, 53);
  const auto plain = extract<double>(image.view(), 0.5);
  image.grid.linear[0][1] = 0.25;
  image.grid.linear[1][1] = -3.0;
  image.grid.offset[0] = 100.0;
  const auto mapped = extract<double>(image.view(), 0.5);
  ASSERT_EQ(plain.vertices.size(), mapped.vertices.size());
  for (std::size_t v = 0; v < plain.vertices.size(); ++v) {
    EXPECT_EQ(mapped.vertices[v][0], plain.vertices[v][0] + 0.25 * plain.vertices[v][1] + 100.0);
    EXPECT_EQ(mapped.vertices[v][1], -3.0 * plain.vertices[v][1]);
  }
}

TYPED_TEST(Extract, FloatVerticesAreRoundedDoubleVertices) {
  constexpr int N = TypeParam::value;
  const auto image = noise<double, N>(6, 54);
  const auto in_float = extract<float>(image.view(), 0.5);
  const auto in_double = extract<double>(image.view(), 0.5);
  EXPECT_EQ(in_float.simplices, in_double.simplices);
  for (std::size_t v = 0; v < in_float.vertices.size(); ++v)
    for (int a = 0; a < N; ++a) EXPECT_EQ(in_float.vertices[v][a], static_cast<float>(in_double.vertices[v][a]));
}

// ---- special samples ----

TYPED_TEST(Extract, SamplesEqualToTheIsovalueKeepTheContourAManifold) {
  constexpr int N = TypeParam::value;
  std::array<std::size_t, N> sizes;
  sizes.fill(N == 4 ? 6 : 12);
  const auto image = coarse_noise<std::uint8_t, N>(Grid<N>::unit(sizes), 61, 3);
  for (ExtractOptions options : variants()) {
    SCOPED_TRACE(describe(options));
    const auto exact = expect_oriented_manifold(extract<double>(image.view(), 1.0, options));
    EXPECT_GT(exact.degenerate_simplices, 0u);
    options.epsilon = 0.01;
    const auto apart = expect_oriented_manifold(extract<double>(image.view(), 1.0, options));
    EXPECT_EQ(apart.degenerate_simplices, 0u);
    EXPECT_EQ(apart.euler, exact.euler);
  }
}

TYPED_TEST(Extract, EpsilonKeepsPointsAwayFromSamples) {
  constexpr int N = TypeParam::value;
  const auto image = noise<std::uint8_t, N>(6, 62);
  ExtractOptions options;
  options.epsilon = 0.25;
  std::size_t points = 0;
  for (const auto& vertex : extract<double>(image.view(), 100.0, options).vertices) {
    const auto off = [](double x) { return std::abs(x - std::round(x)); };
    // Except for barycentres, exactly one coordinate is not a sample's.
    if (std::count_if(vertex.begin(), vertex.end(), [&](double x) { return off(x) != 0.0; }) != 1) continue;
    ++points;
    for (const double x : vertex) EXPECT_TRUE(off(x) == 0.0 || off(x) >= 0.25) << x;
  }
  EXPECT_EQ(points, expected_points(image.view(), 100.0).size());
}

TYPED_TEST(Extract, AnImageThatEqualsTheIsovalueEverywhereIsHigh) {
  constexpr int N = TypeParam::value;
  const auto image = sample_field<float, N>(centred_grid<N>(4, 1.0), [](const Point<N>&) { return 0.5; });
  EXPECT_TRUE(extract<float>(image.view(), 0.5).vertices.empty());
  ExtractOptions options;
  options.close = true;
  EXPECT_NEAR(enclosed_content(extract<double>(image.view(), 0.5, options)), std::pow(2.0, N), 1e-12);
}

TYPED_TEST(Extract, InfiniteSamplesGiveFiniteVertices) {
  constexpr int N = TypeParam::value;
  auto image = noise<float, N>(N == 4 ? 5 : 9, 63);
  std::mt19937_64 bits(64);
  for (float& value : image.values) {
    const double die = unit_random(bits);
    if (die < 0.2) value = kInfinity;
    if (die > 0.8) value = -kInfinity;
  }
  for (const ExtractOptions& options : variants()) {
    const auto contour = extract<double>(image.view(), 0.5, options);
    EXPECT_GT(contour.vertices.size(), 0u);
    expect_oriented_manifold(contour);
    for (const auto& vertex : contour.vertices)
      for (int a = 0; a < N; ++a) EXPECT_TRUE(std::isfinite(vertex[a]));
  }
}

TEST(ExtractValues, InfinitiesPullThePointToTheFiniteEndOrTheMiddle) {
  const auto x_of = [](float a, float b) {
    const float values[] = {a, b, a, b};
    const auto contour = extract<double>(Image<float, 2>(values, Grid<2>::unit({2, 2})), 1.0);
    EXPECT_EQ(contour.vertices.size(), 2u);
    return contour.vertices.empty() ? -1.0 : contour.vertices[0][0];
  };
  EXPECT_EQ(x_of(0.0f, 4.0f), 0.25);
  EXPECT_EQ(x_of(0.0f, kInfinity), 0.0);
  EXPECT_EQ(x_of(-kInfinity, 2.0f), 1.0);
  EXPECT_EQ(x_of(kInfinity, 0.0f), 1.0);
  EXPECT_EQ(x_of(2.0f, -kInfinity), 0.0);
  EXPECT_EQ(x_of(-kInfinity, kInfinity), 0.5);
  EXPECT_EQ(x_of(kInfinity, -kInfinity), 0.5);
}

TEST(ExtractValues, HugeDifferencesDoNotOverflow) {
  const double huge = std::numeric_limits<double>::max();
  const double values[] = {-huge, huge, -huge, huge};
  const auto contour = extract<double>(Image<double, 2>(values, Grid<2>::unit({2, 2})), 0.0);
  ASSERT_EQ(contour.vertices.size(), 2u);
  EXPECT_EQ(contour.vertices[0][0], 0.5);
}

/// Compares the image's type with the isovalue as a real number, at and around the limits of the type.
template <Value T>
void expect_exact_classification(const std::vector<double>& isovalues, const std::vector<T>& samples) {
  for (const double isovalue : isovalues)
    for (const T sample : samples)
      for (const T other : samples) {
        const T values[] = {sample, other, sample, other};
        const auto contour = extract<float>(Image<T, 2>(values, Grid<2>::unit({2, 2})), isovalue);
        const bool differ = (static_cast<double>(sample) >= isovalue) != (static_cast<double>(other) >= isovalue);
        EXPECT_EQ(contour.vertices.size(), differ ? 2u : 0u)
            << static_cast<double>(sample) << ", " << static_cast<double>(other) << " at " << isovalue;
      }
}

TEST(ExtractValues, AreComparedExactlyInEveryType) {
  expect_exact_classification<std::uint8_t>({-1e300, -0.5, 0, 0.5, 1, 254.5, 255, 255.1, 1e300}, {0, 1, 254, 255});
  expect_exact_classification<std::int8_t>({-129, -128, -127.5, -0.5, 0, 126.5, 127, 127.5}, {-128, -127, 0, 127});
  expect_exact_classification<std::uint16_t>({-1, 0, 65534.5, 65535, 65536}, {0, 1, 65534, 65535});
  expect_exact_classification<std::int16_t>({-32769, -32768, 0, 32767, 32768}, {-32768, 0, 32767});
  expect_exact_classification<std::int32_t>({-2147483649.0, -2147483648.0, 0.5, 2147483647.0, 2147483648.0},
                                            {-2147483647 - 1, 0, 1, 2147483647});
  // 0.1 is not a float: the nearest float is larger, the one nearest to -0.1 smaller.
  expect_exact_classification<float>({0.1, -0.1, 1e300, -1e300, 0.0},
                                     {0.1f, std::nextafter(0.1f, 0.0f), -0.1f, std::nextafter(-0.1f, 0.0f), 0.0f, -0.0f,
                                      kInfinity, -kInfinity, std::numeric_limits<float>::max()});
}

// ---- missing values ----

TYPED_TEST(Extract, IsOpenOnlyAtTheBorderAndAtMissingValues) {
  constexpr int N = TypeParam::value;
  std::array<std::size_t, N> sizes;
  sizes.fill(N == 4 ? 6 : 12);
  sizes[0] += 63;
  for (const double share : {0.002, 0.05, 0.3}) {
    const auto image = noise_with_missing<float, N>(Grid<N>::unit(sizes), 71, share);
    for (const ExtractOptions& options : variants()) {
      SCOPED_TRACE(describe(options) + ", missing " + std::to_string(share));
      const auto contour = extract<double>(image.view(), 0.5, options);
      EXPECT_GT(expect_oriented_manifold(contour).simplices, 0u);
      EXPECT_TRUE(is_open_only_where_data_end(contour, image.view()));
    }
  }
}

TYPED_TEST(Extract, OfAnAllMissingImageIsEmpty) {
  constexpr int N = TypeParam::value;
  const auto image = sample_field<float, N>(centred_grid<N>(4, 1.0), [](const Point<N>&) { return kNan; });
  for (ExtractOptions options : variants()) {
    options.close = true;
    const auto [contour, stats] = extract_with_stats<float>(image.view(), 0.0, options);
    EXPECT_TRUE(contour.vertices.empty() && contour.simplices.empty());
    EXPECT_EQ(stats.active_tiles, 0u);
  }
}

TYPED_TEST(Extract, OfAnImageWithoutTilesIsEmpty) {
  constexpr int N = TypeParam::value;
  for (int flat = 0; flat < N; ++flat) {
    std::array<std::size_t, N> sizes;
    sizes.fill(5);
    sizes[flat] = 1;
    const auto image = noise<std::uint8_t, N>(sizes, 73);
    ExtractOptions options;
    options.close = true;
    const auto extraction = extract_with_stats<float>(image.view(), 127.5, options);
    EXPECT_TRUE(extraction.contour.vertices.empty());
    EXPECT_EQ(extraction.stats.tiles, 0u);
  }
}

TYPED_TEST(Extract, OfTheSmallestImageWorks) {
  constexpr int N = TypeParam::value;
  const auto image = noise<std::uint8_t, N>(2, 76);
  for (ExtractOptions options : variants()) {
    options.close = true;
    expect_closed_manifold(extract<double>(image.view(), 100.0, options));
  }
}

// ---- the same in two dimensions ----

/// The layers t = k of a 4D contour contain the points of the steps' 3D contours, bit by bit.
TEST(Extract4d, HoldsThePointsOfThe3dContoursOfItsSteps) {
  auto image = noise<float, 4>({9, 7, 6, 4}, 81);
  image.grid.axes[3] = Axis::rectilinear({0.0, 0.7, 1.1, 3.0});
  image.grid.axes[1] = Axis::uniform(7, 0.3, -1.7);
  image.grid.linear = {{{0.9, 0.1, 0.0, 0.0}, {-0.2, 1.1, 0.3, 0.0}, {0.0, 0.1, 0.7, 0.0}, {0.0, 0.0, 0.0, 1.0}}};
  image.grid.offset = {5.0, -3.0, 0.1, 0.0};
  Grid<3> grid;
  for (int a = 0; a < 3; ++a) {
    grid.axes[a] = image.grid.axes[a];
    grid.offset[a] = image.grid.offset[a];
    for (int b = 0; b < 3; ++b) grid.linear[a][b] = image.grid.linear[a][b];
  }
  for (const ExtractOptions& options : variants()) {
    SCOPED_TRACE(describe(options));
    const auto contour = extract<double>(image.view(), 0.5, options);
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<std::array<double, 3>> points;
      for (const auto& vertex : contour.vertices)
        if (vertex[3] == image.grid.axes[3][k]) points.push_back({vertex[0], vertex[1], vertex[2]});
      std::sort(points.begin(), points.end());
      const Image<float, 3> step(image.values.data() + k * 9 * 7 * 6, grid);
      EXPECT_EQ(points, sorted_vertices(extract<double>(step, 0.5, options))) << "step " << k;
    }
  }
}

// ---- reports and errors ----

TYPED_TEST(Extract, StatsCountTilesThatHoldHighAndLowCorners) {
  constexpr int N = TypeParam::value;
  const auto image = noise_with_missing<float, N>(Grid<N>::unit(noise<float, N>(6, 0).grid.sizes()), 91, 0.02);
  const ExtractStats stats = extract_with_stats<float>(image.view(), 0.9).stats;
  std::uint64_t tiles = 0;
  std::uint64_t active = 0;
  for_each_sample<N>(image.grid, [&](std::size_t, const std::array<std::size_t, N>& index) {
    std::array<std::ptrdiff_t, N> tile;
    bool inside = true;
    for (int a = 0; a < N; ++a) {
      tile[a] = static_cast<std::ptrdiff_t>(index[a]);
      inside = inside && index[a] + 1 < 6;
    }
    if (!inside) return;
    ++tiles;
    if (!is_valid_tile<float, N>(image.view(), tile)) return;
    unsigned high = 0;
    for (unsigned corner = 0; corner < 1u << N; ++corner) {
      auto at = index;
      for (int a = 0; a < N; ++a) at[a] += corner >> a & 1u;
      high += image.view()(at) >= 0.9f ? 1 : 0;
    }
    active += high != 0 && high != 1u << N ? 1 : 0;
  });
  EXPECT_EQ(stats.tiles, tiles);
  EXPECT_EQ(stats.active_tiles, active);
  EXPECT_GE(stats.classify_seconds, 0.0);
  EXPECT_GT(stats.generate_seconds, 0.0);
}

TYPED_TEST(Extract, CopiesTheAxesNamesAndUnits) {
  constexpr int N = TypeParam::value;
  auto image = noise<std::uint8_t, N>(3, 92);
  image.grid.axes[0].name = "lon";
  image.grid.axes[N - 1].unit = "s";
  const auto contour = extract<float>(image.view(), 100.0);
  EXPECT_EQ(contour.axis_names[0], "lon");
  EXPECT_EQ(contour.axis_units[N - 1], "s");
}

TYPED_TEST(Extract, ReportsRisingProgressAndStopsWhenToldSo) {
  constexpr int N = TypeParam::value;
  const auto image = noise<std::uint8_t, N>(6, 93);
  ExtractOptions options;
  std::vector<double> fractions;
  options.work.progress = [&](double fraction) {
    fractions.push_back(fraction);
    return true;
  };
  extract<float>(image.view(), 100.0, options);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  ASSERT_GE(fractions.size(), 2u);
  EXPECT_EQ(fractions.front(), 0.0);
  EXPECT_EQ(fractions.back(), 1.0);

  options.work.progress = [](double fraction) { return fraction < 0.5; };
  try {
    extract<float>(image.view(), 100.0, options);
    FAIL() << "not cancelled";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Cancelled);
  }
}

template <class Call>
void expect_error(ErrorCode code, const std::string& part, const Call& call) {
  try {
    call();
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TYPED_TEST(Extract, RejectsIsovaluesThatAreNotFinite) {
  constexpr int N = TypeParam::value;
  const auto image = noise<std::uint8_t, N>(3, 94);
  expect_error(ErrorCode::InvalidIsovalue, "nan", [&] { extract<float>(image.view(), std::nan("")); });
  expect_error(ErrorCode::InvalidIsovalue, "inf", [&] { extract<float>(image.view(), double{kInfinity}); });
}

TYPED_TEST(Extract, RejectsEpsilonOutsideOfItsRange) {
  constexpr int N = TypeParam::value;
  const auto image = noise<std::uint8_t, N>(3, 95);
  for (const double epsilon : {-0.1, 0.5, std::nan("")}) {
    ExtractOptions options;
    options.epsilon = epsilon;
    expect_error(ErrorCode::InvalidArgument, "epsilon", [&] { extract<float>(image.view(), 100.0, options); });
  }
}

TYPED_TEST(Extract, AnIsovalueOutsideOfTheValuesGivesAnEmptyContour) {
  constexpr int N = TypeParam::value;
  const auto image = noise<std::uint8_t, N>(4, 96);
  EXPECT_TRUE(extract<float>(image.view(), 255.5).vertices.empty());
  EXPECT_TRUE(extract<float>(image.view(), -1.0).vertices.empty());
}

}  // namespace
}  // namespace tegl::test
