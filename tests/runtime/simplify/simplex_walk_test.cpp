// SPDX-License-Identifier: BSD-3-Clause
//
// Walks through a contour: distances from single simplices, and bounds by parts, compared with a search of all
// simplices.
#include "simplify/simplex_walk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "fields.hpp"
#include "simplify/box_tree.hpp"
#include "simplify/facet_neighbours.hpp"
#include "simplify/vertex_distances.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {
namespace {

template <class T>
class Walk : public ::testing::Test {};
using WalkDimensions =
    ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(Walk, WalkDimensions);

template <int N>
PointN<N> random_point(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> coordinate(-size, size);
  PointN<N> p;
  for (double& x : p) x = coordinate(random);
  return p;
}

template <int N>
CornersN<N> random_simplex(std::mt19937& random, double size) {
  CornersN<N> corners;
  for (auto& corner : corners) corner = random_point<N>(random, size);
  return corners;
}

/// A ball's contour, with all that walks need.
template <int N>
struct WalkedBall {
  std::vector<std::array<Index, N>> simplices;
  std::vector<PointN<N>> points;
  std::vector<CornersN<N>> corners;

  explicit WalkedBall(std::size_t samples, double radius) {
    const auto image = test::sample_field<float, N>(test::centred_grid<N>(samples, 1.3), test::Ball<N>{{}, radius});
    const auto contour = extract<double>(image.view(), 0.0);
    simplices.assign(contour.simplices.begin(), contour.simplices.end());
    points.assign(contour.vertices.begin(), contour.vertices.end());
    for (const auto& simplex : simplices) {
      CornersN<N>& at = corners.emplace_back();
      for (int i = 0; i < N; ++i) at[i] = points[simplex[i]];
    }
  }
  [[nodiscard]] FacetNeighbours<N> neighbours() const { return {simplices, points.size(), 1, {}}; }
  [[nodiscard]] double distance(const PointN<N>& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& simplex : corners) least = std::min(least, distance_to_simplex<N>(p, simplex, N));
    return least;
  }
};

TYPED_TEST(Walk, APlaceIsTheNearestPointInsideAndAnUpperBoundOutside) {
  constexpr int N = TypeParam::value;
  std::mt19937 random(7);
  int inside = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    CornersN<N> corners = random_simplex<N>(random, 1.0);
    if (trial % 10 == 0) corners[1] = corners[0];  // flat
    const PointN<N> p = random_point<N>(random, 1.0);
    const double exact = distance_to_simplex<N>(p, corners, N);
    const PlacedSimplex<N> placed(corners);
    const auto place = placed.place(p);
    EXPECT_GE(place.distance, exact - 1e-9) << trial;
    if (place.inside) {
      EXPECT_NEAR(place.distance, exact, 1e-9) << trial;
      ++inside;
    }
    for (const double limit : {0.5 * exact, 1.5 * exact})
      EXPECT_EQ(placed.distance(p, limit) <= limit, exact <= limit) << trial;
  }
  EXPECT_GT(inside, 50);
}

TYPED_TEST(Walk, EndsAtTheNearestPointOfASmoothContour) {
  constexpr int N = TypeParam::value;
  const WalkedBall<N> ball(N == 4 ? 6 : 20, 1.0);
  const FacetNeighbours<N> neighbours = ball.neighbours();
  const SimplexWalk<N> walk(ball.corners, neighbours);
  std::mt19937 random(3);
  std::normal_distribution<double> step(0.0, 0.05);
  int nearest = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto start = static_cast<Index>(random() % ball.corners.size());
    PointN<N> p = ball.corners[start][0];
    for (double& x : p) x += step(random);
    const NearPoint found = walk.approach(p, start);
    const double exact = ball.distance(p);
    EXPECT_GE(found.distance, exact - 1e-12);
    EXPECT_LE(found.distance, PlacedSimplex<N>(ball.corners[start]).place(p).distance);
    EXPECT_GE(found.distance, distance_to_simplex<N>(p, ball.corners[found.simplex], N) - 1e-12);
    nearest += found.distance <= 1.05 * exact + 0.01;
  }
  EXPECT_GT(nearest, kTrials * 3 / 4);
}

