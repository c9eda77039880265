// SPDX-License-Identifier: BSD-3-Clause
//
// Properties of find_intersections, on configurations made to intersect.
#include "tegl/intersections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "errors.hpp"
#include "random_fields.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

using Surface = Contour<3, double>;
using Solid = Contour<4, double>;

Surface surface_of(std::initializer_list<std::array<double, 3>> vertices,
                   std::initializer_list<std::array<Index, 3>> simplices) {
  Surface surface;
  surface.vertices.assign(vertices);
  surface.simplices.assign(simplices);
  return surface;
}

TEST(Intersections, ATriangleThatPiercesAnother) {
  const auto found = find_intersections(
      surface_of({{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {2, 2, -1}, {2, 2, 1}, {-9, 9, 3}}, {{0, 1, 2}, {3, 4, 5}}));
  ASSERT_EQ(found.pair_count, 1u);
  EXPECT_FALSE(found.is_embedded());
  EXPECT_EQ(found.pairs[0].first, 0u);
  EXPECT_EQ(found.pairs[0].second, 1u);
  const auto& place = found.pairs[0].place;
  EXPECT_NEAR(place[2], 0.0, 1e-12);
  EXPECT_GE(place[0], -1e-12);
  EXPECT_GE(place[1], -1e-12);
  EXPECT_LE(place[0] + place[1], 9.0 + 1e-12);
  EXPECT_DOUBLE_EQ(found.depth, 1.0);  // the second reaches 1 below the first
  EXPECT_EQ(found.intersecting, 2u);
}

TEST(Intersections, NeighboursThatMeetOnlyInTheirCommonFaceDoNotCount) {
  EXPECT_TRUE(find_intersections(surface_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {-1, 0, 0}},
                                            {{0, 1, 2}, {1, 3, 2}, {0, 1, 4}, {0, 4, 5}}))
                  .is_embedded());
}

TEST(Intersections, OverlapBesideACommonEdgeCounts) {
  const auto found =
      find_intersections(surface_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {0, 1, 3}}));
  ASSERT_EQ(found.pair_count, 1u);
  EXPECT_EQ(found.pairs[0].depth, 0.0);
  EXPECT_GT(found.pairs[0].place[1], 0.0);  // not on the common edge
}

TEST(Intersections, TheSameVerticesTwiceCount) {
  EXPECT_EQ(find_intersections(surface_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {1, 0, 2}})).pair_count, 1u);
}

TEST(Intersections, VerticesOfEqualPositionAndDifferentNumberTouch) {
  EXPECT_EQ(find_intersections(surface_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {-1, 0, 1}, {0, -1, 1}},
                                          {{0, 1, 2}, {3, 4, 5}}))
                .pair_count,
            1u);
}

TEST(Intersections, FlatSimplicesAreCountedApart) {
  const auto found = find_intersections(surface_of(
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, -1, -1}, {1, -1, 1}, {1, 2, 0}}, {{0, 1, 2}, {3, 4, 5}, {0, 0, 5}}));
  EXPECT_EQ(found.flat, 2u);
  EXPECT_EQ(found.pair_count, 0u);
  EXPECT_FALSE(found.is_embedded());
}

TEST(Intersections, SegmentsOfThePlaneThatCross) {
  Contour<2, float> lines;
  lines.vertices.assign({{0, 0}, {2, 2}, {0, 2}, {2, 0}, {3, 3}});
  lines.simplices.assign({{0, 1}, {2, 3}, {1, 4}});
  const auto found = find_intersections(lines);
  ASSERT_EQ(found.pair_count, 1u);
  EXPECT_DOUBLE_EQ(found.pairs[0].place[0], 1.0);
  EXPECT_DOUBLE_EQ(found.pairs[0].place[1], 1.0);
}

