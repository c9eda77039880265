// SPDX-License-Identifier: BSD-3-Clause
//
// 4D contours of noise with ambiguities resolved from the data or at random: closed oriented 3-manifolds whose slices
// are closed oriented surfaces; the slice at an integer t is the contour of that layer.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "compare.hpp"
#include "estimators.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/extract.hpp"
#include "tegl/slice.hpp"
#include "tile_pieces.hpp"

namespace tegl::test {
namespace {

/// Noise with a low border.
OwnedImage<float, 4> enclosed_noise(std::size_t samples, std::uint64_t seed) {
  auto image = noise<float, 4>(samples, seed);
  for_each_sample<4>(image.grid, [&](std::size_t i, const std::array<std::size_t, 4>& index) {
    for (const std::size_t at : index)
      if (at == 0 || at + 1 == samples) image.values[i] = -1;
  });
  return image;
}

TEST(Ambiguity4d, ContoursOfNoiseAreClosedManifolds) {
  const auto image = noise<float, 4>(9, 1);
  for (auto [name, options] : all_ways()) {
    SCOPED_TRACE(name);
    options.close = true;
    expect_closed_manifold(extract<float>(image.view(), 0.5, options));
  }
}

TEST(Ambiguity4d, ContoursOfAnyShareOfHighSamplesAreManifolds) {
  for (const double isovalue : {0.2, 0.35, 0.65, 0.8}) {
    const auto image = noise<float, 4>(7, 2);
    for (const auto& [name, options] : all_ways()) {
      SCOPED_TRACE(name);
      expect_oriented_manifold(extract<float>(image.view(), isovalue, options));
    }
  }
}

TEST(Ambiguity4d, CutsAtAnyTimeAndObliqueOnesAreClosedSurfaces) {
  const auto image = enclosed_noise(8, 3);
  std::mt19937_64 bits(4);
  for (const auto& [name, options] : all_ways()) {
    SCOPED_TRACE(name);
    const auto contour = extract<double>(image.view(), 0.5, options);
    expect_closed_manifold(contour);
    for (int i = 0; i < 6; ++i) {
      EXPECT_GT(
          expect_closed_manifold(slice(contour, Hyperplane<4>::across(3, 1.0 + 5.0 * unit_random(bits)))).simplices,
          0u);
      Hyperplane<4> plane;
      for (int a = 0; a < 4; ++a) plane.normal[a] = unit_random(bits) - 0.5;
      plane.offset = std::accumulate(plane.normal.begin(), plane.normal.end(), 0.0) * 3.5;
      EXPECT_GT(expect_closed_manifold(slice(contour, plane)).simplices, 0u);
    }
  }
}

TEST(Ambiguity4d, AtAWholeTimeItIsTheContourOfTheLayer) {
  const auto image = noise<float, 4>(6, 5);
  const std::size_t layer = 6 * 6 * 6;
  for (const auto& [name, options] : all_ways()) {
    SCOPED_TRACE(name);
    const auto contour = extract<double>(image.view(), 0.5, options);
    for (std::size_t t = 0; t < 6; ++t) {
      const Image<float, 3> part(image.values.data() + t * layer, Grid<3>::unit({6, 6, 6}));
      const auto expected = extract<double>(part, 0.5, options);
      EXPECT_TRUE(same_surface(slice(contour, Hyperplane<4>::across(3, static_cast<double>(t))), expected));
      EXPECT_TRUE(same_surface(
          slice_image<double>(image.view(), 0.5, Hyperplane<4>::across(3, static_cast<double>(t)), options), expected));
    }
  }
}

/// The samples with index `at` along `axis`.
Image<float, 3> layer_across(const OwnedImage<float, 4>& image, int axis, std::size_t at) {
  Grid<3> grid;
  Image<float, 3>::Strides strides{};
  std::ptrdiff_t stride = 1, offset = 0;
  for (int a = 0, b = 0; a < 4; stride *= static_cast<std::ptrdiff_t>(image.grid.axes[a].size()), ++a) {
    if (a == axis) {
      offset = static_cast<std::ptrdiff_t>(at) * stride;
      continue;
    }
    grid.axes[b] = image.grid.axes[a];
    strides[b++] = stride;
  }
  return {image.values.data() + offset, grid, strides};
}

TEST(Ambiguity4d, AtAWholePlaceAlongAnyAxisItIsTheContourOfTheLayer) {
  const auto image = noise<float, 4>(6, 8);
  // A custom estimator sees the image's axes; in the layer a face's corners have the same order.
  for (const auto& [name, options] : all_ways())
    for (int axis = 0; axis < 4; ++axis)
      for (const std::size_t at : {1u, 4u}) {
        SCOPED_TRACE(name + ", axis " + std::to_string(axis) + ", at " + std::to_string(at));
        const auto expected = extract<double>(layer_across(image, axis, at), 0.5, options);
        EXPECT_TRUE(same_surface(
            slice_image<double>(image.view(), 0.5, Hyperplane<4>::across(axis, static_cast<double>(at)), options),
            expected));
      }
}

/// Between layers, the direct slice equals the slice of the contour.
TEST(Ambiguity4d, DirectCutsAreThoseOfTheContour) {
  const auto image = noise<float, 4>(6, 6);
  for (const auto& [name, options] : all_ways()) {
    SCOPED_TRACE(name);
    const auto contour = extract<double>(image.view(), 0.5, options);
    for (const double t : {0.3, 2.71, 4.5})
      EXPECT_TRUE(same_surface(slice_image<double>(image.view(), 0.5, Hyperplane<4>::across(3, t), options),
                               slice(contour, Hyperplane<4>::across(3, t))))
          << "at " << t;
  }
}

/// Images of small integers, whose edge points lie at few positions, and of uniform noise.
OwnedImage<double, 4> small_image(std::uint64_t seed) {
  const Grid<4> grid = Grid<4>::unit({3, 3, 4, 4});
  if (seed % 4 == 0) return noise<double, 4>(grid, seed);
  auto image = coarse_noise<double, 4>(grid, seed, 1 + seed % 4);
  for (double& value : image.values) value *= 0.5;
  return image;
}

TEST(Ambiguity4d, WithEpsilonVerticesLieApartAndNoBarycentricTetrahedronHasSizeZero) {
  for (auto [name, options] : all_ways())
    for (const bool close : {false, true}) {
      options.close = close;
      options.epsilon = 0.01;
      std::size_t shared = 0, flat = 0, tetrahedra = 0;
      for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const auto contour = extract<double>(view_of(small_image(seed)), 0.5, options);
        const auto vertices = sorted_vertices(contour);
        for (std::size_t v = 1; v < vertices.size(); ++v) shared += vertices[v] == vertices[v - 1] ? 1 : 0;
        for (std::size_t s = 0; s < contour.simplices.size(); ++s) flat += simplex_measure(contour, s) < 1e-13 ? 1 : 0;
        tetrahedra += contour.simplices.size();
      }
      EXPECT_GT(tetrahedra, 10000u);
      EXPECT_EQ(shared, 0u) << name << (close ? ", closed" : "");
      if (options.triangulation == Triangulation::barycentric) {
        EXPECT_EQ(flat, 0u) << name << (close ? ", closed" : "");
      }
    }
}

TEST(Ambiguity5d, ContoursOfNoiseAreClosedManifolds) {
  const auto image = noise<float, 5>({2, 3, 2, 2, 2}, 7);
  for (auto [name, options] : all_estimators()) {
    SCOPED_TRACE(name);
    options.close = true;
    expect_closed_manifold(extract<double>(image.view(), 0.5, options));
  }
}

}  // namespace
}  // namespace tegl::test
