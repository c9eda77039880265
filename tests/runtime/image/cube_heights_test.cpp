// SPDX-License-Identifier: BSD-3-Clause
//
// Levels of the contour on rays inside cubes and tiles, against the multilinear interpolant by its definition.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "image/cell_heights.hpp"
#include "image/rays_of_tiles.hpp"
#include "image/row_source.hpp"
#include "only_targets.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::detail {
namespace {

/// The corners of all corners, edges and squares of the cube.
std::vector<std::uint32_t> ends_of_rays() {
  std::vector<std::uint32_t> result;
  for (unsigned fixed = 1; fixed < 8; ++fixed)
    for (unsigned at = 0; at < 8; ++at) {
      if ((at & ~fixed) != 0) continue;
      std::uint32_t corners = 0;
      for (unsigned v = 0; v < 8; ++v)
        if ((v & fixed) == at) corners |= 1u << v;
      result.push_back(corners);
    }
  return result;
}

/// The interpolant at a position on a ray.
double height_at(const std::array<double, 8>& heights, std::uint32_t corners, double level) {
  std::array<double, 3> point{};
  for (unsigned v = 0; v < 8; ++v)
    for (unsigned a = 0; a < 3; ++a)
      if ((corners >> v & 1u) != 0) point[a] += (v >> a & 1u) != 0 ? 1.0 : 0.0;
  for (double& x : point) x = 0.5 + level * (x / std::popcount(corners) - 0.5);
  double sum = 0;
  for (unsigned v = 0; v < 8; ++v) {
    double weight = heights[v];
    for (unsigned a = 0; a < 3; ++a) weight *= (v >> a & 1u) != 0 ? point[a] : 1.0 - point[a];
    sum += weight;
  }
  return sum;
}

TEST(CubeHeights, AreZeroAtTheLevelsOfRays) {
  const std::vector<std::uint32_t> ends = ends_of_rays();
  EXPECT_EQ(ends.size(), 26u);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::size_t inside = 0, clamped = 0;
  for (int i = 0; i < 20'000; ++i) {
    CubeHeights cube{{}, 0.0};
    for (double& h : cube.at) h = uniform(random);
    for (const std::uint32_t corners : ends) {
      const double level = cube.level(corners);
      ASSERT_GE(level, CubeHeights::kLeast);
      ASSERT_LE(level, 1.0 - CubeHeights::kLeast);
      ASSERT_EQ(level * 0x1p32, std::round(level * 0x1p32));
      const double centre = height_at(cube.at, corners, 0.0), end = height_at(cube.at, corners, 1.0);
      if (level > CubeHeights::kLeast && level < 1.0 - CubeHeights::kLeast) {
        ASSERT_NEAR(height_at(cube.at, corners, level), 0.0, 1e-8) << corners;
        ++inside;
      } else if ((centre < 0) != (end < 0)) {
        // the height changes its sign between the level and the near end of the ray
        const double at = height_at(cube.at, corners, level), near = level < 0.5 ? centre : end;
        ASSERT_TRUE((at < 0) != (near < 0) || std::abs(at) < 1e-6) << corners;
        ++clamped;
      }
      // beyond it the height keeps the sign of the end: everywhere on a ray to an edge, at fourths of one to a corner
      for (const double beyond : {0.25, 0.5, 0.75}) {
        const double x = std::popcount(corners) == 2 ? level + beyond * (1.0 - level) : beyond;
        if (std::popcount(corners) == 4 || level == CubeHeights::kLeast || level == 1.0 - CubeHeights::kLeast) continue;
        if (x <= level) continue;
        const double at = height_at(cube.at, corners, x);
        ASSERT_TRUE((at < 0) == (end < 0) || std::abs(at) < 1e-9) << corners;
      }
    }
  }
  EXPECT_GT(inside, 100'000u);
  EXPECT_GT(clamped, 1000u);
}

TEST(CubeHeights, HaveTheSameLevelsWithTheOppositeSign) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    CubeHeights cube{{}, 0.0}, opposite{{}, 0.0};
    for (std::size_t v = 0; v < 8; ++v) opposite.at[v] = -(cube.at[v] = uniform(random));
    for (const std::uint32_t corners : ends_of_rays()) ASSERT_EQ(cube.level(corners), opposite.level(corners));
  }
}

