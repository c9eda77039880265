// SPDX-License-Identifier: BSD-3-Clause
//
// 4D contours with resolved ambiguities do not intersect themselves: random tiles with positions of the contour on
// edges that are uniform or near the edges' ends, and noise, by the exact test of tegl/intersections.hpp.
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "estimators.hpp"
#include "fields.hpp"
#include "interpolant_distance.hpp"
#include "nested_tiles.hpp"
#include "share.hpp"
#include "tegl/extract.hpp"
#include "tegl/intersections.hpp"

namespace tegl::test {
namespace {

struct TilesHit {
  int tiles = 0;
  std::uint64_t pairs = 0, flat = 0;

  /// Adds the tile with the values of 16 corners, at isovalue 0.
  void add(const std::vector<double>& values, const ExtractOptions& options) {
    IntersectionOptions<4> alone;
    alone.work.threads = 1;
    const auto found = find_intersections(
        extract<double>(Image<double, 4>(values.data(), Grid<4>::unit({2, 2, 2, 2})), 0.0, options), alone);
    tiles += found.is_embedded() ? 0 : 1;
    pairs += found.pair_count;
    flat += found.flat;
  }
};

/// `spread`: differences from the isovalue have the size exp(+-spread) at most; 0: uniform ones.
TilesHit count_random_tiles(Ambiguity ambiguity, Triangulation triangulation, double spread, int tiles) {
  std::mt19937_64 bits(1994);
  const auto unit = [&] { return static_cast<double>(bits() >> 11) * 0x1p-53; };
  ExtractOptions options;
  options.ambiguity = ambiguity;
  options.triangulation = triangulation;
  TilesHit result;
  std::vector<double> values(16);
  for (int i = 0; i < tiles; ++i) {
    for (double& value : values) {
      const double size = spread > 0 ? std::exp(spread * (2 * unit() - 1)) : unit();
      value = (bits() & 1u) != 0 ? size : -size;
    }
    result.add(values, options);
  }
  return result;
}

TEST(Embedded4d, RandomTilesDoNotIntersectThemselves) {
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle, Ambiguity::decider, Ambiguity::squares})
      for (const double spread : {0.0, 3.45}) {
        const TilesHit hit = count_random_tiles(ambiguity, triangulation, spread, 400);
        EXPECT_EQ(hit.tiles, 0) << "ambiguity " << static_cast<int>(ambiguity) << ", triangulation "
                                << static_cast<int>(triangulation) << ", spread " << spread << ": " << hit.pairs
                                << " pairs, " << hit.flat << " flat tetrahedra";
      }
}

/// Of tiles that are filled by nested copies.
TilesHit count_nested_tiles(Triangulation triangulation, double spread, int tiles) {
  std::mt19937_64 bits(1994);
  const auto unit = [&] { return static_cast<double>(bits() >> 11) * 0x1p-53; };
  NestedTiles random_tile(triangulation);
  detail::ResolvedKey key;
  ExtractOptions options;
  options.ambiguity = Ambiguity::custom;
  options.triangulation = triangulation;
  options.estimator.choose = [&](const AmbiguousFace& face) { return choice_of(key, face); };
  options.work.threads = 1;
  TilesHit result;
  std::vector<double> values(16);
  for (int i = 0; i < tiles; ++i) {
    key = random_tile(bits);
    for (unsigned v = 0; v < 16; ++v) {
      const double size = spread > 0 ? std::exp(spread * (2 * unit() - 1)) : unit();
      values[v] = (key.signature >> v & 1u) != 0 ? size : -size;
    }
    result.add(values, options);
  }
  return result;
}

TEST(Embedded4d, NestedCopiesDoNotIntersect) {
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const double spread : {0.0, 3.45}) {
      const TilesHit hit = count_nested_tiles(triangulation, spread, static_cast<int>(unless_sanitized(400, 40)));
      EXPECT_EQ(hit.tiles, 0) << "triangulation " << static_cast<int>(triangulation) << ", spread " << spread << ": "
                              << hit.pairs << " pairs, " << hit.flat << " flat tetrahedra";
    }
}

