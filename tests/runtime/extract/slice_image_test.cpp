// SPDX-License-Identifier: BSD-3-Clause
//
// Slices of contours against contours of layers, and the direct slice against the slice of the whole contour.
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "compare.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "simplicial_contour.hpp"
#include "tegl/eigen.hpp"
#include "tegl/error.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using test::last_axis_layer;
using test::Point;
using test::same_surface;

/// Both triangulations, both alternatives, both directions.
std::vector<ExtractOptions> all_options() {
  std::vector<ExtractOptions> result;
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high})
      for (const GradientDirection direction : {GradientDirection::descent, GradientDirection::ascent}) {
        ExtractOptions options;
        options.triangulation = triangulation;
        options.ambiguity = ambiguity;
        options.direction = direction;
        result.push_back(options);
      }
  return result;
}

std::string describe(const ExtractOptions& options) {
  return std::string(options.triangulation == Triangulation::compact ? "compact" : "barycentric") +
         (options.ambiguity == Ambiguity::low ? " low" : " high") +
         (options.direction == GradientDirection::descent ? " descent" : " ascent") + (options.close ? " closed" : "");
}

/// At every sample of the last axis, the slice of the whole contour and the direct slice equal the layer's contour.
template <class Real, Value T, int N>
void expect_cuts_are_layers(const Image<T, N>& image, double isovalue, const ExtractOptions& options) {
  const auto whole = extract<Real>(image, isovalue, options);
  for (std::size_t k = 0; k < image.size(N - 1); ++k) {
    const double at = image.grid().axes[N - 1][k];
    const auto layer = extract<Real>(last_axis_layer(image, k), isovalue, options);
    EXPECT_TRUE(same_surface(slice(whole, Hyperplane<N>::across(N - 1, at)), layer))
        << "layer " << k << ", " << describe(options);
    EXPECT_TRUE(same_surface(slice_image<Real>(image, isovalue, Hyperplane<N>::across(N - 1, at), options), layer))
        << "layer " << k;
  }
}

/// At the given positions the direct slice equals the slice of the whole contour.
template <class Real = float, Value T, int N>
void expect_direct_is_whole(const Image<T, N>& image, double isovalue, const ExtractOptions& options,
                            const std::vector<double>& places) {
  const auto whole = extract<Real>(image, isovalue, options);
  for (const double at : places)
    EXPECT_TRUE(same_surface(slice_image<Real>(image, isovalue, Hyperplane<N>::across(N - 1, at), options),
                             slice(whole, Hyperplane<N>::across(N - 1, at))))
        << "at " << at << ", " << describe(options);
}

TEST(SliceImage, AtATimeStepEqualsThe3dContour) {
  const auto owned = test::noise<float, 4>(10, 21);
  for (const ExtractOptions& options : all_options()) expect_cuts_are_layers<float>(owned.view(), 0.5, options);
}

template <class T>
class SliceOfValueType : public ::testing::Test {};
using ValueTypes =
    ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::int32_t, float, double>;
TYPED_TEST_SUITE(SliceOfValueType, ValueTypes);

TYPED_TEST(SliceOfValueType, AtALayerEqualsTheContourOfThatLayer) {
  const double isovalue = test::noise_isovalue<TypeParam>();
  const auto four = test::noise<TypeParam, 4>(6, 22);
  expect_cuts_are_layers<float>(four.view(), isovalue, {});
  expect_cuts_are_layers<double>(four.view(), isovalue, {});
  const auto three = test::noise<TypeParam, 3>(12, 23);
  expect_cuts_are_layers<float>(three.view(), isovalue, {});
  expect_cuts_are_layers<double>(three.view(), isovalue, {});
}

TEST(SliceImage, OfSmoothFieldsAtATimeStepEqualsThe3dContour) {
  const Grid<4> grid = test::centred_grid<4>(13, 1.6);
  for (const ExtractOptions& options : all_options()) {
    expect_cuts_are_layers<float>(view_of(test::sample_field<float>(grid, test::SphereTube{})), 0.01, options);
    expect_cuts_are_layers<double>(view_of(test::sample_field<double>(grid, test::Gyroid<4>{})), 0.1, options);
  }
}