TEST(CubeHeights, KeepEpsilonFromBothEnds) {
  const std::array<double, 8> heights = {1e-9, -1, -1, -1, -1, -1, -1, -1}, others = {1, 1, 1, 1, -1, -1, -1, -0.99};
  for (const double epsilon : {0.01, 0.1, 0.4}) {
    const double least = std::max(epsilon, CubeHeights::kLeast);
    EXPECT_NEAR((CubeHeights{heights, epsilon}.level(1)), 1.0 - least, 1e-9);
    EXPECT_NEAR((CubeHeights{others, epsilon}.level(15)), least, 1e-9);
  }
}

TEST(CubeHeights, OfAnyMagnitudeHaveLevelsInside) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::array<double, 8> pattern = {2, -1, -1, -2, -1, -1, -1, 3};
  for (const double size : {1e-320, 1e-200, 1e-5, 1e30, 1e200, 1e308, kInfinity}) {
    CubeHeights cube{pattern, 0.0};
    for (double& h : cube.at) h *= size;
    for (const std::uint32_t corners : ends_of_rays()) {
      EXPECT_GE(cube.level(corners), CubeHeights::kLeast) << size << " " << corners;
      EXPECT_LE(cube.level(corners), 1.0 - CubeHeights::kLeast) << size << " " << corners;
    }
  }
  const CubeHeights zero{{}, 0.0};
  for (const std::uint32_t corners : ends_of_rays()) EXPECT_EQ(zero.level(corners), CubeHeights::kLeast);
}

/// The multilinear interpolant at a position on the ray from the centre to `end`.
template <int K>
double height_towards(const std::array<double, std::size_t{1} << K>& heights, const std::array<double, K>& end,
                      double level) {
  double sum = 0;
  for (std::size_t v = 0; v < heights.size(); ++v) {
    double weight = heights[v];
    for (std::size_t a = 0; a < K; ++a) {
      const double x = 0.5 + level * (end[a] - 0.5);
      weight *= (v >> a & 1u) != 0 ? x : 1.0 - x;
    }
    sum += weight;
  }
  return sum;
}

/// Random points in the boundary and corners. Counts the levels that are zeros.
template <int K>
void expect_zeros_at_levels() {
  std::mt19937 random(K);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::size_t inside = 0, with_opposite_ends = 0;
  double largest = 0, sum = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::array<double, std::size_t{1} << K> heights, opposite;
    for (std::size_t v = 0; v < heights.size(); ++v) heights[v] = uniform(random), opposite[v] = -heights[v];
    const TileHeights<K> tile(heights, 0.0), reversed(opposite, 0.0);
    std::array<double, K> end;
    const bool is_corner = i % 2 == 0;
    for (double& x : end) x = is_corner ? static_cast<double>(random() & 1u) : 0.5 + 0.5 * uniform(random);
    end[random() % K] = static_cast<double>(random() & 1u);
    const double level = tile.level(end);
    ASSERT_EQ(level, reversed.level(end));
    ASSERT_EQ(level, std::ldexp(std::round(std::ldexp(level, 32)), -32));
    ASSERT_GE(level, kLeastRayLevel);
    ASSERT_LE(level, 1.0 - kLeastRayLevel);
    const double at_centre = height_towards<K>(heights, end, 0.0), at_end = height_towards<K>(heights, end, 1.0);
    if (level > kLeastRayLevel && level < 1.0 - kLeastRayLevel) {
      ++inside;
      largest = std::max(largest, std::abs(height_towards<K>(heights, end, level)));
      sum += std::abs(height_towards<K>(heights, end, level));
    } else {
      // a zero beside an end, or no change of sign: then the end with the smaller height
      const double nearest = level < 0.5 ? at_centre : at_end;
      const double clamped = height_towards<K>(heights, end, level);
      EXPECT_TRUE(nearest * clamped <= 0 || (at_centre >= 0) == (at_end >= 0)) << level;
    }
    with_opposite_ends += (at_centre >= 0) != (at_end >= 0) ? 1 : 0;
  }
  EXPECT_GT(with_opposite_ends, 7'000u);
  EXPECT_GT(inside, with_opposite_ends * 9 / 10);
  // heights are up to 1
  EXPECT_LT(largest, 1e-3);
  EXPECT_LT(sum / static_cast<double>(inside), 1e-5);
}

TEST(TileHeights, AreZeroAtTheLevelsOfRays) {
  expect_zeros_at_levels<4>();
  expect_zeros_at_levels<5>();
}

