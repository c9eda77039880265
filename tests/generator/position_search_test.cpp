// SPDX-License-Identifier: BSD-3-Clause
//
// The search for positions at which simplices intersect: its exact test against known pairs and against the proof, and
// its places of vertices against the runtime's.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "filling/embedding_evidence.hpp"
#include "symmetry/tile_symmetry.hpp"
#include "tegl/generated/tables.hpp"
#include "tile/extract_tables.hpp"

namespace tegl::gen {
namespace {

constexpr std::int64_t kOne = std::int64_t{1} << kGridBits;

/// Triangles (0, 1, 2) and (a, b, c) at given points.
double miss_of(const std::vector<GridPoint>& points, const LocalSimplex& other) {
  const SimplexMeeting pair(3, {0, 1, 2}, other);
  const double miss = pair.miss(points);
  EXPECT_FALSE(miss == 0 && pair.are_clearly_apart(points));
  EXPECT_EQ(miss, SimplexMeeting(3, other, {0, 1, 2}).miss(points));
  return miss;
}

TEST(SimplexMeeting, KnownTriangles) {
  std::vector<GridPoint> points = {{0, 0, 0}, {kOne, 0, 0}, {0, kOne, 0}};
  const auto with = [&](std::vector<GridPoint> others) {
    points.resize(3);
    points.insert(points.end(), others.begin(), others.end());
  };
  with({{kOne / 4, kOne / 4, -kOne}, {kOne / 4, kOne / 4, kOne}, {kOne, kOne, kOne}});
  EXPECT_EQ(0, miss_of(points, {3, 4, 5})) << "pierced";
  with({{kOne / 4, kOne / 4, 1}, {kOne / 4, kOne / 4, kOne}, {kOne, kOne, kOne}});
  EXPECT_GT(miss_of(points, {3, 4, 5}), 0) << "just above";
  with({{kOne / 4, kOne / 4, 0}, {kOne / 4, kOne / 4, kOne}, {kOne, kOne, kOne}});
  EXPECT_EQ(0, miss_of(points, {3, 4, 5})) << "touching";
  with({{kOne, kOne, 0}, {-kOne, -kOne, 0}, {-kOne, -2 * kOne, 0}});
  EXPECT_EQ(0, miss_of(points, {3, 4, 5})) << "in one plane";
  with({{kOne, kOne, 0}, {2 * kOne, kOne, 0}, {kOne, 2 * kOne, 0}});
  EXPECT_GT(miss_of(points, {3, 4, 5}), 0) << "in one plane, apart";
  with({{0, -kOne, 0}, {kOne, -kOne, kOne}});
  EXPECT_GT(miss_of(points, {0, 1, 3}), 0) << "a common side";
  EXPECT_GT(miss_of(points, {0, 2, 1}), 0) << "the same triangle, reversed: its vertices are common";
  with({{kOne / 2, kOne / 4, 0}, {0, 0, kOne}});
  EXPECT_EQ(0, miss_of(points, {0, 1, 3})) << "overlapping at a common side";
  EXPECT_GT(miss_of(points, {0, 2, 4}), 0) << "upright at a common side";
  EXPECT_EQ(0, miss_of(points, {0, 3, 4})) << "upright at a common vertex, through the inside";
}

TEST(SimplexMeeting, MissesLessTheNearerItIs) {
  double last = 1;
  for (const std::int64_t height : {kOne / 2, kOne / 4, kOne / 64, kOne / 4096, std::int64_t{1}}) {
    const std::vector<GridPoint> points = {{0, 0, 0},    {kOne, 0, 0},   {0, kOne, 0}, {kOne / 4, kOne / 4, height},
                                           {0, 0, kOne}, {kOne, 0, kOne}};
    const double miss = miss_of(points, {3, 4, 5});
    EXPECT_LT(miss, last);
    EXPECT_GT(miss, 0);
    last = miss;
  }
}

/// Random pairs of simplices on edges: the proof is exact for them, so the search must not find an intersection of a
/// proved pair, and should find most of the others.
TEST(PositionSearch, AgreesWithTheProofOnEdges) {
  for (const int n : {3, 4}) {
    const CubeLattice lattice(n);
    const ContourBuilder builder(lattice, n, Alternative::low, Triangulation::compact);
    const Tile& tile = builder.tile();
    const EmbeddingProof proof(tile);
    std::mt19937 random(2);
    std::vector<std::uint8_t> edges(tile.edge_count());
    for (std::size_t e = 0; e < edges.size(); ++e) edges[e] = static_cast<std::uint8_t>(e);
    int meeting = 0, found = 0;
    for (int i = 0; i < 150; ++i) {
      std::array<LocalSimplex, 2> pair{};
      for (LocalSimplex& s : pair) {
        std::shuffle(edges.begin(), edges.end(), random);
        std::copy_n(edges.begin(), n, s.begin());
      }
      TileContour contour;
      contour.boundary = {pair[0], pair[1]};
      LocalSimplex last{};  // the boundary's simplices have a vertex less
      for (std::size_t k = 0; k < 2; ++k) last[k] = pair[k][static_cast<std::size_t>(n) - 1];
      if (n == 3) contour.boundary.push_back(last);
      if (n == 4) contour.boundary.push_back({last[0], last[1], last[1]});
      const SimplexPair both{pair[0], pair[1]};
      const SearchPlan plan{.seed = 1, .uniform = 200, .near_ends = 200, .descents = 8, .steps = 64};
      const bool is_found = PositionSearch(builder, contour, {&both, 1}).find(plan, 0).has_value();
      const bool is_proved = proof.holds(pair);
      // The proof does not compare simplices in one facet of the tile.
      const bool in_facet = std::any_of(tile.faces.begin(), tile.faces.end(), [&](const SubTile& face) {
        const auto has = [&](std::uint8_t e) {
          return std::find(face.edge.begin(), face.edge.end(), e) != face.edge.end();
        };
        return std::count_if(pair[0].begin(), pair[0].begin() + n, has) > 1 &&
               std::count_if(pair[1].begin(), pair[1].begin() + n, has) > 1;
      });
      EXPECT_FALSE(is_proved && is_found && !in_facet) << n << "-tile, pair " << i;
      meeting += is_proved ? 0 : 1;
      found += !is_proved && is_found ? 1 : 0;
    }
    EXPECT_GT(meeting, 20);
    EXPECT_GT(found, meeting * 95 / 100) << "of " << meeting;
  }
}

TEST(PositionSearch, ASeedGivesTheSamePositions) {
  // Two segments of a square that cross for all positions: the middle is the first one tried.
  const CubeLattice lattice(2);
  const ContourBuilder builder(lattice, 2, Alternative::low, Triangulation::compact);
  const Tile& square = builder.tile();
  const std::uint8_t left = square.edge_between(0, 2), right = square.edge_between(1, 3);
  const std::uint8_t below = square.edge_between(0, 1), above = square.edge_between(2, 3);
  TileContour contour;
  contour.boundary = {{left}, {right}, {below}, {above}};
  const SimplexPair crossing{{left, right}, {below, above}}, parallel{{left, below}, {right, above}};
  const auto found = PositionSearch(builder, contour, {&crossing, 1}).find({}, 0);
  ASSERT_TRUE(found);
  EXPECT_EQ(std::vector<std::int64_t>(4, kOne / 2), *found);
  EXPECT_FALSE(PositionSearch(builder, contour, {&parallel, 1}).find({}, 0));
}

/// The barycentres of a cube's polygons by the runtime, in the tile's frame.
detail::TilePoint<4> cube_barycentre(const Tile& tile, Signature s, unsigned cube, unsigned slot,
                                     const std::array<double, 32>& at) {
  const SubTile& face = tile.faces[cube];
  const tables::TileTable& table = tables::tile_table(3, Triangulation::barycentric);
  const detail::SimplexList<3> list(table, static_cast<unsigned>(tile.restrict_to(cube, s)));
  std::array<detail::TilePoint<3>, 8> own{};
  detail::own_places<3>(
      list, false, [&](unsigned v) { return detail::edge_point<3>(list.mapped(v), at[face.edge[list.mapped(v)]]); },
      own.data());
  return detail::cube_point(cube, own[slot]);
}

TEST(VertexPlaces, AreThoseOfTheRuntime) {
  const CubeLattice lattice(4);
  const ContourBuilder builder(lattice, 4, Alternative::low, Triangulation::barycentric);
  const tables::TileTable& table = tables::tile_table(4, Triangulation::barycentric);
  const TileClasses classes = tile_classes(lattice.tile(4));
  std::mt19937 random(4);
  std::size_t compared = 0;
  for (const std::uint32_t s : classes.classes.representatives) {
    const TileContour contour = builder.build(s);
    const VertexPlaces vertices(builder, contour);
    std::array<std::int64_t, 32> at{};
    std::array<double, 32> alpha{};
    for (std::size_t e = 0; e < 32; ++e) {
      at[e] = 1 + static_cast<std::int64_t>(random() % (kOne - 1));
      alpha[e] = static_cast<double>(at[e]) / static_cast<double>(kOne);
    }
    std::vector<GridPoint> places(256);
    vertices.compute(at, places);
    const detail::SimplexList<4> list(table, s);
    std::array<detail::TilePoint<4>, 256> own{};
    detail::own_places<4>(
        list, false,
        [&](unsigned stored) {
          const unsigned v = list.mapped(stored);
          if (v < 32) return detail::edge_point<4>(v, alpha[v]);
          const unsigned cube = (v - 32) / tables::kFaceSlots, slot = (v - 32) % tables::kFaceSlots;
          return cube_barycentre(lattice.tile(4), s, cube, slot, alpha);
        },
        own.data());
    for (unsigned j = 0; j < list.own_vertices(); ++j)
      for (std::size_t a = 0; a < 4; ++a, ++compared)
        ASSERT_NEAR(own[j][a], static_cast<double>(places[builder.own_base() + j][a]) / static_cast<double>(kOne), 1e-7)
            << "signature " << s << ", own vertex " << j;
  }
  EXPECT_GT(compared, 1000u);
}

}  // namespace
}  // namespace tegl::gen