TEST(SliceImage, OfAClosedContourAtATimeStepEqualsTheClosed3dContour) {
  const auto owned = test::noise<std::int16_t, 4>(6, 24);
  for (ExtractOptions options : all_options()) {
    options.close = true;
    expect_cuts_are_layers<float>(owned.view(), -0.5, options);
  }
}

TEST(SliceImage, AtATimeStepEqualsThe3dContourWhereSamplesEqualTheIsovalue) {
  for (const std::uint64_t levels : {2u, 3u, 20u}) {
    const auto owned = test::coarse_noise<std::uint8_t, 4>(Grid<4>::unit({6, 6, 6, 6}), 25 + levels, levels);
    for (ExtractOptions options : all_options()) {
      expect_cuts_are_layers<float>(owned.view(), 1.0, options);
      expect_cuts_are_layers<double>(owned.view(), 1.0, options);
      options.close = true;
      expect_cuts_are_layers<float>(owned.view(), 1.0, options);
    }
  }
}

TEST(SliceImage, AtALayerEqualsItsContourWhereSamplesEqualTheIsovalueWithEpsilon) {
  const auto owned = test::coarse_noise<std::uint8_t, 3>(Grid<3>::unit({12, 12, 12}), 25, 3);
  for (ExtractOptions options : all_options()) {
    options.epsilon = 1e-3;
    expect_cuts_are_layers<float>(owned.view(), 1.0, options);
  }
}

TEST(SliceImage, AtATimeStepEqualsThe3dContourWhereSamplesAlmostEqualTheIsovalue) {
  // Points between layers that are close enough to be rounded to the layers, at times of any magnitude.
  for (const double origin : {0.0, 1e-3, 17.0, 86400.0, -1e7}) {
    Grid<4> grid = Grid<4>::unit({5, 5, 5, 5});
    grid.axes[3] = Axis::uniform(5, origin, 4.0);
    auto owned = test::coarse_noise<double, 4>(grid, 44, 3);
    std::mt19937_64 bits(45);
    for (double& value : owned.values) value += 1e-12 * (test::unit_random(bits) - 0.5);
    for (const ExtractOptions& options : all_options()) expect_cuts_are_layers<float>(owned.view(), 1.0, options);
  }
}

TEST(SliceImage, IsAManifoldAtAThousandTimes) {
  const auto owned = test::noise<float, 4>(8, 26);
  const auto image = owned.view();
  const auto whole = extract(image, 0.5);
  ExtractOptions closing;
  closing.close = true;
  const auto closed = extract(image, 0.5, closing);
  EXPECT_TRUE(test::is_closed_oriented_manifold(check(closed)));
  std::mt19937_64 bits(27);
  for (int i = 0; i < 1000; ++i) {
    const double at = 7.0 * test::unit_random(bits);
    const auto cut = slice(whole, Hyperplane<4>::across(3, at));
    const auto report = test::expect_oriented_manifold(cut);
    EXPECT_GT(report.simplices, 1000u);
    // Open at the image border only.
    for (const auto& edge : test::boundary_faces(cut)) {
      bool on_border = false;
      for (int a = 0; a < 3; ++a)
        for (const float x : {0.0f, 7.0f})
          on_border = on_border || (cut.vertices[edge[0]][a] == x && cut.vertices[edge[1]][a] == x);
      ASSERT_TRUE(on_border) << at;
    }
    if (i % 4 == 0) test::expect_closed_manifold(slice(closed, Hyperplane<4>::across(3, at)));
  }
}

TEST(SliceImage, IsAManifoldAtAnyTimeWhereSamplesEqualTheIsovalue) {
  for (const std::uint64_t levels : {2u, 3u, 20u}) {
    const auto owned = test::coarse_noise<std::uint8_t, 4>(Grid<4>::unit({6, 6, 6, 6}), levels, levels);
    for (ExtractOptions options : all_options()) {
      options.close = true;
      const auto closed = extract(owned.view(), 1.0, options);
      for (double at = 0.0; at <= 5.0; at += 0.125)
        test::expect_closed_manifold(slice(closed, Hyperplane<4>::across(3, at)));
    }
  }
}

