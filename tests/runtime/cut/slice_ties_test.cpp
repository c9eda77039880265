// SPDX-License-Identifier: BSD-3-Clause
//
// Slices with many vertices on the hyperplane: contours of images whose samples equal the isovalue, open at the image's
// sides and beside missing values, sliced across all axes and by oblique hyperplanes.
#include <cmath>
#include <limits>
#include <numeric>

#include "compare.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "simplicial_contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

template <int N>
OwnedImage<float, N> few_values(std::size_t samples, std::uint64_t seed, double missing_share) {
  std::array<std::size_t, N> sizes;
  sizes.fill(samples);
  auto image = test::coarse_noise<float, N>(Grid<N>::unit(sizes), seed, 2 + seed % 3);
  std::mt19937_64 bits(seed + 1);
  for (float& value : image.values)
    if (test::unit_random(bits) < missing_share) value = std::numeric_limits<float>::quiet_NaN();
  return image;
}

/// The hyperplane x_axis = at with the normal `sign` times the axis.
template <int N>
Hyperplane<N> layer_towards(int axis, double at, double sign) {
  Hyperplane<N> layer{{}, sign * at};
  layer.normal[axis] = sign;
  return layer;
}

/// Hyperplanes at the layers, in both directions, and oblique ones through vertices.
template <int N>
std::vector<Hyperplane<N>> hyperplanes_through_vertices(const Contour<N, double>& contour, std::uint64_t seed) {
  std::vector<Hyperplane<N>> result;
  for (int axis = 0; axis < N; ++axis)
    for (const double at : {0.0, 1.0, 2.0})
      for (const double sign : {1.0, -1.0}) result.push_back(layer_towards<N>(axis, at, sign));
  std::mt19937_64 bits(seed);
  for (int i = 0; i < 6; ++i) {
    Hyperplane<N> oblique;
    for (double& x : oblique.normal) x = static_cast<double>(test::random_below(bits, 5)) - 2.0;
    if (oblique.normal == Vector<N>{}) continue;
    const auto& through = contour.vertices[test::random_below(bits, contour.vertices.size())];
    oblique.offset = 0.0;
    for (int a = 0; a < N; ++a) oblique.offset += oblique.normal[a] * through[a];
    result.push_back(oblique);
  }
  return result;
}

template <int N>
void expect_manifold_cuts(std::size_t samples, double missing_share) {
  std::size_t not_empty = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed)
    for (const bool close : {false, true}) {
      ExtractOptions options;
      options.close = close;
      const auto image = few_values<N>(samples, seed, missing_share);
      const auto whole = extract<double>(image.view(), 1.0, options);
      if (whole.simplices.empty()) continue;
      ASSERT_TRUE(test::is_oriented_manifold(check(whole)));
      for (const Hyperplane<N>& hyperplane : hyperplanes_through_vertices(whole, seed)) {
        const auto cut = slice(whole, hyperplane);
        not_empty += !cut.simplices.empty();
        ASSERT_TRUE(test::is_oriented_manifold(check(cut)))
            << "seed " << seed << " close " << close << " normal " << testing::PrintToString(hyperplane.normal)
            << " offset " << hyperplane.offset;
      }
    }
  EXPECT_GT(not_empty, 500u);
}

TEST(SliceThroughTies, IsAManifoldWhateverTheHyperplaneMeets) {
  expect_manifold_cuts<3>(5, 0.0);
  expect_manifold_cuts<4>(3, 0.0);
}

TEST(SliceThroughTies, IsAManifoldBesideMissingValues) {
  expect_manifold_cuts<3>(5, 0.1);
  expect_manifold_cuts<4>(4, 0.1);
}

