// SPDX-License-Identifier: BSD-3-Clause
//
// The result does not depend on the processor or the number of threads: equal bytes for each instruction set of this
// machine, with 1 to 4 threads.
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "ambiguity/variants.hpp"
#include "fields.hpp"
#include "only_targets.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

template <class Rows>
bool equal_bytes(const Rows& a, const Rows& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

template <class Real, Value T, int N>
void expect_same_bytes(const Image<T, N>& image, double isovalue, ExtractOptions options) {
  options.work.threads = 1;
  const auto expected = extract<Real>(image, isovalue, options);
  EXPECT_FALSE(expected.simplices.empty());
  unsigned seen = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const OnlyTargets only(target);
    SCOPED_TRACE(hwy::TargetName(target));
    options.work.threads = 1 + seen++ % 4;
    const auto contour = extract<Real>(image, isovalue, options);
    EXPECT_TRUE(equal_bytes(contour.vertices, expected.vertices)) << options.work.threads << " threads";
    EXPECT_TRUE(equal_bytes(contour.simplices, expected.simplices)) << options.work.threads << " threads";
    EXPECT_TRUE(equal_bytes(contour.normals, expected.normals)) << options.work.threads << " threads";
  }
  for (options.work.threads = 0; options.work.threads <= 4; ++options.work.threads) {
    const auto contour = extract<Real>(image, isovalue, options);
    EXPECT_TRUE(equal_bytes(contour.vertices, expected.vertices)) << options.work.threads << " threads";
    EXPECT_TRUE(equal_bytes(contour.simplices, expected.simplices)) << options.work.threads << " threads";
    EXPECT_TRUE(equal_bytes(contour.normals, expected.normals)) << options.work.threads << " threads";
  }
}

/// A reversed axis that starts at 0, so that -0 occurs; a sheared world.
template <int N>
Grid<N> slanted(const std::array<std::size_t, N>& sizes, bool mapped) {
  Grid<N> grid = Grid<N>::unit(sizes);
  grid.axes[0] = Axis::uniform(sizes[0], -0.0, -0.3);
  grid.axes[N - 1] = Axis::uniform(sizes[N - 1], 0.0, -0.7);
  if (mapped) {
    grid.linear[0][1] = 0.25;
    grid.offset[1] = -3.1;
  }
  return grid;
}

template <class Real, Value T, int N>
void expect_same_bytes_of_noise(const std::array<std::size_t, N>& sizes, std::uint64_t seed) {
  for (ExtractOptions options : variants()) {
    options.close = seed % 3 == 0;
    options.normals = seed % 2 == 0 ? Normals::differences : Normals::none;
    SCOPED_TRACE(describe(options) + ", seed " + std::to_string(seed));
    expect_same_bytes<Real>(view_of(noise<T, N>(slanted<N>(sizes, seed % 2 == 0), seed)), noise_isovalue<T>(), options);
    options.epsilon = seed % 5 == 0 ? 0.01 : 0.0;
    // Many samples at the isovalue: positions of 0 with either sign.
    expect_same_bytes<Real>(view_of(coarse_noise<T, N>(slanted<N>(sizes, seed % 2 != 0), seed, 3)), 1.0, options);
    ++seed;
  }
}

template <class T>
class SameBytesOf : public ::testing::Test {};
using ValueTypes =
    ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::int32_t, float, double>;
TYPED_TEST_SUITE(SameBytesOf, ValueTypes);

TYPED_TEST(SameBytesOf, NoiseWhateverTheProcessorAndTheThreads) {
  expect_same_bytes_of_noise<float, TypeParam, 2>({130, 70}, 1);
  expect_same_bytes_of_noise<double, TypeParam, 2>({67, 130}, 11);
  expect_same_bytes_of_noise<float, TypeParam, 3>({67, 9, 13}, 21);
  expect_same_bytes_of_noise<double, TypeParam, 3>({21, 17, 5}, 31);
  expect_same_bytes_of_noise<float, TypeParam, 4>({9, 5, 7, 8}, 41);
  expect_same_bytes_of_noise<double, TypeParam, 4>({66, 3, 2, 5}, 51);
}

/// Missing and infinite samples.
template <class Real, Value T, int N>
void expect_same_bytes_of_holes(const std::array<std::size_t, N>& sizes, std::uint64_t seed) {
  for (ExtractOptions options : variants()) {
    SCOPED_TRACE(describe(options));
    auto image = noise_with_missing<T, N>(slanted<N>(sizes, seed % 2 == 0), seed, 0.02);
    for (std::size_t i = seed % 7; i < image.values.size(); i += 7)
      image.values[i] = (i % 2 == 0 ? 1 : -1) * std::numeric_limits<T>::infinity();
    for (std::size_t i = seed % 5; i < image.values.size(); i += 5)
      image.values[i] = (i % 2 == 0 ? 1 : -1) * std::numeric_limits<T>::max();
    options.close = seed++ % 3 == 0;
    expect_same_bytes<Real>(image.view(), 0.5, options);
  }
}