TEST(SliceImage, EqualsTheCutOfTheWholeContour) {
  const std::vector<double> places{0.0, 1e-9, 0.3, 1.0, 2.5, 2.9999, 3.0, 4.71, 5.0};
  const auto four = test::noise<std::uint8_t, 4>(6, 28);
  const auto three = test::noise<double, 3>(6, 29);
  for (ExtractOptions options : all_options())
    for (const bool close : {false, true}) {
      options.close = close;
      expect_direct_is_whole(four.view(), 127.5, options, places);
      expect_direct_is_whole<double>(three.view(), 0.5, options, places);
    }
}

TEST(SliceImage, EqualsTheCutOfTheWholeContourWhereSamplesEqualTheIsovalue) {
  std::vector<double> places;
  for (double at = 0.0; at <= 5.0; at += 0.25) places.push_back(at);
  for (const std::uint64_t seed : {30u, 31u, 32u}) {
    const auto owned = test::coarse_noise<std::int16_t, 4>(Grid<4>::unit({6, 6, 6, 6}), seed, 3);
    for (ExtractOptions options : all_options()) {
      options.close = seed == 31u;
      expect_direct_is_whole(owned.view(), 1.0, options, places);
    }
  }
}

TEST(SliceImage, EqualsTheCutOfTheWholeContourNextToMissingValues) {
  // Samples missing at all times at the same positions, such as land.
  auto owned = test::noise<float, 4>(Grid<4>::unit({7, 7, 7, 7}), 33);
  const auto mask = test::noise<float, 3>(7, 37);
  for (std::size_t i = 0; i < owned.values.size(); ++i)
    if (mask.values[i % 343] < 0.03f) owned.values[i] = std::numeric_limits<float>::quiet_NaN();
  const std::vector<double> places{0.0, 0.5, 1.0, 2.0, 2.7, 3.0, 4.0, 5.0, 5.2, 6.0};
  for (ExtractOptions options : all_options())
    for (const bool close : {false, true}) {
      options.close = close;
      expect_direct_is_whole(owned.view(), 0.5, options, places);
    }
}

TEST(SliceImage, CoversTheCutOfTheWholeContourWhereMissingValuesComeAndGo) {
  // If holes meet in edges or squares of the grid, the whole contour may be separated further than a slab's contour.
  const auto owned = test::noise_with_missing<float, 4>(Grid<4>::unit({7, 7, 7, 7}), 33, 0.02);
  for (ExtractOptions options : all_options())
    for (const bool close : {false, true}) {
      options.close = close;
      const auto whole = extract<double>(owned.view(), 0.5, options);
      for (const double at : {0.5, 2.7, 5.2}) {
        SCOPED_TRACE(std::to_string(at) + ", " + describe(options));
        const auto direct = slice_image<double>(owned.view(), 0.5, Hyperplane<4>::across(3, at), options);
        const auto cut = slice(whole, Hyperplane<4>::across(3, at));
        test::expect_oriented_manifold(direct);
        test::expect_oriented_manifold(cut);
        EXPECT_NEAR(test::measure(direct) / test::measure(cut), 1.0, 1e-12);
      }
    }
}

TEST(SliceImage, NextToMissingValuesShowsTheLayerWhereTilesTouchIt) {
  // Values missing at all times at the same positions: every active cube of a layer has a tile above and below.
  auto owned = test::noise_with_missing<float, 4>(Grid<4>::unit({8, 8, 8, 5}), 34, 0.0);
  const auto mask = test::noise<float, 3>(8, 35);
  for (std::size_t i = 0; i < owned.values.size(); ++i)
    if (mask.values[i % 512] < 0.03f) owned.values[i] = std::numeric_limits<float>::quiet_NaN();
  for (const ExtractOptions& options : all_options()) expect_cuts_are_layers<float>(owned.view(), 0.5, options);
}

TEST(SliceImage, ShowsALayerThatHasTilesOnItsUpperSideAlone) {
  auto owned = test::noise<float, 4>(Grid<4>::unit({8, 8, 8, 3}), 36);
  // Half of layer 0 is missing: layer 1 has tiles below it in the other half only.
  for (std::size_t i = 0; i < 512; ++i)
    if (i % 8 < 4) owned.values[i] = std::numeric_limits<float>::quiet_NaN();
  const auto image = owned.view();
  const auto layer = extract(last_axis_layer(image, 1), 0.5);
  EXPECT_TRUE(same_surface(slice(extract(image, 0.5), Hyperplane<4>::across(3, 1.0)), layer));
  EXPECT_TRUE(same_surface(slice_image(image, 0.5, Hyperplane<4>::across(3, 1.0)), layer));
}