/// A vertex and a closed chain of `steps` edges around it that winds `turns` times, with rising and falling height.
Surface winding_star(int steps, int turns) {
  Surface surface;
  surface.vertices.push_back({0, 0, 0});
  for (int i = 0; i < steps; ++i) {
    const double angle = 2 * std::numbers::pi * turns * i / steps;
    surface.vertices.push_back({std::cos(angle), std::sin(angle), 0.2 * std::cos(angle / turns)});
    surface.simplices.push_back({0, static_cast<Index>(1 + i), static_cast<Index>(1 + (i + 1) % steps)});
  }
  return surface;
}

// All triangles have the same orientation after projection in both cases; only the number of turns differs.
TEST(Intersections, AStarThatWindsTwiceIntersectsItself) {
  EXPECT_EQ(find_intersections(winding_star(9, 1)).pair_count, 0u);
  EXPECT_GT(find_intersections(winding_star(9, 2)).pair_count, 0u);
}

// In 4D: the suspension of both, with the vertex in the middle of the edge between the two poles.
TEST(Intersections, ASuspendedStarThatWindsTwiceIntersectsItself) {
  for (const int turns : {1, 2}) {
    const Surface star = winding_star(9, turns);
    Solid solid;
    for (const auto& v : star.vertices) solid.vertices.push_back({v[0], v[1], v[2], 0.0});
    const auto pole = static_cast<Index>(solid.vertices.size());
    solid.vertices.push_back({0.01, 0.02, 0, 1});
    solid.vertices.push_back({0.01, 0.02, 0, -1});
    for (const auto& s : star.simplices) {
      solid.simplices.push_back({s[0], s[1], s[2], pole});
      solid.simplices.push_back({s[0], s[2], s[1], pole + 1});
    }
    const auto found = find_intersections(solid);
    EXPECT_EQ(found.pair_count > 0, turns == 2) << found.pair_count;
  }
}

/// Noise with tunnels in which vertices were moved: with pairs.
template <int N>
Contour<N, double> moved_contour(std::size_t samples, double by) {
  std::mt19937_64 bits(26);
  const auto field = random_field<N>(bits, samples, 1 << 20, true);
  const auto image = image_of<float>(field);
  auto contour = extract<double>(image.view(), 0.0, {});
  for (auto& vertex : contour.vertices)
    for (double& x : vertex) x += by * (static_cast<double>(random_below(bits, 2001)) / 1000 - 1);
  return contour;
}

template <int N>
void expect_same_for_all_threads() {
  const auto contour = moved_contour<N>(N == 3 ? 24 : 6, 0.15);
  IntersectionOptions<N> options;
  options.work.threads = 1;
  const auto one = find_intersections(contour, options);
  EXPECT_GT(one.pair_count, 10u);
  options.work.threads = 4;
  const auto four = find_intersections(contour, options);
  ASSERT_EQ(one.pairs.size(), four.pairs.size());
  for (std::size_t i = 0; i < one.pairs.size(); ++i) {
    EXPECT_EQ(one.pairs[i].first, four.pairs[i].first);
    EXPECT_EQ(one.pairs[i].second, four.pairs[i].second);
    EXPECT_EQ(one.pairs[i].place, four.pairs[i].place);
    EXPECT_EQ(one.pairs[i].depth, four.pairs[i].depth);
  }
}
TEST(Intersections, AreTheSameForAnyNumberOfThreads) {
  expect_same_for_all_threads<3>();
  expect_same_for_all_threads<4>();
}

TEST(Intersections, TheFirstPairsAreListedAndAllAreCounted) {
  const auto contour = moved_contour<3>(12, 0.2);
  const auto all = find_intersections(contour);
  IntersectionOptions<3> options;
  options.most_listed = 3;
  const auto some = find_intersections(contour, options);
  ASSERT_GT(all.pair_count, 3u);
  EXPECT_EQ(some.pair_count, all.pair_count);
  EXPECT_EQ(some.intersecting, all.intersecting);
  ASSERT_EQ(some.pairs.size(), 3u);
  EXPECT_EQ(some.pairs[2].second, all.pairs[2].second);
}