TEST(TileHeights, OfManyRaysAreThoseOfEach) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < 20'000; ++i) {
    std::array<double, 16> heights;
    const auto kind = random() % 4;
    for (double& height : heights) {
      height = uniform(random);
      if (kind == 1) height = height < 0 ? -1.0 : 1.0;
      if (kind == 2) height = std::round(2.0 * height);
    }
    if (kind == 3 && i % 8 == 0) heights[random() % 16] = std::ldexp(uniform(random), 1023);
    if (kind == 3 && i % 16 == 1) heights[random() % 16] = std::numeric_limits<double>::infinity();
    const TileHeights<4> tile(heights, i % 3 == 0 ? 0.125 : 0.0);
    // to corners, and to other points of the boundary
    TesseractRays rays;
    std::vector<std::array<double, 4>> ends(1 + random() % (i % 64 == 0 ? TesseractRays::kMost : 20));
    for (auto& end : ends) {
      for (double& x : end) x = static_cast<double>(random() % 2);
      if (random() % 2 == 0)
        for (std::size_t a = 1; a < 4; ++a) end[(a + random() % 4) % 4] = 0.5 + 0.5 * uniform(random);
      rays.add(end);
    }
    tile.find_levels(rays);
    for (std::size_t r = 0; r < ends.size(); ++r)
      ASSERT_EQ(tile.level(ends[r]), rays.levels[r]) << "tile " << i << ", ray " << r;
  }
}

void expect_points_on_rays_of_each_tile() {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  RaysOfTiles rays;
  for (int i = 0; i < 500; ++i) {
    struct Tile {
      TileHeights<4> heights;
      TileBox box;
      std::vector<std::array<double, 4>> ends;
      std::size_t first;
    };
    std::vector<Tile> tiles;
    const double epsilon = i % 3 == 0 ? 0.125 : 0.0;
    // as many tiles as fit
    for (;;) {
      std::array<double, 16> heights;
      for (double& height : heights) height = uniform(random);
      if (random() % 16 == 0) heights[random() % 16] = std::numeric_limits<double>::infinity();
      TileBox box;
      for (std::size_t a = 0; a < 4; ++a) box.from[a] = 10 * uniform(random), box.to[a] = box.from[a] + uniform(random);
      std::vector<std::array<double, 4>> ends(1 + random() % (i % 16 == 0 ? TesseractRays::kMost : 20));
      if (!rays.has_room(ends.size())) break;
      tiles.push_back({TileHeights<4>(heights, epsilon), box, ends, 0});
      tiles.back().first = rays.next_place();
      rays.add(tiles.back().heights.products(), box, ends.size());
      for (std::size_t r = 0; r < ends.size(); ++r)
        for (std::size_t a = 0; a < 4; ++a) {
          const double end = random() % 2 == 0 ? static_cast<double>(random() % 2) : 0.5 + 0.5 * uniform(random);
          rays.ends[a][tiles.back().first + r] = tiles.back().ends[r][a] = end;
        }
    }
    place_on_rays(epsilon, rays);
    for (const Tile& tile : tiles)
      for (std::size_t r = 0; r < tile.ends.size(); ++r) {
        const double level = tile.heights.level(tile.ends[r]);
        for (std::size_t a = 0; a < 4; ++a) {
          const double from = tile.box.from[a], to = tile.box.to[a];
          const double x = 0.5 + level * (tile.ends[r][a] - 0.5);
          const double point = std::clamp(from + x * (to - from), std::min(from, to), std::max(from, to));
          ASSERT_EQ(x >= 1.0 ? to : point, rays.ends[a][tile.first + r]) << "case " << i << ", ray " << r;
        }
      }
    rays.clear();
  }
}

TEST(TileHeights, PointsOnRaysOfSeveralTilesAreThoseOfEach) {
  test::with_all_targets(expect_points_on_rays_of_each_tile);
}

/// Heights of kind 0 to 3: any; of one size; of few values; any, a few of them huge or infinite.
std::array<double, 8> random_heights(std::mt19937& random, unsigned kind) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::array<double, 8> heights;
  for (double& height : heights) {
    height = uniform(random);
    if (kind == 1) height = height < 0 ? -1.0 : 1.0;
    if (kind == 2) height = std::round(2.0 * height);
  }
  if (kind == 3 && random() % 8 == 0) heights[random() % 8] = std::ldexp(uniform(random), 1023);
  if (kind == 3 && random() % 16 == 0) heights[random() % 8] = std::numeric_limits<double>::infinity();
  return heights;
}