TEST(SliceImage, FollowsAxesOfAnyKind) {
  Grid<4> grid = Grid<4>::unit({5, 6, 5, 5});
  grid.axes[0] = Axis::uniform(5, 10.0, -0.5);
  grid.axes[3] = Axis::rectilinear({1000.0, 850.5, 700.25, 500.0, 0.1});  // pressure, descending
  grid.axes[3].name = "pressure";
  const auto owned = test::noise<float, 4>(grid, 37);
  const std::vector<double> places{1000.0, 999.0, 850.5, 800.0, 600.0, 500.0, 0.1, 0.2};
  for (const ExtractOptions& options : all_options()) {
    expect_cuts_are_layers<float>(owned.view(), 0.5, options);
    expect_direct_is_whole(owned.view(), 0.5, options, places);
  }
}

TEST(SliceImage, FollowsAWorldMapThatLeavesTheLastAxisApart) {
  Grid<4> grid = Grid<4>::unit({5, 5, 5, 5});
  grid.linear = {{{0, -1.1, 0, 0}, {0.9, 0.1, 0, 0}, {0.2, 0, -2, 0}, {0, 0, 0, -0.7}}};
  grid.offset = {3, -4, 0.5, 11.1};
  const auto owned = test::noise<float, 4>(grid, 38);
  std::vector<double> places;
  for (double i = 0; i <= 4.0; i += 0.25) places.push_back(-0.7 * i + 11.1);
  for (const ExtractOptions& options : all_options()) expect_direct_is_whole(owned.view(), 0.5, options, places);
  // Normals face low in world coordinates, that is outwards for a ball.
  const auto ball = test::sample_field<double>(grid, test::Ball<4>{{2, 2, 2, 2}, 1.7});
  const Eigen::Vector3d centre =
      (as_eigen(grid.linear) * Eigen::Vector4d(2, 2, 2, 0) + as_eigen(grid.offset)).head<3>();
  for (const auto& cut : {slice(extract<double>(ball.view(), 0.0), Hyperplane<4>::across(3, 9.6)),
                          slice_image<double>(ball.view(), 0.0, Hyperplane<4>::across(3, 9.6))})
    EXPECT_EQ(test::share_facing(cut,
                                 [&](const Point<3>& x) {
                                   return Point<3>{x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]};
                                 }),
              1.0);
}

ErrorCode code_of(const std::function<void()>& call, const std::string& part_of_message) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part_of_message), std::string::npos) << error.what();
    return error.code();
  }
  ADD_FAILURE() << "no error";
  return ErrorCode::Cancelled;
}

/// Replaces the samples of all layers outside of a range.
void overwrite_other_layers(OwnedImage<float, 4>& image, int axis, LayerRange kept) {
  const auto sizes = image.grid.sizes();
  std::size_t stride = 1;
  for (int a = 0; a < axis; ++a) stride *= sizes[a];
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    const std::size_t layer = i / stride % sizes[axis];
    if (layer < kept.first || layer >= kept.end) image.values[i] = 1e30f;
  }
}

TEST(SliceImage, ReadsOnlyTheLayersOfTheCut) {
  const auto whole = test::noise<float, 4>(Grid<4>::unit({6, 6, 6, 6}), 38);
  ExtractOptions options;
  options.work.threads = 1;
  for (const Normals normals : {Normals::none, Normals::differences, Normals::sobel})
    for (const int axis : {0, 3})
      for (const double at : {0.0, 2.0, 2.25, 5.0}) {
        options.normals = normals;
        const LayerRange layers = layers_of_cut(whole.grid, axis, at, options);
        auto part = whole;
        overwrite_other_layers(part, axis, layers);
        const auto hyperplane = Hyperplane<4>::across(axis, at);
        const auto expected = slice_image(whole.view(), 0.5, hyperplane, options);
        const auto cut = slice_image(part.view(), 0.5, hyperplane, options);
        EXPECT_FALSE(cut.simplices.empty());
        EXPECT_EQ(cut.vertices, expected.vertices) << "axis " << axis << " at " << at;
        EXPECT_EQ(cut.simplices, expected.simplices);
        EXPECT_EQ(cut.normals, expected.normals);
      }
  const LayerRange slab = layers_of_cut(whole.grid, 3, 2.25);
  EXPECT_EQ(slab.first, 2u);
  EXPECT_EQ(slab.end, 4u);
  EXPECT_EQ(code_of([&] { (void)layers_of_cut(whole.grid, 3, 5.5); }, "between 0 and 5"), ErrorCode::InvalidArgument);
  for (const int axis : {-1, 4})
    EXPECT_EQ(code_of([&] { (void)layers_of_cut(whole.grid, axis, 1.0); }, "0 to 3"), ErrorCode::InvalidArgument);
}

