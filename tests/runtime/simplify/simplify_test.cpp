// SPDX-License-Identifier: BSD-3-Clause
//
// Invariants of simplified contours: manifold, border, caps and error bound, for all methods, in 2D to 4D, on noise and
// on smooth fields.
#include "tegl/simplify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "ambiguity/variants.hpp"
#include "distance_oracle.hpp"
#include "errors.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "simplified.hpp"
#include "tegl/deviation.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

template <class T>
class Simplify : public ::testing::Test {};
using Dimensions =
    ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(Simplify, Dimensions);

template <int N>
Contour<N, double> ball(std::size_t samples) {
  const auto image = sample_field<float, N>(centred_grid<N>(samples, 1.3), Ball<N>{});
  ExtractOptions options;
  options.normals = Normals::differences;
  return extract<double>(image.view(), 0.0, options);
}

template <int N>
constexpr int kSamples = N == 4 ? 40 : 300;

template <int N>
std::size_t ball_samples() {
  return N == 2 ? 100 : (N == 3 ? 24 : 7);
}

template <int N>
SimplifyOptions<N> with_ratio(SimplifyMethod method, double ratio) {
  SimplifyOptions<N> options;
  options.method = method;
  options.ratio = ratio;
  return options;
}

TYPED_TEST(Simplify, KeepsTheManifoldAndItsBorderInNoise) {
  constexpr int N = TypeParam::value;
  for (std::uint64_t seed = 0; seed < 3; ++seed)
    for (const ExtractOptions& extraction : variants())
      for (const SimplifyMethod method : kMethods) {
        SCOPED_TRACE(name(method) + ", " + describe(extraction) + ", seed " + std::to_string(seed));
        const auto image = noise<float, N>(N == 4 ? 4 : 10, seed);
        const auto contour = extract<double>(image.view(), 0.55, extraction);
        auto options = with_ratio<N>(method, 0.05);
        options.measure = false;
        const auto result = simplify(contour, options).contour;
        expect_same_topology(check(contour), check(result));
        EXPECT_LT(result.simplices.size(), contour.simplices.size() * 9 / 10);
        EXPECT_EQ(border_points(result), border_points(contour));
      }
}

TYPED_TEST(Simplify, MovesTheBorderWithinTheImagesBorderIfItMay) {
  constexpr int N = TypeParam::value;
  const auto image =
      noise_with_missing<float, N>(Grid<N>::unit(noise<float, N>(N == 4 ? 4 : 9, 1).grid.sizes()), 5, 0.0);
  const auto contour = extract<double>(image.view(), 0.55);
  for (const SimplifyMethod method : kMethods) {
    SCOPED_TRACE(name(method));
    auto options = with_ratio<N>(method, 0.05);
    options.border = SimplifyBorder::within;
    options.measure = false;
    const auto result = simplify(contour, options).contour;
    expect_same_topology(check(contour), check(result));
    if constexpr (N > 2) {
      EXPECT_LT(boundary_faces(result).size(), boundary_faces(contour).size());
    }
    const double last = static_cast<double>(image.grid.axes[0].size() - 1);
    for (const auto& face : boundary_faces(result)) {
      bool in_side = false;
      for (int a = 0; a < N; ++a)
        for (const double side : {0.0, last})
          in_side =
              in_side || std::all_of(face.begin(), face.end(), [&](Index v) { return result.vertices[v][a] == side; });
      EXPECT_TRUE(in_side);
    }
  }
}

TYPED_TEST(Simplify, KeepsCapsInTheBorderAndTheContourClosed) {
  constexpr int N = TypeParam::value;
  const auto image = noise<float, N>(N == 4 ? 4 : 9, 11);
  ExtractOptions extraction;
  extraction.close = true;
  const auto contour = extract<double>(image.view(), 0.5, extraction);
  const double last = static_cast<double>(image.grid.axes[0].size() - 1);
  const auto count_caps = [&](const Contour<N, double>& c) {
    std::size_t caps = 0;
    for (const auto& simplex : c.simplices)
      for (int a = 0; a < N; ++a)
        for (const double side : {0.0, last})
          caps += std::all_of(simplex.begin(), simplex.end(), [&](Index v) { return c.vertices[v][a] == side; });
    return caps;
  };
  for (const SimplifyMethod method : kMethods) {
    SCOPED_TRACE(name(method));
    auto options = with_ratio<N>(method, 0.2);
    options.measure = false;
    const auto result = simplify(contour, options).contour;
    expect_same_topology(check(contour), check(result));
    EXPECT_GT(count_caps(result), 0u);
    for (const auto& vertex : result.vertices)
      for (int a = 0; a < N; ++a) {
        EXPECT_GE(vertex[a], 0.0);
        EXPECT_LE(vertex[a], last);
      }
  }
}

