// SPDX-License-Identifier: BSD-3-Clause
//
// Walks through a contour: distances from single simplices, and bounds by parts, compared with a search of all
// simplices.
#include "simplify/simplex_walk.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include "fields.hpp"
#include "only_targets.hpp"
#include "simplify/box_tree.hpp"
#include "simplify/corner_lanes.hpp"
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

/// Evenly distributed over the simplex.
template <int N>
PointN<N> random_point_of(std::mt19937& random, const CornersN<N>& corners) {
  std::exponential_distribution<double> share(1.0);
  std::array<double, N> weights;
  double sum = 0.0;
  for (double& weight : weights) sum += weight = share(random);
  PointN<N> p{};
  for (int i = 0; i < N; ++i)
    for (int a = 0; a < N; ++a) p[a] += weights[i] / sum * corners[i][a];
  return p;
}

template <int N>
CornersN<N> random_simplex(std::mt19937& random, double size) {
  CornersN<N> corners;
  for (auto& corner : corners) corner = random_point<N>(random, size);
  return corners;
}

/// Simplices with vertices of their own, near (shift, …, shift). Every tenth one is flat, and the next one
/// nearly if they are not shifted.
template <int N>
struct LooseSimplices {
  std::vector<PointN<N>> points;
  std::vector<std::array<Index, N>> simplices;

  LooseSimplices(Index count, double shift, std::mt19937& random) : simplices(count) {
    for (Index s = 0; s < count; ++s) {
      CornersN<N> corners = random_simplex<N>(random, 1.0);
      if (s % 10 == 0) corners[1] = corners[0];
      if (s % 10 == 1 && shift == 0.0) corners[1] = between(corners[0], corners[1], 1e-5);
      for (int i = 0; i < N; ++i) {
        for (double& x : corners[i]) x += shift;
        simplices[s][i] = static_cast<Index>(points.size());
        points.push_back(corners[i]);
      }
    }
  }
};

/// A ball's contour, with all that walks need.
template <int N>
struct WalkedBall {
  std::vector<std::array<Index, N>> simplices;
  std::vector<PointN<N>> points;

  explicit WalkedBall(std::size_t samples, double radius) {
    const auto image = test::sample_field<float, N>(test::centred_grid<N>(samples, 1.3), test::Ball<N>{{}, radius});
    const auto contour = extract<double>(image.view(), 0.0);
    simplices.assign(contour.simplices.begin(), contour.simplices.end());
    points.assign(contour.vertices.begin(), contour.vertices.end());
  }
  [[nodiscard]] SimplexCorners<N> corners() const { return {simplices, points}; }
  [[nodiscard]] FacetNeighbours<N> neighbours() const { return {simplices, points.size(), 1, {}}; }
  [[nodiscard]] double distance(const PointN<N>& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < simplices.size(); ++s)
      least = std::min(least, distance_to_simplex<N>(p, corners()[s], N));
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
  }
  EXPECT_GT(inside, 50);
}

/// In single precision, far from the origin and for flat simplices: an upper bound, and close to the nearest point
/// where the projection is inside.
TYPED_TEST(Walk, DistancesByGradientsAreUpperBounds) {
  constexpr int N = TypeParam::value;
  std::mt19937 random(17);
  const LooseSimplices<N> loose(500, 1e6, random);
  const SimplexCorners<N> corners(loose.simplices, loose.points);
  const SimplexGradients<N> gradients(corners, 1, {});
  int inside = 0;
  for (Index s = 0; s < corners.size(); ++s) {
    PointN<N> p = random_point<N>(random, 1.0);
    for (double& x : p) x += 1e6;
    const auto weights = gradients.weights(s, gradients.local(p));
    const double found = gradients.distance(s, p, weights), exact = distance_to_simplex<N>(p, corners[s], N);
    EXPECT_GE(found, exact - 1e-8) << s;
    const bool flat = s % 10 == 0;
    if (!flat && !weights.inside) continue;
    EXPECT_NEAR(found, exact, flat ? 1e-8 : 1e-3) << s;
    inside += !flat;
  }
  EXPECT_GT(inside, 10);
}