TEST(SliceImage, RefusesAWorldMapThatMixesTheLastAxis) {
  for (const auto& [row, column] : {std::pair{3, 0}, std::pair{1, 3}}) {
    Grid<4> grid = Grid<4>::unit({3, 3, 3, 3});
    grid.linear[row][column] = 0.5;
    const auto owned = test::noise<float, 4>(grid, 39);
    EXPECT_EQ(code_of([&] { slice_image(owned.view(), 0.5, Hyperplane<4>::across(3, 1.0)); }, "mixes axis 3"),
              ErrorCode::InvalidArgument);
  }
}

TEST(SliceImage, NamesThePlaceAndTheRangeThatItIsOutsideOf) {
  Grid<4> grid = Grid<4>::unit({3, 3, 3, 3});
  grid.axes[3] = Axis::uniform(3, 2.0, 0.5);
  grid.axes[3].name = "time";
  const auto owned = test::noise<float, 4>(grid, 40);
  for (const double at : {1.5, 3.5})
    EXPECT_EQ(code_of([&] { slice_image(owned.view(), 0.5, Hyperplane<4>::across(3, at)); },
                      "between 2 and 3, the ends of axis 3 (time)"),
              ErrorCode::InvalidArgument);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(code_of([&] { slice_image(owned.view(), 0.5, Hyperplane<4>::across(3, nan)); }, "slice at nan"),
            ErrorCode::InvalidArgument);
  EXPECT_EQ(code_of([&] { slice_image(owned.view(), nan, Hyperplane<4>::across(3, 2.5)); }, "nan"),
            ErrorCode::InvalidIsovalue);
}

TEST(SliceImage, OfOneSampleAlongTheLastAxisIsEmpty) {
  const auto owned = test::noise<float, 4>(Grid<4>::unit({4, 4, 4, 1}), 41);
  EXPECT_TRUE(slice_image(owned.view(), 0.5, Hyperplane<4>::across(3, 0.0)).simplices.empty());
  EXPECT_TRUE(slice(extract(owned.view(), 0.5), Hyperplane<4>::across(3, 0.0)).simplices.empty());
  EXPECT_EQ(code_of([&] { slice_image(owned.view(), 0.5, Hyperplane<4>::across(3, 0.5)); }, "between 0 and 0"),
            ErrorCode::InvalidArgument);
}

TEST(SliceImage, ReadsTheSlabAlone) {
  const auto owned = test::noise<float, 4>(Grid<4>::unit({6, 6, 6, 50}), 42);
  const auto tiles_of = [&](const Hyperplane<4>& hyperplane) {
    return slice_image_with_stats(owned.view(), 0.5, hyperplane).stats.tiles;
  };
  EXPECT_EQ(tiles_of(Hyperplane<4>::across(3, 20.5)), 125u);
  EXPECT_EQ(tiles_of(Hyperplane<4>::across(3, 20.0)), 250u);
  EXPECT_EQ(tiles_of(Hyperplane<4>::across(3, 0.0)), 125u);
  EXPECT_EQ(tiles_of({{0, 0, 0, -2}, -41.0}), 125u);
  EXPECT_EQ(tiles_of({{0, 0, 1, 1}, 20.5}), 125u * 49u) << "an oblique hyperplane is cut from the whole contour";
}