/// A box of high samples: flat parts are simplified, corners stay, and the content is exactly preserved.
TYPED_TEST(Simplify, LeavesABoxWithItsCornersAlone) {
  constexpr int N = TypeParam::value;
  const auto image = sample_field<float, N>(centred_grid<N>(N == 4 ? 4 : 9, 1.0), [](const Point<N>&) { return 1.0; });
  ExtractOptions extraction;
  extraction.close = true;
  const auto contour = extract<double>(image.view(), 0.0, extraction);
  for (const SimplifyMethod method : kMethods) {
    SCOPED_TRACE(name(method));
    const auto [result, stats] = simplify(contour, with_ratio<N>(method, 0.0));
    expect_closed_manifold(result);
    // Facets with two fixed corners cannot be contracted, so that method leaves more vertices.
    const std::size_t corners = std::size_t{1} << N;
    EXPECT_GE(result.vertices.size(), corners);
    EXPECT_LE(result.vertices.size(), method == SimplifyMethod::facets ? 4 * corners : corners + corners / 2);
    if (N <= 3 && method != SimplifyMethod::facets) {
      EXPECT_EQ(result.simplices.size(), N == 2 ? 4u : 12u);
    }
    EXPECT_NEAR(enclosed_content(result), enclosed_content(contour), 1e-10 * std::abs(enclosed_content(contour)));
    EXPECT_LE(*stats.error(), 1e-10);
  }
}

TYPED_TEST(Simplify, ErrorsAreBoundedAsSamplesShow) {
  constexpr int N = TypeParam::value;
  const auto contour = ball<N>(ball_samples<N>());
  for (const SimplifyMethod method : kMethods) {
    SCOPED_TRACE(name(method));
    const auto [result, stats] = simplify(contour, with_ratio<N>(method, 0.1));
    expect_same_topology(check(contour), check(result));
    EXPECT_LE(result.simplices.size(), contour.simplices.size() / 10 + 1);
    EXPECT_EQ(stats.simplices_after, result.simplices.size());
    const double sampled = sampled_deviation(contour, result, kSamples<N>, 1);
    EXPECT_GE(*stats.error_of_original, sampled);
    EXPECT_GE(*stats.error_of_result, sampled_deviation(result, contour, kSamples<N>, 2));
    EXPECT_LE(*stats.error_of_original, 2.5 * sampled + 1e-3);
    // The largest value of the attribute is the bound.
    ASSERT_EQ(result.vertex_attributes.size(), 1u);
    const Attribute& attribute = result.vertex_attributes[0];
    EXPECT_EQ(attribute.name, "simplification_error");
    ASSERT_EQ(attribute.values.size(), result.vertices.size());
    EXPECT_EQ(*std::max_element(attribute.values.begin(), attribute.values.end()), *stats.error());
  }
}

TYPED_TEST(Simplify, KeepsTheLargestError) {
  constexpr int N = TypeParam::value;
  const auto contour = ball<N>(ball_samples<N>());
  for (const SimplifyMethod method : kMethods)
    for (const double largest : {0.05, 0.01}) {
      if (N == 4 && (method != SimplifyMethod::quadric || largest < 0.05)) continue;  // takes too long
      SCOPED_TRACE(name(method) + ", " + std::to_string(largest));
      SimplifyOptions<N> options;
      options.method = method;
      options.max_error = largest;
      const auto [result, stats] = simplify(contour, options);
      expect_same_topology(check(contour), check(result));
      EXPECT_LE(*stats.error(), largest + 1e-9);
      EXPECT_LE(deviation(contour, result).bound, largest + 1e-9);
      EXPECT_LE(deviation(result, contour).bound, largest + 1e-9);
      EXPECT_LT(result.simplices.size(), contour.simplices.size());
    }
}

TYPED_TEST(Simplify, FurtherErrorsAreAddedToEarlierOnes) {
  constexpr int N = TypeParam::value;
  const auto contour = ball<N>(ball_samples<N>());
  const auto [once, first] = simplify(contour, with_ratio<N>(SimplifyMethod::quadric, 0.3));
  const auto [twice, second] = simplify(once, with_ratio<N>(SimplifyMethod::quadric, 0.3));
  EXPECT_GE(*second.error(), *first.error());
  EXPECT_GE(*second.error_of_original, deviation(contour, twice).least);
  ASSERT_EQ(twice.vertex_attributes.size(), 1u);
}