TYPED_TEST(Walk, DistancesOfAllCornersAreThoseOfEach) {
  constexpr int N = TypeParam::value;
  std::mt19937 random(23);
  const LooseSimplices<N> loose(100, 0.0, random);
  const SimplexCorners<N> corners(loose.simplices, loose.points);
  const SimplexGradients<N> gradients(corners, 1, {});
  test::with_all_targets([&] {
    for (Index s = 0; s < corners.size(); ++s) {
      // above, around, and at corners of the simplex; very far away
      for (const double size : {0.1, 2.0, 1e3, 1e30, 1e35}) {
        CornersN<N> part = random_simplex<N>(random, size);
        if (size == 2.0) part[1] = corners[s][1];
        const std::array<double, N> found = gradients.distances(s, part);
        for (int k = 0; k < N; ++k)
          ASSERT_EQ(found[k], gradients.distance(s, part[k], gradients.weights(s, gradients.local(part[k])))) << s;
      }
    }
  });
}

TYPED_TEST(Walk, BallsOfAllCornersAreThoseOfEach) {
  constexpr int N = TypeParam::value;
  std::mt19937 random(29);
  int bounded = 0, failed = 0;
  test::with_all_targets([&] {
    for (int trial = 0; trial < 1000; ++trial) {
      CornersN<N> corners = random_simplex<N>(random, 1.0);
      if (trial % 2 == 0)  // edges of equal length
        for (PointN<N>& corner : corners)
          for (double& x : corner) x = std::round(x);
      std::array<double, N> distances;
      for (double& distance : distances) distance = std::uniform_real_distribution<double>(0.0, 0.5)(random);
      if (trial % 3 == 0) distances.fill(0.25);
      const double limit = longest_edge<N>(corners) * std::uniform_real_distribution<double>(0.3, 1.2)(random);
      const CornerBalls<N> balls = balls_around<N>(corners, distances, limit),
                           of_each = balls_by_corners<N>(corners, distances, limit);
      ASSERT_EQ(balls.bound, of_each.bound);
      ASSERT_EQ(balls.nearest, of_each.nearest);
      ASSERT_EQ(balls.square_of_middle, of_each.square_of_middle);
      ++(balls.bound <= limit ? bounded : failed);
      const LongestEdge<N>&found = balls.edge, &expected = of_each.edge;
      const auto [first, second] = ends_of_longest_edge<N>(corners);
      ASSERT_EQ(found.first, first);
      ASSERT_EQ(found.second, second);
      ASSERT_EQ(std::sqrt(found.square), longest_edge<N>(corners));
      ASSERT_EQ(square_of_longest_edge<N>(corners), found.square);
      ASSERT_EQ(found.middle, between(corners[first], corners[second], 0.5));
      ASSERT_EQ(found.squares, expected.squares);
      for (int k = 0; k < N; ++k)
        ASSERT_NEAR(std::sqrt(found.squares[k]), norm(minus(corners[k], found.middle)), 1e-15);
    }
  });
  EXPECT_GT(bounded, 100);
  EXPECT_GT(failed, 100);
}

TYPED_TEST(Walk, EndsAtTheNearestPointOfASmoothContour) {
  constexpr int N = TypeParam::value;
  const WalkedBall<N> ball(N == 4 ? 6 : 20, 1.0);
  const FacetNeighbours<N> neighbours = ball.neighbours();
  const SimplexGradients<N> gradients(ball.corners(), 1, {});
  const SimplexWalk<N> walk(gradients, neighbours);
  std::mt19937 random(3);
  std::normal_distribution<double> step(0.0, 0.05);
  int nearest = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto start = static_cast<Index>(random() % ball.simplices.size());
    PointN<N> p = ball.corners()[start][0];
    for (double& x : p) x += step(random);
    const NearPoint found = walk.approach(p, start);
    const double exact = ball.distance(p);
    const CornersN<N> first = ball.corners()[start];
    EXPECT_GE(found.distance, exact - 1e-12);
    EXPECT_LE(found.distance, PlacedSimplex<N>(first).place(p).distance);
    EXPECT_GE(found.distance, distance_to_simplex<N>(p, ball.corners()[found.simplex], N) - 1e-12);
    nearest += found.distance <= 1.05 * exact + 0.01;
  }
  EXPECT_GT(nearest, kTrials * 3 / 4);
}