/// Parts of all sizes near a contour with a hole: no point of a bounded part is farther than its bound.
TYPED_TEST(Walk, BoundsAllPointsOfASimplex) {
  constexpr int N = TypeParam::value;
  WalkedBall<N> ball(N == 4 ? 6 : 14, 1.0);
  const auto in_hole = [&](std::size_t s) { return ball.corners[s][0][0] > 0.6; };
  std::vector<std::array<Index, N>> kept;
  std::vector<CornersN<N>> kept_corners;
  for (std::size_t s = 0; s < ball.simplices.size(); ++s)
    if (!in_hole(s)) {
      kept.push_back(ball.simplices[s]);
      kept_corners.push_back(ball.corners[s]);
    }
  ball.simplices = kept;
  ball.corners = kept_corners;
  const FacetNeighbours<N> neighbours = ball.neighbours();
  SimplexWalk<N> walk(ball.corners, neighbours);
  std::mt19937 random(11);
  std::exponential_distribution<double> share(1.0);
  int bounded = 0, failed = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto start = static_cast<Index>(random() % ball.corners.size());
    const double size = 0.02 * std::pow(30.0, trial / 300.0);
    CornersN<N> part;
    std::array<NearPoint, N> near;
    for (int i = 0; i < N; ++i) {
      part[i] = random_point<N>(random, size);
      for (int a = 0; a < N; ++a) part[i][a] += ball.corners[start][0][a];
      near[i] = walk.approach(part[i], start);
    }
    const double limit = trial % 2 == 0 ? 0.1 : 0.3;
    const double bound = walk.bound(part, near, limit, 48);
    if (!(bound < std::numeric_limits<double>::infinity())) {
      ++failed;
      continue;
    }
    ++bounded;
    EXPECT_LE(bound, limit);
    EXPECT_FALSE(walk.matches().empty());
    for (int sample = 0; sample < 6; ++sample) {
      std::array<double, N> weights;
      double sum = 0.0;
      for (double& weight : weights) sum += weight = share(random);
      PointN<N> p{};
      for (int i = 0; i < N; ++i)
        for (int a = 0; a < N; ++a) p[a] += weights[i] / sum * part[i][a];
      EXPECT_LE(ball.distance(p), bound + 1e-12) << trial;
    }
  }
  EXPECT_GT(bounded, 30);
  EXPECT_GT(failed, 30);
}

TYPED_TEST(Walk, FindsTheFarthestVertexExactly) {
  constexpr int N = TypeParam::value;
  const WalkedBall<N> ball(N == 4 ? 5 : 10, 1.0);
  const FacetNeighbours<N> neighbours = ball.neighbours();
  const SimplexWalk<N> walk(ball.corners, neighbours);
  const BoxTree<N> tree(ball.corners);
  std::mt19937 random(5);
  std::vector<PointN<N>> moved = ball.points;
  std::vector<double> distances;
  for (auto& point : moved) {
    for (double& x : point) x += std::uniform_real_distribution<double>(-0.1, 0.1)(random);
    distances.push_back(ball.distance(point));
  }
  for (const unsigned threads : {1u, 3u}) {
    VertexDistances<N> vertices(ball.simplices, moved, tree, walk, threads);
    vertices.approach({});
    EXPECT_NEAR(vertices.find_largest({}), *std::max_element(distances.begin(), distances.end()), 1e-12);
    vertices.search_above(0.0, {});
    for (std::size_t v = 0; v < moved.size(); ++v) ASSERT_NEAR(vertices.near()[v].distance, distances[v], 1e-12) << v;
  }
}

}  // namespace
}  // namespace tegl::detail
