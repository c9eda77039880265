// SPDX-License-Identifier: BSD-3-Clause
//
// Contours beside missing values are manifolds too: vertices are duplicated if tiles meet only in an edge or a square.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "fields.hpp"
#include "invariants.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"
#include "tegl/slice.hpp"
#include "tile/link_balls.hpp"

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

TEST(Pinches, NoiseWithMissingValuesIn5dIsAManifold) {
  const std::vector<ExtractOptions> all = variants();
  for (const auto& [share, variant] : {std::pair{0.002, 0u}, {0.02, 1u}, {0.1, 2u}, {0.002, 5u}}) {
    ExtractOptions options = all[variant];
    SCOPED_TRACE("missing " + std::to_string(share) + ", variant " + std::to_string(variant));
    const auto image = noise_with_missing<float, 5>(Grid<5>::unit({4, 4, 4, 3, 4}), 16, share);
    options.work.threads = 1;
    const auto contour = extract<float>(image.view(), 0.5, options);
    EXPECT_GT(expect_oriented_manifold(contour).simplices, 0u);
    const ContourSize size = count(image.view(), 0.5, options);
    EXPECT_EQ(size.vertices, contour.vertices.size());
    EXPECT_EQ(size.simplices, contour.simplices.size());
    options.work.threads = 3;
    const auto other = extract<float>(image.view(), 0.5, options);
    EXPECT_EQ(other.vertices, contour.vertices);
    EXPECT_EQ(other.simplices, contour.simplices);
  }
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

TEST(Pinches, In5dAMissingSampleLeavesAHoleAndNoCopies) {
  // The flat contour has one vertex for each pair of samples along axis 2, but for the pair of the missing one. The
  // tiles around that are a box without corners that touch others.
  const auto image = rising<5>({5, 5, 2, 5, 5}, {{2, 2, 0, 2, 2}});
  const auto contour = extract<float>(image.view(), 0.5);
  const MeshReport report = expect_oriented_manifold(contour);
  EXPECT_EQ(report.components, 1u);
  EXPECT_EQ(report.vertices, 5u * 5 * 5 * 5 - 1);
  EXPECT_EQ(report.euler, 0);  // a ball with a ball cut out, around which is a 3-sphere
}

TEST(Pinches, In5dTilesThatShareOnlyAnEdgeAreTwoSheets) {
  // Of the sixteen tiles around the edge in the middle, the first and the last remain.
  std::vector<std::array<std::size_t, 5>> missing;
  for (unsigned v = 0; v < 16; ++v) {
    const unsigned ones = (v & 1u) + (v >> 1 & 1u) + (v >> 2 & 1u) + (v >> 3);
    if (ones == 0 || ones == 4) continue;
    missing.push_back({2 * (v & 1u), 2 * (v >> 1 & 1u), 0, 2 * (v >> 2 & 1u), 2 * (v >> 3)});
  }
  const auto image = rising<5>({3, 3, 2, 3, 3}, missing);
  const auto contour = extract<float>(image.view(), 0.5);
  const MeshReport report = expect_oriented_manifold(contour);
  EXPECT_EQ(report.components, 2u);
  EXPECT_EQ(report.euler, 2);
  EXPECT_EQ(report.vertices, 32u);
  EXPECT_EQ(vertices_at<5>(contour, {1.0f, 1.0f, 0.5f, 1.0f, 1.0f}), 2);
}

/// Number of faces that two boundary simplices have at the same place: where the contour was cut open.
template <int N>
std::size_t cut_faces(const Contour<N, float>& contour) {
  std::map<std::array<Index, N - 1>, unsigned> faces;
  for (const auto& simplex : contour.simplices)
    for (std::size_t omitted = 0; omitted < N; ++omitted) {
      std::array<Index, N - 1> face;
      for (std::size_t j = 0, k = 0; j < N; ++j)
        if (j != omitted) face[k++] = simplex[j];
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  std::map<std::array<std::array<float, N>, N - 1>, unsigned> places;
  for (const auto& [face, count] : faces) {
    if (count != 1) continue;
    std::array<std::array<float, N>, N - 1> place;
    for (std::size_t j = 0; j < face.size(); ++j) place[j] = contour.vertices[face[j]];
    std::sort(place.begin(), place.end());
    if (std::adjacent_find(place.begin(), place.end()) == place.end()) ++places[place];  // no zero-size face
  }
  return static_cast<std::size_t>(std::ranges::count_if(places, [](const auto& each) { return each.second > 1; }));
}

TEST(Pinches, In5dTwoMissingSamplesMakeNoCuts) {
  // The tiles around two missing samples, of the flat contour along axis 2, have a box of 3, 2, 1 or 0 dimensions in
  // common if they are two steps apart along 1, 2, 3 or 4 axes.
  for (const std::array<std::size_t, 4> steps : {std::array<std::size_t, 4>{2, 0, 1, 0},
                                                 {2, 2, 0, 0},
                                                 {2, 2, 1, 0},
                                                 {2, 2, 1, 1},
                                                 {2, 2, 2, 0},
                                                 {2, 2, 2, 1},
                                                 {2, 2, 2, 2}}) {
    const auto image =
        rising<5>({7, 7, 2, 7, 7}, {{2, 2, 0, 2, 2}, {2 + steps[0], 2 + steps[1], 0, 2 + steps[2], 2 + steps[3]}});
    SCOPED_TRACE(testing::Message() << steps[0] << steps[1] << steps[2] << steps[3]);
    const auto contour = extract<float>(image.view(), 0.5);
    EXPECT_EQ(expect_oriented_manifold(contour).components, 1u);
    EXPECT_EQ(cut_faces<5>(contour), 0u);
  }
}

/// The boundary of the 16-cell: vertices 2a and 2a + 1 are opposite.
tile::Simplices cross_polytope(unsigned without) {
  tile::Simplices simplices;
  for (unsigned v = 0; v < 16; ++v) {
    if ((without >> v & 1u) != 0) continue;
    tile::Simplex& simplex = simplices.emplace_back(tile::kNoSimplex);
    for (unsigned a = 0; a < 4; ++a) simplex[a] = static_cast<tile::VertexId>(2 * a + (v >> a & 1u));
  }
  return simplices;
}

TEST(LinkBalls, SpheresAndBallsAreOneBallAndOthersAreDivided) {
  std::size_t divided = 0;
  for (unsigned without = 0; without < 0xffff; without += 7) {
    const tile::Simplices link = cross_polytope(without);
    const std::vector<std::uint32_t> balls = detail::balls_of_link(link);
    const std::uint32_t count = *std::max_element(balls.begin(), balls.end()) + 1;
    EXPECT_EQ(count == 1, tile::shape_of(link) != tile::Shape::other) << without;
    for (std::uint32_t ball = 0; ball < count; ++ball) {
      tile::Simplices part;
      for (std::size_t s = 0; s < link.size(); ++s)
        if (balls[s] == ball) part.push_back(link[s]);
      EXPECT_NE(tile::shape_of(part), tile::Shape::other) << without << ", ball " << ball;
    }
    divided += count > 1 ? 1 : 0;
  }
  EXPECT_GT(divided, 1000u);
  // two opposite tetrahedra are missing: a sphere with two holes
  EXPECT_EQ(detail::balls_of_link(cross_polytope(0x8001)).size(), 14u);
  EXPECT_NE(detail::balls_of_link(cross_polytope(0x8001)), std::vector<std::uint32_t>(14, 0));
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