TEST(Intersections, TheDeepestPairsAreTheSameForAnyNumberOfThreads) {
  const auto contour = moved_contour<3>(24, 0.2);
  auto expected = find_intersections(contour).pairs;
  constexpr std::size_t kMost = 20;
  ASSERT_GT(expected.size(), 10 * kMost);
  std::stable_sort(expected.begin(), expected.end(), [](const auto& p, const auto& q) { return p.depth > q.depth; });
  IntersectionOptions<3> options;
  options.most_listed = kMost;
  options.deepest_first = true;
  for (const unsigned threads : {1u, 2u, 3u, 5u}) {
    options.work.threads = threads;
    const auto found = find_intersections(contour, options);
    EXPECT_EQ(found.pair_count, expected.size());
    EXPECT_EQ(found.depth, expected[0].depth);
    ASSERT_EQ(found.pairs.size(), kMost);
    for (std::size_t i = 0; i < kMost; ++i) {
      EXPECT_EQ(found.pairs[i].first, expected[i].first) << i;
      EXPECT_EQ(found.pairs[i].second, expected[i].second) << i;
      EXPECT_EQ(found.pairs[i].depth, expected[i].depth) << i;
    }
  }
}

TEST(Intersections, TilesAreCounted) {
  // two pairs, in the tiles (0, 0, 0) and (10, 0, 0), and a triangle alone in the tile (20, 0, 0)
  Surface surface;
  for (const double x : {1.0, 21.0})
    for (const auto& v : {std::array{0.0, 0.0, 0.5},
                          {1.0, 0.0, 0.5},
                          {0.0, 1.0, 0.5},
                          {0.2, 0.2, 0.1},
                          {0.3, 0.2, 0.9},
                          {0.2, 0.3, 0.9}})
      surface.vertices.push_back({v[0] + x, v[1], v[2]});
  surface.vertices.insert(surface.vertices.end(), {{41, 0, 0}, {42, 0, 0.1}, {41, 1, 0.1}});
  surface.simplices.assign({{0, 1, 2}, {3, 4, 5}, {6, 7, 8}, {9, 10, 11}, {12, 13, 14}});
  IntersectionOptions<3> options;
  options.tiles = IntersectionTiles<3>{{2, 1, 1}, {1, 0, 0}};
  const auto found = find_intersections(surface, options);
  EXPECT_EQ(found.pair_count, 2u);
  EXPECT_EQ(found.tiles, 3u);
  EXPECT_EQ(found.tiles_hit, 2u);
  options.tiles->size[1] = 0.0;
  expect_error(ErrorCode::InvalidArgument, "size of tiles along axis 1 is 0",
               [&] { find_intersections(surface, options); });
  options.tiles->size[1] = 1.0;
  options.tiles->origin[2] = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorCode::InvalidArgument, "origin of tiles on axis 2 is nan",
               [&] { find_intersections(surface, options); });
}

TEST(Intersections, AnEmptyContourHasNone) {
  EXPECT_TRUE(find_intersections(Contour<2, double>{}).is_embedded());
  EXPECT_TRUE(find_intersections(Contour<4, float>{}).is_embedded());
}

TEST(Intersections, BadContoursAreRefused) {
  Surface surface = surface_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}});
  expect_error(ErrorCode::InvalidArgument, "vertex number 3", [&] { find_intersections(surface); });
  surface.simplices[0] = {0, 1, 2};
  surface.vertices[1][1] = std::numeric_limits<double>::infinity();
  expect_error(ErrorCode::InvalidArgument, "inf", [&] { find_intersections(surface); });
}

TEST(Intersections, ProgressMayCancel) {
  const auto contour = moved_contour<3>(16, 0.1);
  IntersectionOptions<3> options;
  double last = 0.0;
  options.work.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  };
  find_intersections(contour, options);
  EXPECT_EQ(last, 1.0);
  options.work.progress = [](double fraction) { return fraction < 0.5; };
  expect_error(ErrorCode::Cancelled, "", [&] { find_intersections(contour, options); });
}

}  // namespace
}  // namespace tegl::test
