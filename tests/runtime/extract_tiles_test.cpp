// SPDX-License-Identifier: BSD-3-Clause
//
// The extraction without tables: in 2D to 4D against the one by tables, in 5D by what a contour has to be.
#include "extract_tiles.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "compare.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

template <class Real = double, Value T, int N>
Contour<N, Real> extract_tile_by_tile(const Image<T, N>& image, double isovalue, const ExtractOptions& options = {}) {
  detail::ImageSource<T, N> source(image, isovalue, options.epsilon);
  Contour<N, Real> contour;
  detail::extract_tiles<N, Real>(source, image.grid(), options, &contour, nullptr);
  return contour;
}

/// Coordinates rounded to 2^-30, so that what differs by rounding errors is the same.
template <int N>
Contour<N, double> rounded(Contour<N, double> contour) {
  for (auto& vertex : contour.vertices)
    for (double& x : vertex) x = std::round(x * 0x1p30) * 0x1p-30;
  return contour;
}

template <Value T, int N>
void expect_as_by_tables(const Image<T, N>& image, double isovalue, ExtractOptions options = {}) {
  options.triangulation = Triangulation::barycentric;
  for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high}) {
    options.ambiguity = ambiguity;
    EXPECT_TRUE(same_surface(rounded(extract_tile_by_tile(image, isovalue, options)),
                             rounded(extract<double>(image, isovalue, options))));
  }
}

TEST(ExtractTiles, PlaneImagesHaveTheContoursOfTheTables) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) expect_as_by_tables(noise<float, 2>(70, seed).view(), 0.5);
}

TEST(ExtractTiles, VolumesHaveTheContoursOfTheTables) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) expect_as_by_tables(noise<float, 3>(12, seed).view(), 0.5);
}

TEST(ExtractTiles, TesseractsHaveTheContoursOfTheTables) {
  expect_as_by_tables(sample_field<float, 4>(centred_grid<4>(9, 1.5), Ball<4>{}).view(), 0.0);
}

}  // namespace
}  // namespace tegl::test