TYPED_TEST(Simplify, CarriesNormalsAndAttributesAlong) {
  constexpr int N = TypeParam::value;
  auto contour = ball<N>(ball_samples<N>());
  Attribute place{"place", "mm", N, {}};
  for (const auto& vertex : contour.vertices) place.values.insert(place.values.end(), vertex.begin(), vertex.end());
  contour.vertex_attributes.push_back(place);
  Attribute number{"number", "", 1, {}};
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) number.values.push_back(static_cast<double>(s));
  contour.simplex_attributes.push_back(number);
  for (const SimplifyMethod method : kMethods) {
    SCOPED_TRACE(name(method));
    auto options = with_ratio<N>(method, 0.3);
    options.measure = N < 4;
    const auto result = simplify(contour, options).contour;
    ASSERT_EQ(result.normals.size(), result.vertices.size());
    ASSERT_EQ(result.vertex_attributes.size(), N < 4 ? 2u : 1u);
    EXPECT_EQ(result.vertex_attributes[0].name, "place");
    EXPECT_EQ(result.vertex_attributes[0].unit, "mm");
    for (std::size_t v = 0; v < result.vertices.size(); ++v) {
      double along = 0.0, length = 0.0, way = 0.0;
      for (int a = 0; a < N; ++a) {
        along += result.normals[v][a] * result.vertices[v][a];
        length += result.normals[v][a] * result.normals[v][a];
        way = std::max(way, std::abs(result.vertex_attributes[0].values[v * N + a] - result.vertices[v][a]));
      }
      EXPECT_NEAR(length, 1.0, 1e-9);
      EXPECT_GT(along, 0.9);  // for the unit ball: outwards
      EXPECT_LE(way, method == SimplifyMethod::vertices ? 0.0 : 0.6);
    }
    ASSERT_EQ(result.simplex_attributes.size(), 1u);
    ASSERT_EQ(result.simplex_attributes[0].values.size(), result.simplices.size());
    EXPECT_TRUE(std::is_sorted(result.simplex_attributes[0].values.begin(), result.simplex_attributes[0].values.end()));
  }
}

TYPED_TEST(Simplify, VerticesMethodKeepsVerticesOfTheOriginal) {
  constexpr int N = TypeParam::value;
  const auto contour = ball<N>(ball_samples<N>());
  const std::set<std::array<double, N>> original(contour.vertices.begin(), contour.vertices.end());
  auto options = with_ratio<N>(SimplifyMethod::vertices, 0.2);
  options.measure = false;
  const auto result = simplify(contour, options).contour;
  for (const auto& vertex : result.vertices) EXPECT_TRUE(original.contains(vertex));
}

TYPED_TEST(Simplify, FacetsMethodStopsAtTheLargestCurvature) {
  constexpr int N = TypeParam::value;
  const auto contour = ball<N>(ball_samples<N>());
  auto options = with_ratio<N>(SimplifyMethod::facets, 0.0);
  options.measure = false;
  options.max_curvature = 0.01;  // a sphere of radius 1 has curvature 1 everywhere
  EXPECT_EQ(simplify(contour, options).contour.simplices.size(), contour.simplices.size());
  options.max_curvature = 100.0;
  EXPECT_LT(simplify(contour, options).contour.simplices.size(), contour.simplices.size() / 4);
}

TYPED_TEST(Simplify, IsTheSameForAnyNumberOfThreadsAndInFloat) {
  constexpr int N = TypeParam::value;
  const auto image = sample_field<float, N>(centred_grid<N>(ball_samples<N>(), 1.3), Ball<N>{});
  const auto contour = extract<float>(image.view(), 0.0);
  for (const SimplifyMethod method : kMethods) {
    SCOPED_TRACE(name(method));
    if (N == 4 && method != SimplifyMethod::quadric) continue;  // takes too long
    auto one = with_ratio<N>(method, 0.2), four = one;
    one.work.threads = 1;
    four.work.threads = 4;
    const auto a = simplify(contour, one).contour, b = simplify(contour, four).contour;
    EXPECT_EQ(a.vertices, b.vertices);
    EXPECT_EQ(a.simplices, b.simplices);
    EXPECT_EQ(a.vertex_attributes[0].values, b.vertex_attributes[0].values);
    expect_same_topology(check(contour), check(a));
  }
}

