// SPDX-License-Identifier: BSD-3-Clause
//
// Contours of 4D noise with every face resolved from the data: closed oriented manifolds whose slices are closed
// oriented surfaces; at time steps the slice equals the step's contour.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "compare.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "simplicial_contour.hpp"
#include "tegl/extract.hpp"
#include "tegl/hyperplane.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

constexpr Ambiguity kEstimators[] = {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider};

/// Coordinates rounded to 2^-30, to remove differences by rounding errors.
Contour<3, double> rounded(Contour<3, double> contour) {
  for (auto& vertex : contour.vertices)
    for (double& x : vertex) x = std::round(x * 0x1p30) * 0x1p-30;
  return contour;
}

TEST(Resolved4d, ClosedNoiseIsAClosedManifoldAndSoIsEveryCut) {
  std::mt19937_64 bits(9);
  for (const Ambiguity ambiguity : kEstimators) {
    ExtractOptions options;
    options.ambiguity = ambiguity;
    options.close = true;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const auto image = noise<std::int16_t, 4>({7, 6, 5, 6}, seed);
      const auto contour = extract<double>(image.view(), 0.5, options);
      expect_closed_manifold(contour);
      for (int i = 0; i < 4; ++i)
        expect_closed_manifold(slice(contour, Hyperplane<4>::across(3, 5.0 * unit_random(bits))));
      for (int i = 0; i < 4; ++i) {
        Hyperplane<4> oblique;
        for (double& x : oblique.normal) x = unit_random(bits) - 0.5;
        oblique.offset = 2.5 * std::accumulate(oblique.normal.begin(), oblique.normal.end(), 0.0);
        expect_closed_manifold(slice(contour, oblique));
      }
    }
  }
}

/// A random choice for each face of the grid, determined by its position.
tile::Choice hashed(const AmbiguousFace& face) {
  std::uint64_t hash = face.axes();
  for (const std::size_t i : face.base()) hash = (hash ^ hash >> 31 ^ i) * 0x9e3779b97f4a7c15u;
  return static_cast<tile::Choice>((hash >> 40) % 3);
}

TEST(Resolved4d, AnyChoicesForTheFacesGiveAClosedManifold) {
  ExtractOptions options;
  options.ambiguity = Ambiguity::custom;
  options.estimator.choose = hashed;
  options.close = true;
  for (std::uint64_t seed = 11; seed <= 13; ++seed) {
    const auto contour = extract<double>(view_of(noise<float, 4>(7, seed)), 0.5, options);
    expect_closed_manifold(contour);
    expect_closed_manifold(slice(contour, Hyperplane<4>::across(3, 2.75)));
  }
}

TEST(Resolved4d, AtWholeStepsItIsTheContourOfTheStep) {
  for (const Ambiguity ambiguity : kEstimators) {
    ExtractOptions options;
    options.ambiguity = ambiguity;
    const auto image = noise<float, 4>({8, 7, 6, 6}, 5);
    const auto contour = extract<double>(image.view(), 0.5, options);
    EXPECT_TRUE(is_open_only_where_data_end(contour, image.view()));
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_TRUE(same_surface(rounded(slice(contour, Hyperplane<4>::across(3, static_cast<double>(k)))),
                               rounded(extract<double>(last_axis_layer(image.view(), k), 0.5, options))))
          << "layer " << k;
  }
}

}  // namespace
}  // namespace tegl::test
