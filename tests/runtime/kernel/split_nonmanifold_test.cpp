// SPDX-License-Identifier: BSD-3-Clause
//
// Contours beside missing values are manifolds too: vertices are duplicated if tiles meet only in an edge or a square.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/slice.hpp"

namespace tegl::test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

std::vector<ExtractOptions> variants() {
  std::vector<ExtractOptions> result;
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Ambiguity ambiguity : {Ambiguity::low, Ambiguity::high})
      for (const bool close : {false, true}) {
        ExtractOptions options;
        options.triangulation = triangulation;
        options.ambiguity = ambiguity;
        options.close = close;
        result.push_back(options);
      }
  return result;
}

template <int N>
void expect_manifolds(std::size_t size, std::size_t length, std::uint64_t seed, double share) {
  std::array<std::size_t, N> sizes;
  sizes.fill(size);
  sizes[0] = length;
  const auto image = noise_with_missing<float, N>(Grid<N>::unit(sizes), seed, share);
  for (const ExtractOptions& options : variants()) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", missing " + std::to_string(share) + ", barycentric " +
                 std::to_string(options.triangulation == Triangulation::barycentric) + ", high " +
                 std::to_string(options.ambiguity == Ambiguity::high) + ", close " + std::to_string(options.close));
    EXPECT_GT(expect_oriented_manifold(extract<float>(image.view(), 0.5, options)).simplices, 0u);
  }
}

TEST(Pinches, NoiseWithMissingValuesIn2dIsAManifold) {
  for (const double share : {0.02, 0.1, 0.3, 0.6}) expect_manifolds<2>(40, 70, 11, share);
}

TEST(Pinches, NoiseWithMissingValuesIn3dIsAManifold) {
  for (const double share : {0.01, 0.05, 0.1, 0.2, 0.35}) expect_manifolds<3>(12, 70, 12, share);
}

TEST(Pinches, NoiseWithMissingValuesIn4dIsAManifold) {
  for (const double share : {0.005, 0.02, 0.05, 0.1, 0.2}) expect_manifolds<4>(6, 12, 13, share);
}

/// Samples that rise from 0 to 1 along the axis with two of them. The contour at 0.5 is flat and has a vertex on each
/// edge along that axis.
template <int N>
OwnedImage<float, N> rising(const std::array<std::size_t, N>& sizes,
                            const std::vector<std::array<std::size_t, N>>& missing) {
  OwnedImage<float, N> image{Grid<N>::unit(sizes), {}};
  for_each_sample<N>(image.grid, [&](std::size_t, const std::array<std::size_t, N>& index) {
    const bool is_missing = std::find(missing.begin(), missing.end(), index) != missing.end();
    image.values.push_back(is_missing ? kNaN : static_cast<float>(index[2]));
  });
  return image;
}

template <int N>
std::ptrdiff_t vertices_at(const Contour<N, float>& contour, const std::array<float, N>& place) {
  return std::count(contour.vertices.begin(), contour.vertices.end(), place);
}

TEST(Pinches, TwoFieldsOfAChessboardAreTwoSheets) {
  // Of four tiles around an edge, two opposite ones are missing.
  const auto image = rising<3>({3, 3, 2}, {{0, 0, 0}, {2, 2, 0}});
  const auto contour = extract<float>(image.view(), 0.5);
  const MeshReport report = expect_oriented_manifold(contour);
  EXPECT_EQ(report.components, 2u);
  EXPECT_EQ(report.euler, 2);
  EXPECT_EQ(report.vertices, 8u);
  EXPECT_EQ(vertices_at<3>(contour, {1.0f, 1.0f, 0.5f}), 2);
}

TEST(Pinches, AnEdgeWithTwoFansGetsAMidpointInOne) {
  // Of the tiles around the square from x = 1 to 2 at y = t = 2, two opposite ones remain. One tile before x = 1 and
  // another behind x = 2 connect them, so each end of the contour's edge in the square has one fan.
  const auto image = rising<4>({4, 4, 2, 4}, {{1, 3, 0, 1}, {2, 1, 0, 3}});
  for (const ExtractOptions& options : variants()) {
    const auto contour = extract<float>(image.view(), 0.5, options);
    EXPECT_EQ(expect_oriented_manifold(contour).components, 1u);
    EXPECT_EQ(vertices_at<4>(contour, {1.0f, 2.0f, 0.5f, 2.0f}), 1);
    EXPECT_EQ(vertices_at<4>(contour, {1.5f, 2.0f, 0.5f, 2.0f}), 1);
    EXPECT_EQ(vertices_at<4>(contour, {2.0f, 2.0f, 0.5f, 2.0f}), 1);
  }
}

TEST(Pinches, HolesThatMeetInAPointArePartedByTetrahedraOfNoSize) {
  // Of the eight tiles around an edge, two that share only this edge are missing.
  const auto image = rising<4>({5, 5, 2, 5}, {{1, 1, 0, 1}, {3, 3, 0, 3}});
  for (const ExtractOptions& options : variants()) {
    const auto contour = extract<float>(image.view(), 0.5, options);
    const MeshReport report = expect_oriented_manifold(contour);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(vertices_at<4>(contour, {2.0f, 2.0f, 0.5f, 2.0f}), 2);
    EXPECT_GT(report.degenerate_simplices, 0u);
  }
}

TEST(Pinches, OneMissingCornerLeavesTheRestAsItWas) {
  auto image = noise<float, 3>(std::array<std::size_t, 3>{20, 20, 20}, 14);
  const auto whole = extract<float>(image.view(), 0.5);
  // One missing sample in a corner causes no duplicates: the rest of the contour keeps its numbers.
  image.values.back() = kNaN;
  const auto most = extract<float>(image.view(), 0.5);
  ASSERT_LE(most.vertices.size(), whole.vertices.size());
  std::size_t same = 0;
  while (same < most.vertices.size() && most.vertices[same] == whole.vertices[same]) ++same;
  EXPECT_GT(same, whole.vertices.size() * 9 / 10);
}

}  // namespace
}  // namespace tegl::test