TYPED_TEST(Simplify, ScaleDecidesWhatIsFar) {
  constexpr int N = TypeParam::value;
  const auto contour = ball<N>(ball_samples<N>());
  SimplifyOptions<N> options;
  options.max_error = 0.02;
  const auto fine = simplify(contour, options).contour;
  options.scale.fill(0.1);  // in centimetres: 0.02 of them is ten times the length
  EXPECT_LT(simplify(contour, options).contour.simplices.size(), fine.simplices.size());
}

TYPED_TEST(Simplify, EarlierErrorsCountByTheScaleTheyWereTakenAt) {
  constexpr int N = TypeParam::value;
  const auto contour = ball<N>(ball_samples<N>());
  auto options = with_ratio<N>(SimplifyMethod::quadric, 0.5);
  options.scale[0] = 0.5;
  const auto first = simplify(contour, options);
  auto once = first.contour;
  ASSERT_EQ(once.vertex_attributes.size(), 1u);
  EXPECT_EQ(once.vertex_attributes[0].unit, N == 2 ? "scale 0.5,1" : (N == 3 ? "scale 0.5,1,1" : "scale 0.5,1,1,1"));
  options = with_ratio<N>(SimplifyMethod::quadric, 1.0);  // nothing is removed: its error is that of the input
  const auto twice = simplify(once, options);
  EXPECT_NEAR(*twice.stats.error(), 2.0 * *first.stats.error(), 1e-9);  // lengths along the first axis have doubled
  EXPECT_EQ(twice.contour.vertex_attributes[0].unit, contour.axis_units[0]);
  options.scale.fill(3.0);
  EXPECT_NEAR(*simplify(twice.contour, options).stats.error(), 6.0 * *first.stats.error(), 1e-9);
  for (const char* unit : {"scale 1", "scale 1,1,1,1,1", "scale 0,1,1,1", "scale 1,x,1,1"}) {
    once.vertex_attributes[0].unit = unit;
    expect_error(ErrorCode::InvalidArgument, unit, [&] { simplify(once, options); });
  }
}

TYPED_TEST(Simplify, AutomaticScaleMakesOtherUnitsAsFineAsTheFirst) {
  constexpr int N = TypeParam::value;
  auto contour = ball<N>(ball_samples<N>());
  Vector<N> factors;
  factors.fill(1.0);
  factors[N - 1] = 20.0;
  contour = scale_axes(std::move(contour), factors);
  EXPECT_EQ(automatic_scale(contour)[N - 1], 1.0);  // of the same unit
  contour.axis_units[N - 1] = "s";
  const auto scale = automatic_scale(contour);
  for (int a = 0; a + 1 < N; ++a) EXPECT_EQ(scale[a], 1.0);
  EXPECT_NEAR(scale[N - 1], 0.05, 0.01);
}

/// If samples equal the isovalue, vertices coincide: their edges are contracted first, without error.
TYPED_TEST(Simplify, RemovesSimplicesOfZeroSize) {
  constexpr int N = TypeParam::value;
  const auto image = sample_field<float, N>(centred_grid<N>(N == 4 ? 5 : 9, N == 4 ? 1.0 : 2.0), [](const Point<N>& x) {
    double sum = 0.0;
    for (const double c : x) sum += std::abs(c);
    return 1.5 - sum;
  });
  const auto contour = extract<double>(image.view(), 0.0);
  ASSERT_GT(check(contour).degenerate_simplices, 0u);
  auto options = with_ratio<N>(SimplifyMethod::quadric, 0.5);
  options.measure = false;
  const auto result = simplify(contour, options).contour;
  expect_same_topology(check(contour), check(result));
  EXPECT_LT(check(result).degenerate_simplices, check(contour).degenerate_simplices);
}

