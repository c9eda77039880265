// SPDX-License-Identifier: BSD-3-Clause
//
// Scale spaces: their layers, scales of blobs, tracks over the scale, the most stable scale.
#include "tegl/scale_space.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "errors.hpp"
#include "fields.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/stream.hpp"
#include "tegl/track.hpp"

namespace tegl::test {
namespace {

TEST(ScaleSpace, LayersAreDiscreteGaussiansInAnyOrder) {
  Grid<3> grid = centred_grid<3>(12, 1.1);
  const auto image = noise<std::uint8_t, 3>(grid, 1);
  const std::vector<double> sigmas = scale_sigmas(0.2, 0.8, 3);
  ScaleSpaceLayers<std::uint8_t, 3> layers(image.view(), sigmas);
  EXPECT_EQ(layers.grid().axes[3].name, "log2_sigma");
  EXPECT_TRUE(layers.grid().axes[3].is_uniform());
  EXPECT_NEAR(layers.grid().axes[3][2], std::log2(0.8), 1e-12);
  const auto whole = layers.all();
  std::vector<float> layer(1728);
  for (const std::size_t k : {2, 0, 1}) {
    layers.read(k, layer.data());
    EXPECT_TRUE(std::equal(layer.begin(), layer.end(), whole.values.begin() + static_cast<std::ptrdiff_t>(k * 1728)));
    const SeparableConvolution filter{std::vector<AxisWeights>(3, discrete_gaussian_weights(sigmas[k] / 0.2))};
    const auto expected = filter_image(image.view(), filter);
    for (std::size_t i = 0; i < 1728; ++i) ASSERT_NEAR(layer[i], expected.values[i], 1e-3F);
  }
}

TEST(ScaleSpace, AnAxisWithTheFactor0IsNotSmoothed) {
  const auto image = noise<double, 2>({8, 5}, 2);
  ScaleSpaceOptions options;
  options.factors = {1, 0};
  options.in_samples = true;
  ScaleSpaceLayers<double, 2> layers(image.view(), {1, 2}, options);
  std::vector<double> layer(40);
  layers.read(1, layer.data());
  const auto expected = filter_image(image.view(), SeparableConvolution{{discrete_gaussian_weights(2), {}}});
  EXPECT_EQ(layer, std::vector<double>(expected.values));
}

/// The scale of the greatest Laplacian in the middle of a ball, by a parabola through the three greatest.
template <int N>
double scale_of_ball(double radius, std::size_t samples) {
  const auto half = static_cast<double>(samples / 2);
  const auto ball = sample_field<float, N>(centred_grid<N>(samples, half), [&](const Point<N>& x) {
    double square = 0;
    for (const double one : x) square += one * one;
    return std::clamp(radius - std::sqrt(square) + 0.5, 0.0, 1.0);
  });
  const std::vector<double> sigmas = scale_sigmas(0.3 * radius, 1.5 * radius, 24);
  ScaleSpaceOptions options;
  options.quantity = ScaleQuantity::laplacian;
  ScaleSpaceLayers<float, N> layers(ball.view(), sigmas, options);
  std::vector<float> layer(ball.values.size());
  std::vector<double> middle;
  for (std::size_t k = 0; k < sigmas.size(); ++k) {
    layers.read(k, layer.data());
    middle.push_back(static_cast<double>(layer[layer.size() / 2]));
  }
  const std::size_t best = static_cast<std::size_t>(std::max_element(middle.begin(), middle.end()) - middle.begin());
  if (best == 0 || best + 1 == sigmas.size()) return 0;
  const double before = middle[best - 1], here = middle[best], after = middle[best + 1];
  const double shift = 0.5 * (before - after) / (before - 2 * here + after);
  return sigmas[best] * std::pow(sigmas[1] / sigmas[0], shift);
}

TEST(ScaleSpace, TheScaleOfABallIsItsRadiusBySqrtN) {
  EXPECT_NEAR(scale_of_ball<2>(8, 65), 8 / std::sqrt(2), 0.02 * 8);
  EXPECT_NEAR(scale_of_ball<2>(16, 129), 16 / std::sqrt(2), 0.01 * 16);
  EXPECT_NEAR(scale_of_ball<3>(8, 49), 8 / std::sqrt(3), 0.02 * 8);
}

/// Two Gaussian bumps of height 1 and standard deviation 3 at a distance of 12.
OwnedImage<float, 2> two_bumps() {
  return sample_field<float, 2>(Grid<2>::unit({61, 41}), [](const Point<2>& x) {
    const double y = x[1] - 20;
    const auto bump = [&](double centre) { return std::exp(-((x[0] - centre) * (x[0] - centre) + y * y) / 18); };
    return bump(24) + bump(36);
  });
}

TEST(ScaleSpace, TracksOfTwoBumpsMergeAndVanishAtTheScalesOfTheory) {
  // Smoothed by sigma, a bump has the variance v = 9 + sigma^2 and the height 9 / v. The middle between them has
  // 18 / v exp(-36 / (2 v)); the two merge when that exceeds the isovalue, and vanish when the maximum falls below it.
  const auto image = two_bumps();
  const double isovalue = 0.3;
  const auto middle = [](double sigma) {
    const double v = 9 + sigma * sigma;
    return 18 / v * std::exp(-18 / v);
  };
  double merge = 0, vanish = 0;
  for (double sigma = 0.5; sigma < 16; sigma += 0.001) {
    if (merge == 0 && middle(sigma) >= isovalue) merge = sigma;
    if (merge > 0 && vanish == 0 && middle(sigma) < isovalue) vanish = sigma;  // one maximum, in the middle, by then
  }
  ScaleSpaceLayers<float, 2> layers(image.view(), scale_sigmas(0.5, 12, 60));
  const auto scales = layers.all();
  const auto contour = extract(scales.view(), isovalue);
  EXPECT_EQ(check(contour).bad_links, 0u);
  const TrackGraph graph = track(contour);
  double merged = 0, died = 0;
  std::size_t begins = 0;
  for (const TrackEvent& event : graph.events) {
    const double sigma = std::exp2(event.time);
    if (event.kind == TrackEventKind::begin) ++begins;
    if (event.kind == TrackEventKind::merge) merged = sigma;
    if (event.kind == TrackEventKind::death) died = sigma;
  }
  EXPECT_EQ(begins, 2u);
  EXPECT_NEAR(merged, merge, 0.05 * merge);
  EXPECT_NEAR(died, vanish, 0.05 * vanish);
}

TEST(ScaleSpace, StreamsIntoTheContourOfTheImageInMemory) {
  const auto image = noise<float, 2>({20, 17}, 3);
  ScaleSpaceLayers<float, 2> layers(image.view(), scale_sigmas(0.5, 4, 8));
  struct Sink final : ContourSink<3, float> {
    void add_vertices(std::span<const Vertex> more) override {
      vertices.insert(vertices.end(), more.begin(), more.end());
    }
    void add_simplices(std::span<const Simplex> more) override { simplices += more.size(); }
    void replace_corner(std::uint64_t, int, std::uint64_t) override {}
    std::vector<Vertex> vertices;
    std::size_t simplices = 0;
  } sink;
  extract_streamed<float>(layers, 0.5, sink);
  const auto whole = layers.all();
  const auto contour = extract(whole.view(), 0.5);
  EXPECT_EQ(sink.simplices, contour.simplices.size());
  EXPECT_TRUE(std::equal(sink.vertices.begin(), sink.vertices.end(), contour.vertices.begin(), contour.vertices.end()));
}

TEST(ScaleSpace, Of4dImagesHasContoursIn5d) {
  const auto image = noise<float, 4>(5, 4);
  ScaleSpaceLayers<float, 4> layers(image.view(), scale_sigmas(0.5, 2, 3));
  const auto scales = layers.all();
  const MeshReport report = check(extract(scales.view(), 0.5));
  EXPECT_GT(report.simplices, 0u);
  EXPECT_EQ(report.bad_links, 0u);
}

TEST(ScaleSpace, TheMostStableScaleChangesLeast) {
  const std::vector<double> sigmas = scale_sigmas(1, 16, 5);
  const StableScale stable = most_stable_scale(sigmas, std::vector<double>{16, 8, 7, 6.9, 1});
  EXPECT_EQ(stable.layer, 2u);
  EXPECT_EQ(stable.sigma, 4);
  EXPECT_NEAR(stable.change, std::log(6.9 / 8) / std::log(4), 1e-12);
  EXPECT_EQ(most_stable_scale(sigmas, std::vector<double>{1, 0, 1, 0, 1}).sigma, 0);
}

TEST(ScaleSpace, RefusesWhatIsNoScale) {
  expect_error(ErrorCode::InvalidArgument, "a scale has sigma 0", [] { static_cast<void>(scale_sigmas(0, 8, 4)); });
  expect_error(ErrorCode::InvalidArgument, "4 scales from 8 to 2", [] { static_cast<void>(scale_sigmas(8, 2, 4)); });
  expect_error(ErrorCode::InvalidArgument, "sigma 1 after a scale", [] {
    static_cast<void>(scale_axis(std::vector<double>{2, 1}));
  });
  const auto image = noise<float, 2>({4, 4}, 1);
  const auto refuse = [&](const std::string& part, std::vector<double> factors) {
    ScaleSpaceOptions options;
    options.factors = std::move(factors);
    expect_error(ErrorCode::InvalidArgument, part, [&] { ScaleSpaceLayers<float, 2>(image.view(), {1, 2}, options); });
  };
  refuse("3 factors of the scale; expected one for each of 2 axes", {1, 1, 1});
  refuse("a factor of the scale is -1", {1, -1});
  auto uneven = image;
  uneven.grid.axes[1] = Axis::rectilinear({0, 1, 2, 4});
  uneven.grid.axes[1].name = "depth";
  expect_error(ErrorCode::InvalidArgument, "the steps of axis 1 'depth' differ; expected scales in samples", [&] {
    ScaleSpaceLayers<float, 2>(uneven.view(), {1, 2});
  });
}

}  // namespace
}  // namespace tegl::test
