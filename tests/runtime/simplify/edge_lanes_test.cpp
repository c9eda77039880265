// SPDX-License-Identifier: BSD-3-Clause
//
// The arithmetic for several simplices or edges gives the bits of the functions for one; equal keys are found.
#include "simplify/edge_lanes.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/equal_keys.hpp"
#include "mesh/simplex_shapes.hpp"
#include "simplify/quadric.hpp"

namespace tegl::detail {
namespace {

template <class T>
class Lanes : public testing::Test {};
using LaneDimensions =
    testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(Lanes, LaneDimensions);

template <int N>
PointN<N> any_point(std::mt19937& random) {
  PointN<N> point;
  for (double& x : point) x = std::normal_distribution<double>()(random);
  return point;
}

template <int N>
void expect_shape(const ShapeLanes<N>& lanes, std::size_t k, const CornersN<N>& corners) {
  const PointN<N> normal = normal_of<N>(corners);
  for (int a = 0; a < N; ++a) EXPECT_EQ(lanes.normal[a][k], normal[a]);
  EXPECT_EQ(lanes.length[k], norm(normal));
  EXPECT_EQ(lanes.shape[k], shape_of_simplex<N>(corners, norm(normal)));
}

TYPED_TEST(Lanes, ShapesAreThoseOfSingleSimplices) {
  constexpr int N = TypeParam::value;
  std::mt19937 random(1);
  for (int trial = 0; trial < 50; ++trial) {
    std::array<CornersN<N>, kEdgeLanes> all;
    std::array<int, kEdgeLanes> moving{};
    SimplexLanes<N> lanes;
    for (std::size_t k = 0; k < kEdgeLanes; ++k) {
      for (PointN<N>& corner : all[k]) corner = any_point<N>(random);
      if (trial % 5 == 0) all[k].fill(all[k][0]);  // no extent
      moving[k] = static_cast<int>(random() % N);
      lanes.moving[k] = moving[k];
      for (int i = 0; i < N; ++i) lanes.set_corner(k, i, all[k][i]);
    }
    const PointN<N> place = any_point<N>(random);
    ShapeLanes<N> after;
    measure_lanes<N>(lanes);
    move_lanes<N>(lanes, place, after);
    for (std::size_t k = 0; k < kEdgeLanes; ++k) {
      expect_shape<N>(lanes.before, k, all[k]);
      all[k][moving[k]] = place;
      expect_shape<N>(after, k, all[k]);
    }
  }
}

TYPED_TEST(Lanes, CostsAreThoseOfSingleEdges) {
  constexpr int N = TypeParam::value;
  std::mt19937 random(2);
  PointN<N> centre{}, scale{};
  for (int a = 0; a < N; ++a) {
    centre[a] = 3.25 * a;
    scale[a] = 1.0 / (a + 3);
  }
  const auto some_quadric = [&](const PointN<N>& at) {
    Quadric<N> quadric;
    for (int plane = 0; plane < 2 * N; ++plane) {
      PointN<N> normal = any_point<N>(random), on = any_point<N>(random);
      const double length = norm(normal);
      for (double& x : normal) x /= length;
      for (int a = 0; a < N; ++a) on[a] = at[a] + 0.1 * on[a];
      quadric.add_plane(normal, on, 0.5 + plane);
    }
    return quadric;
  };
  int far = 0;
  for (int trial = 0; trial < 50; ++trial) {
    const PointN<N> place = any_point<N>(random);
    const Quadric<N> quadric = some_quadric(place);
    TargetLanes<N> lanes;
    std::array<Quadric<N>, kEdgeLanes> others;
    std::array<PointN<N>, kEdgeLanes> places;
    for (std::size_t k = 0; k < kEdgeLanes; ++k) {
      places[k] = k == 0 ? place : any_point<N>(random);  // the first edge has no length
      others[k] = some_quadric(places[k]);
      lanes.set(k, others[k], places[k], k % 2 == 0);
    }
    const double most_square = 0.05;
    const bool single = trial % 2 == 0;
    find_target_lanes<N>({quadric, place, centre, scale, most_square, single}, lanes);
    for (std::size_t k = 0; k < kEdgeLanes; ++k) {
      Quadric<N> sum = quadric;
      sum += others[k];
      const PointN<N>&first = k % 2 == 0 ? places[k] : place, &second = k % 2 == 0 ? place : places[k];
      const PointN<N> edge = minus(second, first), middle = between(first, second, 0.5);
      PointN<N> best = sum.least_near(middle);
      const PointN<N> away = minus(best, middle);
      const double square = dot(edge, edge);
      EXPECT_EQ(lanes.square[k], square);
      EXPECT_EQ(lanes.is_far[k] == 0.0, dot(away, away) <= most_square * square && square > 0.0);
      far += lanes.is_far[k] != 0.0;
      for (int a = 0; a < N; ++a) {
        double x = best[a] / scale[a] + centre[a];
        if (single) x = static_cast<double>(static_cast<float>(x));
        best[a] = (x - centre[a]) * scale[a];
      }
      EXPECT_EQ(lanes.cost[k], sum(best));
    }
  }
  EXPECT_GT(far, 50);
  EXPECT_LT(far, 300);
}

TEST(EqualKeys, FindsTheFirstTwoOfEachGroupAndTheirNumber) {
  std::mt19937 random(3);
  EqualKeys equal;
  for (const std::size_t count : {0, 1, 2, 40, 5000}) {
    std::vector<std::uint64_t> keys(count);
    for (auto& key : keys) key = (random() % (count / 2 + 1)) << 40;
    std::map<std::uint64_t, std::vector<std::uint32_t>> expected;
    for (std::uint32_t i = 0; i < count; ++i) expected[keys[i]].push_back(i);
    const auto& groups = equal.groups(count, [&](auto i) { return keys[i]; });
    EXPECT_EQ(groups.size(), expected.size());
    EXPECT_TRUE(
        std::is_sorted(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.first < b.first; }));
    for (const auto& group : groups) {
      const auto& all = expected.at(keys[group.first]);
      EXPECT_EQ(group.count, all.size());
      EXPECT_EQ(group.first, all[0]);
      EXPECT_EQ(group.second, all.size() > 1 ? all[1] : all[0]);
    }
  }
}

}  // namespace
}  // namespace tegl::detail