/// Samples that equal the isovalue cause degenerate parts, whose vertices have no hyperplanes that restrict them.
TYPED_TEST(Simplify, KeepsTheLargestErrorWhereSimplicesHaveNoSize) {
  constexpr int N = TypeParam::value;
  constexpr std::size_t kSize = N == 2 ? 60 : (N == 3 ? 9 : 4);
  const auto image = coarse_noise<std::uint8_t, N>(centred_grid<N>(kSize, 0.5 * (kSize - 1)), 14, 3);
  const auto contour = extract<double>(image.view(), 1.0);
  const MeshReport before = check(contour);
  ASSERT_GT(before.degenerate_simplices, before.simplices / 20);
  for (const double largest : {0.05, 0.2}) {
    if (N == 4 && largest < 0.2) continue;  // takes too long
    SCOPED_TRACE(largest);
    SimplifyOptions<N> options;
    options.max_error = largest;
    const auto [result, stats] = simplify(contour, options);
    expect_same_topology(before, check(result));
    EXPECT_LE(*stats.error(), largest + 1e-9);
    EXPECT_LE(deviation(contour, result).least, largest + 1e-9);
    EXPECT_LE(deviation(result, contour).least, largest + 1e-9);
    EXPECT_EQ(stats.end, SimplifyEnd::error);
    EXPECT_LT(result.simplices.size(), contour.simplices.size() * 97 / 100);
  }
}

/// For a count, a few contractions in thin parts would cause most of the error: the search finds others.
TYPED_TEST(Simplify, IsNearerByACountThanOneRoundIs) {
  constexpr int N = TypeParam::value;
  if (N == 4) GTEST_SKIP() << "noise that small is as rough as one round is";
  for (std::uint64_t seed = 0; seed < 2; ++seed) {
    const auto image = noise<float, N>(N == 3 ? 8 : 40, seed);
    const auto contour = extract<double>(image.view(), 0.55);
    auto options = with_ratio<N>(SimplifyMethod::quadric, 0.8);
    const SimplifyStats stats = simplify(contour, options).stats;
    options.measure = false;
    const auto once = simplify(contour, options).contour;
    const double reached = std::max(deviation(contour, once).least, deviation(once, contour).least);
    EXPECT_LT(*stats.error(), 0.8 * reached);
  }
}

/// With a count, an irrelevant largest error does not change the count reached or worsen the error.
TYPED_TEST(Simplify, IsAsNearByTwoGoalsAsByTheCountWhereTheErrorLetsIt) {
  constexpr int N = TypeParam::value;
  const auto contour = ball<N>(N == 2 ? 60 : (N == 3 ? 16 : 5));
  for (const SimplifyMethod method : kMethods) {
    if (N > 2 && method != SimplifyMethod::quadric) continue;  // takes too long
    SCOPED_TRACE(name(method));
    auto options = with_ratio<N>(method, 0.5);
    const auto [by_count, alone] = simplify(contour, options);
    options.max_error = 50.0;
    auto [by_both, both] = simplify(contour, options);
    EXPECT_EQ(by_both.vertices, by_count.vertices);
    EXPECT_EQ(by_both.simplices, by_count.simplices);
    EXPECT_EQ(both.error(), alone.error());
    EXPECT_EQ(both.end, SimplifyEnd::count);
    options.max_error = 0.5 * *alone.error();
    both = simplify(contour, options).stats;
    EXPECT_LE(*both.error(), *options.max_error + 1e-9);
    EXPECT_GE(both.simplices_after, alone.simplices_after);
  }
}

/// Large contours are not searched: one round has the bound, for any number of threads.
TEST(SimplifyLarge, TakesOneRoundWithABound) {
  const auto contour = ball<3>(100);
  ASSERT_GT(contour.simplices.size(), 50'000u);
  auto options = with_ratio<3>(SimplifyMethod::quadric, 0.1);
  double last = 0.0;
  options.work.threads = 2;
  options.work.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  };
  const auto [result, stats] = simplify(contour, options);
  EXPECT_EQ(last, 1.0);
  EXPECT_EQ(stats.rounds, 1u);
  EXPECT_EQ(stats.end, SimplifyEnd::count);
  expect_same_topology(check(contour), check(result));
  EXPECT_GE(*stats.error_of_original, sampled_deviation(contour, result, 200, 1));
  EXPECT_GE(*stats.error_of_result, sampled_deviation(result, contour, 200, 2));
  options.work = {.threads = 1};
  EXPECT_EQ(simplify(contour, options).contour.vertices, result.vertices);
  options.measure = false;
  const auto once = simplify(contour, options).contour;
  EXPECT_LT(*stats.error(), std::max(deviation(contour, once).bound, deviation(once, contour).bound));
}