/// The middles of edges are kept from one simplex to the next: neither the order of the calls nor earlier ones change a
/// bound.
TYPED_TEST(Walk, BoundsDoNotDependOnTheOrderOfTheSimplices) {
  constexpr int N = TypeParam::value;
  const WalkedBall<N> ball(N == 4 ? 6 : 14, 1.0);
  const FacetNeighbours<N> neighbours = ball.neighbours();
  const SimplexGradients<N> gradients(ball.corners(), 1, {});
  const SimplexWalk<N> walk(gradients, neighbours);
  std::mt19937 random(13);
  std::vector<PointN<N>> moved = ball.points;
  std::vector<NearPoint> near;
  for (auto& point : moved) {
    for (double& x : point) x += std::uniform_real_distribution<double>(-0.1, 0.1)(random);
    near.push_back(walk.approach(point, 0));
  }
  const SimplexCorners<N> corners(ball.simplices, moved);
  const auto bound_with = [&](SimplexWalk<N>& one, std::size_t s) {
    typename SimplexWalk<N>::Part part{corners[s], {}, {}, ball.simplices[s]};
    for (int i = 0; i < N; ++i) part.set_near(i, near[part.vertices[i]]);
    return one.bound(part, 0.15, 48);
  };
  SimplexWalk<N> forward(gradients, neighbours), backward(gradients, neighbours);
  std::vector<double> bounds(ball.simplices.size());
  for (std::size_t s = 0; s < bounds.size(); ++s) bounds[s] = bound_with(forward, s);
  for (std::size_t s = bounds.size(); s-- > 0;) ASSERT_EQ(bound_with(backward, s), bounds[s]) << s;
  EXPECT_TRUE(std::any_of(bounds.begin(), bounds.end(), [](double x) { return x < 0.15; }));
}

/// By its definition: the distance of a point is at most that of any corner and the way to it. Sampled points attain
/// more than any bound that is too small.
TYPED_TEST(Walk, BallsAroundCornersBoundAllPointsOfASimplex) {
  constexpr int N = TypeParam::value;
  std::mt19937 random(17);
  int bounded = 0, below_one_ball = 0, failed = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const CornersN<N> corners = random_simplex<N>(random, 1.0);
    const LongestEdge<N> edge = longest_edge_by_corners<N>(corners);
    std::array<double, N> distances;
    for (double& distance : distances) distance = std::uniform_real_distribution<double>(0.0, 0.5)(random);
    const double limit = std::sqrt(edge.square) * std::uniform_real_distribution<double>(0.4, 1.2)(random);
    const double bound = bound_by_common_point<N>(corners, distances, edge, limit);
    if (!(bound < std::numeric_limits<double>::infinity())) {
      ++failed;
      continue;
    }
    ++bounded;
    EXPECT_LE(bound, limit);
    const double of_middle = *std::max_element(edge.squares.begin(), edge.squares.end());
    below_one_ball += bound < *std::max_element(distances.begin(), distances.end()) + std::sqrt(of_middle);
    for (int sample = 0; sample < 50; ++sample) {
      const PointN<N> p = random_point_of<N>(random, corners);
      double most = std::numeric_limits<double>::infinity();
      for (int i = 0; i < N; ++i) most = std::min(most, distances[i] + norm(minus(p, corners[i])));
      EXPECT_LE(most, bound + 1e-12) << trial;
    }
  }
  EXPECT_GT(bounded, 50);
  EXPECT_GT(below_one_ball, 50);
  EXPECT_GT(failed, 50);
}