/// The contour with its vertices at x_axis = at moved slightly up, or down if no simplex of their group is below; with
/// the sign -1, in the opposite directions.
Contour<4, double> moved_off(Contour<4, double> contour, int axis, double at, double sign) {
  std::vector<Index> group(contour.vertices.size());
  std::iota(group.begin(), group.end(), Index{0});
  const auto find = [&](Index v) {
    while (group[v] != v) v = group[v];
    return v;
  };
  std::vector<bool> has_way_down(group.size(), false);
  const auto coordinate = [&](Index v) -> double& { return contour.vertices[v][axis]; };
  for (const auto& simplex : contour.simplices)
    for (const Index v : simplex)
      for (const Index w : simplex) {
        if (coordinate(v) != at) continue;
        if (coordinate(w) == at) group[find(v)] = find(w);
        if (sign * coordinate(w) < sign * at) has_way_down[v] = true;
      }
  for (Index v = 0; v < group.size(); ++v)
    if (has_way_down[v]) has_way_down[find(v)] = true;
  for (Index v = 0; v < group.size(); ++v)
    if (coordinate(v) == at) coordinate(v) += sign * (has_way_down[find(v)] ? 1e-9 : -1e-9);
  return contour;
}

TEST(SliceThroughTies, AcrossOtherAxesThanTheLastIsTheLimitFromBelow) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    const auto image = few_values<4>(3, seed, 0.0);
    const auto whole = extract<double>(image.view(), 1.0);
    for (int axis = 0; axis < 3; ++axis)
      for (const double at : {0.0, 1.0, 2.0})
        for (const double sign : {1.0, -1.0}) {
          const Hyperplane<4> layer = layer_towards<4>(axis, at, sign);
          EXPECT_NEAR(test::measure(slice(whole, layer)), test::measure(slice(moved_off(whole, axis, at, sign), layer)),
                      1e-6)
              << "seed " << seed << " axis " << axis << " at " << at << " sign " << sign;
        }
  }
}

TEST(SliceThroughTies, AcrossTheLastAxisIsTheContourOfTheLayer) {
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const auto image = few_values<4>(3, seed, 0.0);
    const auto whole = extract<double>(image.view(), 1.0);
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_NEAR(test::measure(slice(whole, Hyperplane<4>::across(3, static_cast<double>(k)))),
                  test::measure(extract<double>(test::last_axis_layer(image.view(), k), 1.0)), 1e-9)
          << "seed " << seed << " layer " << k;
  }
}

TEST(SliceThroughTies, OfAnImageAcrossAnyAxisIsTheContourOfTheLayer) {
  std::size_t not_empty = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed)
    for (const bool close : {false, true}) {
      ExtractOptions options;
      options.close = close;
      const auto image = few_values<4>(4, seed, 0.0);
      for (int axis = 0; axis < 4; ++axis)
        for (std::size_t k = 0; k < 4; ++k) {
          const auto cut =
              slice_image<double>(image.view(), 1.0, Hyperplane<4>::across(axis, static_cast<double>(k)), options);
          const auto expected = extract<double>(test::layer_across(image.view(), axis, k), 1.0, options);
          ASSERT_TRUE(test::same_surface(cut, expected))
              << "seed " << seed << " close " << close << " axis " << axis << " layer " << k;
          not_empty += !cut.simplices.empty();
        }
    }
  EXPECT_GT(not_empty, 500u);
}

TEST(SliceThroughTies, AcrossAnyAxisShowsAWholeLayerWhereTheOneBelowIsMissingInPart) {
  // No sample equals the isovalue. The slice at layer 2 is the limit from below; above missing values it is the limit
  // from above.
  for (int axis = 0; axis < 4; ++axis) {
    auto image = test::noise<float, 4>(5, 20);
    const int other = (axis + 1) % 4;
    const auto has_values = test::noise<float, 4>(5, 20);
    test::for_each_sample<4>(image.grid, [&](std::size_t i, const std::array<std::size_t, 4>& index) {
      if (index[axis] == 1 && index[other] < 3) image.values[i] = std::numeric_limits<float>::quiet_NaN();
    });
    const auto cut = slice(extract<double>(image.view(), 0.5), Hyperplane<4>::across(axis, 2.0));
    // The layer of an image without missing values, all of whose tiles exist below.
    const auto expected = slice(extract<double>(has_values.view(), 0.5), Hyperplane<4>::across(axis, 2.0));
    EXPECT_TRUE(test::same_surface(cut, expected)) << axis;
    EXPECT_GT(cut.simplices.size(), 100u);
  }
}

}  // namespace
}  // namespace tegl