/// Tests the signatures first, first + step, ... with all points in the middle of edges.
TilesHit count_middle_tiles(Ambiguity ambiguity, Triangulation triangulation, unsigned first, unsigned step) {
  ExtractOptions options;
  options.ambiguity = ambiguity;
  options.triangulation = triangulation;
  options.work.threads = 1;
  TilesHit result;
  std::vector<double> values(16);
  for (unsigned signature = first; signature < 65'535; signature += step) {
    for (unsigned v = 0; v < 16; ++v) values[v] = (signature >> v & 1u) != 0 ? 1.0 : -1.0;
    result.add(values, options);
  }
  return result;
}

/// Cells of masks have all points in the middle. Compact cells by `mean`: all signatures; by other rules, a share.
TEST(Embedded4d, PointsInTheMiddleDoNotIntersect) {
  for (const Triangulation triangulation : {Triangulation::compact, Triangulation::barycentric})
    for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle, Ambiguity::decider, Ambiguity::squares}) {
      const bool is_whole = triangulation == Triangulation::compact && ambiguity == Ambiguity::mean;
      const std::size_t count = cases_to_test(65'534, is_whole ? unless_sanitized(65'534, 1024) : 1024);
      const auto step = static_cast<unsigned>(65'534 / count);
      const TilesHit hit = count_middle_tiles(ambiguity, triangulation, 1, step);
      EXPECT_EQ(hit.tiles, 0) << "ambiguity " << static_cast<int>(ambiguity) << ", triangulation "
                              << static_cast<int>(triangulation) << ": " << hit.pairs << " pairs, " << hit.flat
                              << " flat tetrahedra";
    }
}

TEST(Embedded4d, ContoursOfMasksDoNotIntersectThemselves) {
  std::mt19937 random(14);
  std::vector<std::uint8_t> mask(6 * 6 * 6 * 6);
  for (std::uint8_t& value : mask) value = static_cast<std::uint8_t>(random() & 1u);
  const Image<std::uint8_t, 4> image(mask.data(), Grid<4>::unit({6, 6, 6, 6}));
  for (const auto& [name, options] : all_ways()) {
    const auto found = find_intersections(extract<double>(image, 0.5, options));
    EXPECT_EQ(found.pair_count, 0u) << name;
    EXPECT_EQ(found.flat, 0u) << name;
  }
}

TEST(Embedded4d, ContoursOfNoiseDoNotIntersectThemselves) {
  const auto image = noise<double, 4>(6, 5);
  for (const auto& [name, options] : all_ways()) {
    const auto found = find_intersections(extract<double>(image.view(), 0.5, options));
    EXPECT_EQ(found.pair_count, 0u) << name;
    EXPECT_EQ(found.flat, 0u) << name;
  }
}

/// Root-mean-square distances from the interpolant in random tiles: copies at their levels, and half way to the centre.
std::array<double, 2> distances_of_copies(Ambiguity ambiguity, Triangulation triangulation) {
  std::mt19937_64 bits(1994), places(1);
  ExtractOptions options;
  options.ambiguity = ambiguity;
  options.triangulation = triangulation;
  std::array<InterpolantDistance, 2> distance;
  for (int i = 0; i < 1000; ++i) {
    CellFunction<4>::Values values;
    for (double& value : values) value = static_cast<double>(bits() >> 11) * 0x1p-52 - 1.0;
    auto contour = extract<double>(Image<double, 4>(values.data(), Grid<4>::unit({2, 2, 2, 2})), 0.0, options);
    const auto at_levels = contour;
    if (move_copies_half_way<4>(contour) == 0) continue;
    add_distances(CellFunction<4>(values), at_levels, 1, places, distance[0]);
    add_distances(CellFunction<4>(values), contour, 1, places, distance[1]);
  }
  EXPECT_GT(distance[0].points, 3000u);
  return {distance[0].root_mean_square(), distance[1].root_mean_square()};
}

TEST(Embedded4d, CopiesAtTheInterpolantsLevelsAreNearerToItThanHalfWay) {
  for (const Ambiguity ambiguity : {Ambiguity::mean, Ambiguity::saddle}) {
    const auto [barycentric, barycentric_half_way] = distances_of_copies(ambiguity, Triangulation::barycentric);
    EXPECT_LT(barycentric, 0.75 * barycentric_half_way);
    const auto [compact, compact_half_way] = distances_of_copies(ambiguity, Triangulation::compact);
    EXPECT_LT(compact, 0.9 * compact_half_way);
  }
}

}  // namespace
}  // namespace tegl::test