TEST(Simplify2, CapsOfASlantedGridStayInItsBorder) {
  auto grid = centred_grid<3>(12, 1.0);
  grid.linear[0][1] = 0.4;
  grid.linear[2][0] = -0.3;
  grid.offset[1] = 2.0;
  const auto image = sample_field<float, 3>(grid, Ball<3>{{0.9, 0.9, 0.9}, 1.2});
  ExtractOptions extraction;
  extraction.close = true;
  const auto contour = extract<double>(image.view(), 0.0, extraction);
  auto options = with_ratio<3>(SimplifyMethod::quadric, 0.2);
  options.planes = border_planes(grid);
  ASSERT_EQ(options.planes.size(), 6u);
  const auto result = simplify(contour, options).contour;
  expect_same_topology(check(contour), check(result));
  // Each plane has at least the vertices of a cap, and no vertex is beyond it.
  for (const auto& plane : options.planes) {
    const auto height = [&](const std::array<double, 3>& p) {
      return plane.normal[0] * p[0] + plane.normal[1] * p[1] + plane.normal[2] * p[2] - plane.offset;
    };
    const auto in_plane = [&](const Contour<3, double>& c) {
      return std::count_if(c.simplices.begin(), c.simplices.end(), [&](const auto& simplex) {
        return std::all_of(simplex.begin(), simplex.end(),
                           [&](Index v) { return std::abs(height(c.vertices[v])) < 1e-9; });
      });
    };
    EXPECT_EQ(in_plane(contour) > 0, in_plane(result) > 0);
  }
}

TEST(SimplifyFast, TakesASmoothSurfaceAndRefusesWhatIsNoManifold) {
  const auto contour = ball<3>(24);
  auto options = with_ratio<3>(SimplifyMethod::fast, 0.1);
  if (!has_fast_simplify()) {
    expect_error(ErrorCode::InvalidArgument, "meshoptimizer", [&] { simplify(contour, options); });
    return;
  }
  const auto [result, stats] = simplify(contour, options);
  expect_same_topology(check(contour), check(result));
  EXPECT_GE(*stats.error_of_original, sampled_deviation(contour, result, kSamples<3>, 1));
  options = {};
  options.method = SimplifyMethod::fast;
  options.max_error = 0.01;
  EXPECT_LE(*simplify(contour, options).stats.error(), 0.01 + 1e-9);

  const auto image = noise<float, 3>(12, 7);
  const auto rough = extract<double>(image.view(), 0.6);
  options = with_ratio<3>(SimplifyMethod::fast, 0.1);
  options.measure = false;
  expect_error(ErrorCode::UnsupportedData, "not an oriented manifold", [&] { simplify(rough, options); });
  options.allow_nonmanifold = true;
  const MeshReport report = check(simplify(rough, options).contour);
  EXPECT_GT(report.nonmanifold_simplices + report.bad_links, 0u);
}

TEST(SimplifyErrors, NameWhatIsWrong) {
  const auto contour = ball<3>(8);
  SimplifyOptions<3> options;
  expect_error(ErrorCode::InvalidArgument, "no goal", [&] { simplify(contour, options); });
  options.ratio = 1.5;
  expect_error(ErrorCode::InvalidArgument, "1.5", [&] { simplify(contour, options); });
  options.ratio = 0.5;
  options.max_error = -1.0;
  expect_error(ErrorCode::InvalidArgument, "-1", [&] { simplify(contour, options); });
  options.max_error.reset();
  options.scale[0] = 0.0;
  expect_error(ErrorCode::InvalidArgument, "scale", [&] { simplify(contour, options); });
  options.scale[0] = 1.0;
  options.planes.resize(21);
  expect_error(ErrorCode::InvalidArgument, "21 hyperplanes", [&] { simplify(contour, options); });
  options.planes.clear();
  options.max_curvature = -2.0;
  expect_error(ErrorCode::InvalidArgument, "-2", [&] { simplify(contour, options); });
  options.max_curvature = 1.0;
  expect_error(ErrorCode::InvalidArgument, "max_curvature is 1", [&] { simplify(contour, options); });
  options.max_curvature = SimplifyOptions<3>().max_curvature;
  options.allow_nonmanifold = true;
  expect_error(ErrorCode::InvalidArgument, "allow_nonmanifold", [&] { simplify(contour, options); });
  options.allow_nonmanifold = false;

  auto broken = contour;
  broken.simplices.push_back({0, 1, 1});
  expect_error(ErrorCode::UnsupportedData, "twice", [&] { simplify(broken, options); });
  broken = contour;
  broken.simplices.push_back(contour.simplices[0]);
  expect_error(ErrorCode::UnsupportedData, "3 simplices", [&] { simplify(broken, options); });
  broken = contour;
  broken.vertex_attributes.push_back({"short", "", 1, {1.0}});
  expect_error(ErrorCode::InvalidArgument, "short", [&] { simplify(broken, options); });

  SimplifyOptions<2> flat;
  flat.ratio = 0.5;
  flat.method = SimplifyMethod::fast;
  expect_error(ErrorCode::InvalidArgument, "triangles", [&] { simplify(ball<2>(8), flat); });
  options.work.progress = [](double) { return false; };
  expect_error(ErrorCode::Cancelled, "cancelled", [&] { simplify(contour, options); });
}