TEST(CubeHeights, OfManyRaysAreThoseOfEach) {
  std::mt19937 random(8);
  const std::vector<std::uint32_t> ends = ends_of_rays();
  for (int i = 0; i < 6'000; ++i) {
    const double epsilon = i % 3 == 0 ? 0.125 : 0.0;
    const unsigned corners = 1u << random() % 3;
    CubeRays rays;
    std::vector<double> expected;
    for (std::size_t wanted = 1 + random() % CubeRays::kMost; rays.count < wanted;) {
      const std::uint32_t end = ends[random() % ends.size()];
      if (std::popcount(end) != static_cast<int>(corners)) continue;
      const CubeHeights cube{random_heights(random, random() % 4), epsilon};
      expected.push_back(cube.level(end));
      rays.add(cube.at, end);
    }
    std::array<double, CubeRays::kMost> levels;
    cube_levels(rays, 3 - corners / 2, epsilon, levels);
    for (std::size_t r = 0; r < expected.size(); ++r)
      if (!std::isnan(expected[r])) {
        ASSERT_EQ(levels[r], expected[r]) << "rays to " << corners << " corners, " << i;
      }
  }
}

template <int K>
void expect_alphas_of_each_cell() {
  using Cells = CellsWithEdges<4, K>;
  constexpr unsigned kEdges = static_cast<unsigned>(K) << (K - 1);
  std::mt19937 random(9);
  for (unsigned kind = 0; kind < 4; ++kind) {
    std::vector<double> values;
    for (int i = 0; i < 64; ++i)
      for (const double height : random_heights(random, kind)) values.push_back(height);
    const Image<double, 4> image(values.data(), Grid<4>::unit({4, 4, 4, 8}));
    const ImageSource<double, 4> source(image, 0.0, 0.01);
    std::array<SampleIndex<4>, Cells::kMost> bases;
    std::array<std::uint32_t, Cells::kMost> edges;
    std::array<std::uint8_t, Cells::kMost> axes;
    for (unsigned trial = 0; trial < 20; ++trial) {
      std::size_t count = 0;
      for (; count < bases.size() - kind; ++count) {
        for (std::size_t& at : bases[count]) at = random() % 3;
        axes[count] = static_cast<std::uint8_t>(K == 4 ? 15u : 15u ^ 1u << random() % 4);
        std::array<double, std::size_t{1} << K> at_corners;
        source.corner_values(bases[count], axes[count], at_corners.data());
        edges[count] = 0;
        for (unsigned e = 0; e < kEdges; ++e) {
          const unsigned base = edge_base(K, e);
          const bool is_critical = (at_corners[base] >= 0) != (at_corners[base | 1u << (e >> (K - 1))] >= 0);
          edges[count] |= static_cast<std::uint32_t>(is_critical && random() % 4 != 0) << e;
        }
      }
      typename Cells::Alphas together;
      source.cells_alphas(Cells{axes.data(), bases.data(), edges.data(), count}, together);
      for (std::size_t i = 0; i < count; ++i) {
        std::array<double, kEdges> alone;
        source.cell_alphas(bases[i], axes[i], edges[i], alone.data());
        for (unsigned e = 0; e < kEdges; ++e)
          if ((edges[i] >> e & 1u) != 0) {
            ASSERT_EQ(together[e][i], alone[e]) << "cell " << i << ", edge " << e;
          }
      }
    }
  }
}

TEST(CellsAlphas, AreThoseOfEachCell) {
  expect_alphas_of_each_cell<3>();
  expect_alphas_of_each_cell<4>();
}

TEST(TileHeights, KeepEpsilonFromBothEndsAndAreHalfWayIfInfinite) {
  std::array<double, 16> heights;
  heights.fill(-1.0);
  heights[0] = 1e-9;  // the zero is beside the corner
  const std::array<double, 4> corner{};
  EXPECT_NEAR(TileHeights<4>(heights, 0.0).level(corner), 31.0 / 32, 1e-9);
  EXPECT_NEAR(TileHeights<4>(heights, 0.125).level(corner), 0.875, 1e-9);
  heights[0] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(TileHeights<4>(heights, 0.0).level(corner), 0.5);
}

}  // namespace
}  // namespace tegl::detail