TEST(SameBytes, HolesAndInfinitiesWhateverTheProcessorAndTheThreads) {
  expect_same_bytes_of_holes<float, float, 2>({130, 70}, 61);
  expect_same_bytes_of_holes<double, double, 2>({30, 140}, 65);
  expect_same_bytes_of_holes<float, double, 3>({67, 9, 13}, 71);
  expect_same_bytes_of_holes<double, float, 3>({7, 19, 23}, 75);
  expect_same_bytes_of_holes<float, float, 4>({9, 5, 7, 8}, 81);
  expect_same_bytes_of_holes<double, double, 4>({21, 3, 4, 5}, 85);
}

TEST(SameBytes, OfFacesThatTheDataDecide) {
  for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider}) {
    ExtractOptions options;
    options.ambiguity = ambiguity;
    expect_same_bytes<float>(view_of(noise<float, 3>({130, 6, 7}, 94)), 0.5, options);
    expect_same_bytes<float>(view_of(coarse_noise<std::uint8_t, 3>(Grid<3>::unit({67, 9, 5}), 95, 2)), 0.5, options);
    expect_same_bytes<float>(view_of(coarse_noise<float, 3>(Grid<3>::unit({67, 5, 9}), 96, 5)), 1.3, options);
    expect_same_bytes<float>(view_of(noise_with_missing<float, 3>(Grid<3>::unit({67, 6, 7}), 97, 0.02)), 0.5, options);
    expect_same_bytes<float>(view_of(noise<float, 4>({67, 3, 4, 3}, 98)), 0.5, options);
    expect_same_bytes<float>(view_of(coarse_noise<double, 4>(Grid<4>::unit({9, 4, 3, 4}), 99, 2)), 0.5, options);
  }
}

/// With normals, rays of a tesseract are found one tesseract at a time; without, those of several together.
template <class Real>
void expect_same_places_with_normals(const Image<float, 4>& image, double isovalue, ExtractOptions options) {
  SCOPED_TRACE(describe(options));
  const auto plain = extract<Real>(image, isovalue, options);
  options.normals = Normals::differences;
  const auto with_normals = extract<Real>(image, isovalue, options);
  EXPECT_GT(plain.vertices.size(), 1000u);
  EXPECT_EQ(with_normals.normals.size(), plain.vertices.size());
  EXPECT_TRUE(equal_bytes(plain.vertices, with_normals.vertices));
  EXPECT_TRUE(equal_bytes(plain.simplices, with_normals.simplices));
}

TEST(SameBytes, OfVerticesInsideTesseractsWithAndWithoutNormals) {
  for (int rule = 0; rule < 8; ++rule) {
    ExtractOptions options;
    options.triangulation = rule < 4 ? Triangulation::compact : Triangulation::barycentric;
    options.ambiguity =
        std::array{Ambiguity::mean, Ambiguity::saddle, Ambiguity::squares, Ambiguity::decider}[rule % 4];
    for (const double epsilon : {0.0, 0.01}) {
      options.epsilon = epsilon;
      auto image = noise<float, 4>(slanted<4>({9, 7, 8, 6}, epsilon > 0.0), 101);
      expect_same_places_with_normals<float>(image.view(), 0.5, options);
      expect_same_places_with_normals<double>(image.view(), 0.5, options);
    }
    auto holes = noise_with_missing<float, 4>(slanted<4>({9, 7, 8, 6}, true), 102, 0.01);
    for (std::size_t i = 3; i < holes.values.size(); i += 97)
      holes.values[i] = (i % 2 == 0 ? 1.0f : -1.0f) * std::numeric_limits<float>::infinity();
    expect_same_places_with_normals<float>(holes.view(), 0.5, options);
  }
}

TEST(SameBytes, OfManyBatchesOfRows) {
  expect_same_bytes<float>(view_of(noise<float, 2>({600, 2000}, 91)), 0.5, {});
  expect_same_bytes<float>(view_of(noise<float, 3>(80, 92)), 0.5, {});
  expect_same_bytes<float>(view_of(noise<std::uint8_t, 4>(14, 93)), noise_isovalue<std::uint8_t>(), {});
}

TEST(SameBytes, OfMoreThreadsThanThereAre) {
  const auto image = noise<float, 3>({67, 40, 40}, 94);
  ExtractOptions options;
  options.work.threads = 1;
  const auto expected = extract<float>(image.view(), 0.5, options);
  for (const unsigned threads : {1000u, 0x7fffffffu, 0x80000000u, ~0u}) {
    options.work.threads = threads;
    const auto contour = extract<float>(image.view(), 0.5, options);
    EXPECT_TRUE(equal_bytes(contour.vertices, expected.vertices)) << threads << " threads";
    EXPECT_TRUE(equal_bytes(contour.simplices, expected.simplices)) << threads << " threads";
  }
}

}  // namespace
}  // namespace tegl::test