/// Parts of all sizes near a contour with a hole: no point of a bounded part is farther than its bound.
TYPED_TEST(Walk, BoundsAllPointsOfASimplex) {
  constexpr int N = TypeParam::value;
  WalkedBall<N> ball(N == 4 ? 6 : 14, 1.0);
  std::erase_if(ball.simplices, [&](const auto& simplex) { return ball.points[simplex[0]][0] > 0.6; });  // the hole
  const FacetNeighbours<N> neighbours = ball.neighbours();
  const SimplexGradients<N> gradients(ball.corners(), 1, {});
  const BoxTree<N> tree(ball.corners());
  SimplexWalk<N> walk(gradients, neighbours, &tree);
  std::mt19937 random(11);
  int bounded = 0, failed = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto start = static_cast<Index>(random() % ball.simplices.size());
    const double size = 0.02 * std::pow(30.0, trial / 300.0);
    CornersN<N> part = random_simplex<N>(random, size);
    for (PointN<N>& corner : part)
      for (int a = 0; a < N; ++a) corner[a] += ball.corners()[start][0][a];
    typename SimplexWalk<N>::Part whole{part, {}, {}, {}};
    whole.vertices.fill(SimplexWalk<N>::kNone);
    for (int i = 0; i < N; ++i) whole.set_near(i, walk.approach(part[i], start));
    const double limit = trial % 2 == 0 ? 0.1 : 0.3;
    const double bound = walk.bound(whole, limit, 48);
    if (!(bound < std::numeric_limits<double>::infinity())) {
      ++failed;
      continue;
    }
    ++bounded;
    EXPECT_LE(bound, limit);
    EXPECT_FALSE(walk.matches().empty());
    for (int sample = 0; sample < 6; ++sample) {
      const PointN<N> p = random_point_of<N>(random, part);
      EXPECT_LE(ball.distance(p), bound + 1e-12) << trial;
    }
  }
  EXPECT_GT(bounded, 30);
  EXPECT_GT(failed, 30);
}

/// Boxes are in single precision: relative to a point of the contour, so that they stay small.
TYPED_TEST(Walk, TreeFindsTheNearestSimplexFarFromTheOrigin) {
  constexpr int N = TypeParam::value;
  WalkedBall<N> ball(N == 4 ? 5 : 10, 1.0);
  for (auto& point : ball.points)
    for (double& x : point) x += 1e6;
  const BoxTree<N> tree(ball.corners(), 2);
  std::mt19937 random(6);
  for (int i = 0; i < 50; ++i) {
    PointN<N> p = ball.points[random() % ball.points.size()];
    for (double& x : p) x += std::uniform_real_distribution<double>(-2.0, 2.0)(random);
    EXPECT_NEAR(tree.nearest(p).distance, ball.distance(p), 1e-8);
    std::set<Index> near;
    Box<N> box;
    box.add(p);
    tree.visit_near(box, 0.5, [&](Index s) { near.insert(s); });
    for (Index s = 0; s < ball.simplices.size(); ++s) {
      Box<N> of_simplex;
      for (const PointN<N>& corner : ball.corners()[s]) of_simplex.add(corner);
      EXPECT_EQ(near.count(s) == 1, of_simplex.meets(box, 0.5));
    }
  }
}

TYPED_TEST(Walk, FindsTheFarthestVertexExactly) {
  constexpr int N = TypeParam::value;
  const WalkedBall<N> ball(N == 4 ? 5 : 10, 1.0);
  const FacetNeighbours<N> neighbours = ball.neighbours();
  const SimplexGradients<N> gradients(ball.corners(), 1, {});
  const SimplexWalk<N> walk(gradients, neighbours);
  const BoxTree<N> tree(ball.corners(), 3);
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