TEST(SliceImage, ByAnyHyperplaneIsTheCutOfTheWholeContour) {
  const auto owned = test::noise<float, 4>({6, 5, 7, 4}, 44);
  const auto whole = extract<double>(owned.view(), 0.5);
  for (const Hyperplane<4>& hyperplane :
       {Hyperplane<4>{{1, -2, 0.5, 3}, 2.0}, Hyperplane<4>{{0, 0, 1, 1}, 4.5}, Hyperplane<4>{{0, 0, 0, -2}, -3.0},
        Hyperplane<4>{{0, -4, 0, 0}, -5.0}, Hyperplane<4>{{1e-3, 0, 0, 0}, 3.3e-3}}) {
    const auto cut = slice_image<double>(owned.view(), 0.5, hyperplane);
    EXPECT_FALSE(cut.simplices.empty());
    EXPECT_TRUE(same_surface(cut, slice(whole, hyperplane))) << testing::PrintToString(hyperplane.normal);
  }
  // At a layer it is the layer's contour, whichever side is above.
  const auto layer = extract<double>(last_axis_layer(owned.view(), 2), 0.5);
  EXPECT_TRUE(same_surface(slice_image<double>(owned.view(), 0.5, {{0, 0, 0, -1}, -2.0}), layer));
}

TEST(SliceImage, OfMergingBallsChangesEulerCharacteristicAtTheEvent) {
  const test::MergingBalls<4> balls{0.5, 1.0, 1.0};  // they touch at t = 0.5
  Grid<4> grid = test::centred_grid<4>(36, 1.75);
  grid.axes[1] = grid.axes[2] = Axis::uniform(19, -0.9, 0.1);
  grid.axes[3] = Axis::uniform(11, 0.0, 0.1);
  const auto owned = test::sample_field<float>(grid, balls);
  double last_apart = 0.0;
  double first_joined = 1.0;
  for (double t = 0.0; t <= 1.0; t += 1.0 / 64) {
    const auto report = test::expect_closed_manifold(slice_image(owned.view(), 0.0, Hyperplane<4>::across(3, t)));
    ASSERT_TRUE((report.euler == 4 && report.components == 2) || (report.euler == 2 && report.components == 1)) << t;
    if (report.euler == 4) last_apart = std::max(last_apart, t);
    if (report.euler == 2) first_joined = std::min(first_joined, t);
  }
  EXPECT_LT(last_apart, first_joined);
  EXPECT_NEAR(first_joined, balls.event(), 0.1);  // the grid's step
}

TEST(SliceImage, OfABallConvergesInAreaAndVolumeAtSecondOrder) {
  const test::Ball<4> ball{{0.01, -0.02, 0.03, 0.0}, 0.8};
  const double t = 0.137;
  const test::Ball<3> expected{{}, std::sqrt(0.64 - t * t)};
  std::array<double, 2> area;
  std::array<double, 2> volume;
  for (int i = 0; i < 2; ++i) {
    const auto owned = test::sample_field<double>(test::centred_grid<4>(i == 0 ? 17 : 33, 1.0), ball);
    const auto cut = slice_image<double>(owned.view(), 0.0, Hyperplane<4>::across(3, t));
    EXPECT_EQ(test::expect_closed_manifold(cut).euler, 2);
    area[i] = test::measure(cut) - expected.surface();
    volume[i] = test::enclosed_content(cut) - expected.content();
  }
  EXPECT_GT(test::convergence_order(area[0], area[1]), 1.6);
  EXPECT_GT(test::convergence_order(volume[0], volume[1]), 1.6);
}

TEST(SliceImage, TakesOverNamesAndDirection) {
  Grid<4> grid = Grid<4>::unit({4, 4, 4, 4});
  for (int a = 0; a < 4; ++a) {
    grid.axes[a].name = std::string(1, "xyzt"[a]);
    grid.axes[a].unit = a == 3 ? "s" : "mm";
  }
  const auto owned = test::noise<float, 4>(grid, 43);
  ExtractOptions options;
  options.direction = GradientDirection::ascent;
  const auto cut = slice_image(owned.view(), 0.5, Hyperplane<4>::across(3, 1.5), options);
  EXPECT_EQ(cut.axis_names, (std::array<std::string, 3>{"x", "y", "z"}));
  EXPECT_EQ(cut.axis_units, (std::array<std::string, 3>{"mm", "mm", "mm"}));
  EXPECT_EQ(cut.direction, GradientDirection::ascent);
}

}  // namespace
}  // namespace tegl