/// Another thread may prepare the measurement then.
TEST(SimplifyErrors, CanBeCancelledAtAnyReport) {
  const auto contour = ball<3>(4);
  for (const unsigned threads : {1u, 3u}) {
    std::size_t reports = 0, last = ~std::size_t{0};
    SimplifyOptions<3> options;
    options.ratio = 0.5;
    options.work = {threads, [&](double) { return ++reports < last; }};
    simplify(contour, options);
    const std::size_t all = std::exchange(reports, 0);
    ASSERT_GE(all, 20u);
    // Only the calling thread reports, so beside others there may be fewer reports in the next run.
    for (last = 1; last <= (threads == 1 ? all : all / 3); last += all / 20, reports = 0) {
      expect_error(ErrorCode::Cancelled, "cancelled", [&] { simplify(contour, options); });
      EXPECT_EQ(reports, last);
    }
  }
}

TEST(SimplifyErrors, AnEarlierErrorIsANumberAndNotNegative) {
  SimplifyOptions<3> options;
  options.ratio = 0.5;
  for (const double wrong : {-5.0, std::nan(""), HUGE_VAL}) {
    auto contour = ball<3>(8);
    contour.vertex_attributes.push_back({"simplification_error", "", 1, {}});
    contour.vertex_attributes.back().values.assign(contour.vertices.size(), 0.0);
    contour.vertex_attributes.back().values[3] = wrong;
    expect_error(ErrorCode::InvalidArgument, "simplification_error", [&] { simplify(contour, options); });
  }
}

/// A contour that already has a larger error cannot satisfy a smaller one.
TEST(SimplifyErrors, AnEarlierErrorIsAtMostTheLargest) {
  SimplifyOptions<3> options;
  options.max_error = 0.1;
  const auto first = simplify(ball<3>(16), options);
  const auto& once = first.contour;
  const double earlier = *first.stats.error();
  options.max_error = 0.5 * earlier;
  expect_error(ErrorCode::InvalidArgument, "from before", [&] { simplify(once, options); });
  expect_error(ErrorCode::InvalidArgument, fmt::format("{}", earlier), [&] { simplify(once, options); });
  options.max_error = 0.0;
  expect_error(ErrorCode::InvalidArgument, "from before", [&] { simplify(once, options); });
  for (const double enough : {earlier, 0.1}) {
    options.max_error = enough;
    EXPECT_LE(*simplify(once, options).stats.error(), enough + 1e-9);
  }
}

/// The reported end of a simplification: `error` only if it could have continued without the error limit.
TEST(SimplifyEnds, AreWhatKeepsTheRest) {
  const auto contour = ball<3>(16);
  SimplifyOptions<3> options;
  options.ratio = 0.5;
  EXPECT_EQ(simplify(contour, options).stats.end, SimplifyEnd::count);
  options.max_error = 0.0;
  options.ratio = 1.0;
  EXPECT_EQ(simplify(contour, options).stats.end, SimplifyEnd::count);
  options.ratio = 0.0;
  EXPECT_EQ(simplify(contour, options).stats.end, SimplifyEnd::error);
  options.max_error = 0.01;
  EXPECT_EQ(simplify(contour, options).stats.end, SimplifyEnd::error);
  options.max_error = 1000.0;
  const auto [least, stats] = simplify(contour, options);
  EXPECT_EQ(stats.end, SimplifyEnd::shape);
  EXPECT_GT(least.simplices.size(), 0u);
  Contour<3, double> tetrahedron;
  tetrahedron.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  tetrahedron.simplices = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const double error : {0.0, 100.0}) {
    options.max_error = error;
    const auto kept = simplify(tetrahedron, options);
    EXPECT_EQ(kept.contour.simplices.size(), 4u);
    EXPECT_EQ(kept.stats.end, SimplifyEnd::shape);
  }
}

/// Meshoptimizer has a single tolerance for all parts. If its smallest result still exceeds the error, the contour
/// stays unchanged, and the report says so.
TEST(SimplifyEnds, AreRoundsWhereNoneIsNearEnough) {
  if (!has_fast_simplify()) GTEST_SKIP() << "built without meshoptimizer";
  const auto contour = ball<3>(16);
  SimplifyOptions<3> options;
  options.method = SimplifyMethod::fast;
  options.max_error = 1e-4;
  const auto [result, stats] = simplify(contour, options);
  EXPECT_EQ(stats.end, SimplifyEnd::rounds);
  EXPECT_EQ(stats.rounds, 12u);
  EXPECT_EQ(stats.error(), 0.0);
  EXPECT_EQ(result.vertices, contour.vertices);
  EXPECT_EQ(result.simplices, contour.simplices);
}

/// For every goal, progress ends at 1 and never decreases.
TEST(SimplifyProgress, GrowsUpToOne) {
  for (int goal = 0; goal < 4; ++goal) {
    SimplifyOptions<3> options;
    if (goal != 1) options.ratio = goal == 3 ? 1.0 : 0.3;
    if (goal == 1) options.max_error = 0.01;
    options.measure = goal != 2;
    double last = 0.0;
    options.work.progress = [&](double fraction) {
      EXPECT_GE(fraction, last);
      last = fraction;
      return true;
    };
    simplify(ball<3>(12), options);
    EXPECT_EQ(last, 1.0);
  }
}

/// A second simplification with a larger error uses the remaining error and keeps the sum.
TEST(SimplifyTwice, UsesWhatIsLeftOfTheError) {
  const auto contour = ball<3>(24);
  SimplifyOptions<3> options;
  options.max_error = 0.01;
  const auto [once, first] = simplify(contour, options);
  options.max_error = *first.error() + 0.01;
  const auto [again, stats] = simplify(once, options);
  EXPECT_EQ(stats.end, SimplifyEnd::error);
  EXPECT_LT(again.simplices.size(), once.simplices.size());
  EXPECT_LE(*stats.error(), *options.max_error + 1e-9);
  EXPECT_GE(*stats.error_of_original, sampled_deviation(contour, again, kSamples<3>, 1));
}

/// The bound is as tight as possible, even if a looser one would suffice.
TEST(SimplifyErrors, AreNotLooseWhereTheLargestIsLarge) {
  const auto contour = ball<3>(16);
  SimplifyOptions<3> options;
  options.max_error = 1e9;
  const auto [result, stats] = simplify(contour, options);
  const double reached = std::max(deviation(contour, result).least, deviation(result, contour).least);
  EXPECT_LE(*stats.error(), 2.0 * reached);
}

/// Meshoptimizer may remove a closed surface entirely, which is not a valid result.
TEST(SimplifyFast, LeavesSomethingOrSaysSo) {
  if (!has_fast_simplify()) GTEST_SKIP() << "built without meshoptimizer";
  auto options = with_ratio<3>(SimplifyMethod::fast, 0.0);
  for (const bool allow : {false, true}) {
    options.allow_nonmanifold = allow;
    expect_error(ErrorCode::InvalidArgument, "left none", [&] { simplify(ball<3>(16), options); });
  }
  options = SimplifyOptions<3>();
  options.method = SimplifyMethod::fast;
  options.max_error = 0.0;
  const auto contour = ball<3>(4);
  const auto [result, stats] = simplify(contour, options);
  EXPECT_EQ(result.simplices, contour.simplices);
  EXPECT_EQ(stats.error(), 0.0);
}

TEST(SimplifyFast, RefusesWhatIsNoManifoldToBeginWith) {
  if (!has_fast_simplify()) GTEST_SKIP() << "built without meshoptimizer";
  const auto options = with_ratio<3>(SimplifyMethod::fast, 0.5);
  auto broken = ball<3>(8);
  broken.simplices.push_back(broken.simplices[0]);
  expect_error(ErrorCode::UnsupportedData, "3 simplices", [&] { simplify(broken, options); });
  auto exact = with_ratio<3>(SimplifyMethod::fast, 1.0);  // nothing must be removed
  exact.max_error = 0.0;
  expect_error(ErrorCode::UnsupportedData, "3 simplices", [&] { simplify(broken, exact); });
}

TEST(SimplifyErrors, NothingStaysNothing) {
  SimplifyOptions<3> options;
  options.ratio = 0.5;
  EXPECT_TRUE(simplify(Contour<3, double>(), options).contour.simplices.empty());
}

}  // namespace
}  // namespace tegl::test
