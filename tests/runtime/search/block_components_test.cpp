// SPDX-License-Identifier: BSD-3-Clause
//
// Roots of components of the tiles of a block, against a search at each level, and the tiles around each tile on all
// instruction sets.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "levels/block_components.hpp"
#include "only_targets.hpp"

namespace tegl::test {
namespace {

using detail::BlockComponents;
using Tile = BlockComponents::Tile;

/// The tiles of a block with a margin of one tile, by the ranges of their corners.
struct RangesOfBlock {
  /// `value(x, y, z)`: the corners.
  template <class Value>
  RangesOfBlock(const std::vector<std::size_t>& sizes, const Value& value) {
    std::size_t room = 1;
    for (const std::size_t size : sizes) {
      steps.push_back(room);
      room *= size + 2;
    }
    least.resize(room);
    greatest.resize(room);
    const std::size_t depth = sizes.size() > 2 ? sizes[2] : 1;
    for (std::size_t z = 0; z < depth; ++z)
      for (std::size_t y = 0; y < sizes[1]; ++y) {
        const std::size_t first = 1 + steps[1] * (y + 1) + (sizes.size() > 2 ? steps[2] * (z + 1) : 0);
        rows.emplace_back(static_cast<Tile>(first), static_cast<std::uint32_t>(sizes[0]));
        for (std::size_t x = 0; x < sizes[0]; ++x) {
          std::uint32_t low = ~0u, high = 0;
          for (std::size_t corner = 0; corner < (sizes.size() > 2 ? 8u : 4u); ++corner) {
            const std::uint32_t at = value(x + corner % 2, y + corner / 2 % 2, z + corner / 4);
            low = std::min(low, at);
            high = std::max(high, at);
          }
          least[first + x] = low;
          greatest[first + x] = high;
          if (low < high) tiles.push_back(static_cast<Tile>(first + x));
        }
      }
  }
  [[nodiscard]] bool is_active(std::size_t tile, std::uint32_t level) const {
    return least[tile] < level && level <= greatest[tile];
  }

  std::vector<std::size_t> steps;
  std::vector<std::uint32_t> least, greatest;
  std::vector<Tile> tiles;
  std::vector<BlockComponents::Row> rows;
};

/// Distances to the neighbours, by definition: at most `moved` axes differ, by one.
std::vector<std::ptrdiff_t> distances_of(const std::vector<std::size_t>& steps, int moved) {
  std::vector<std::ptrdiff_t> result;
  for (int code = 0; code < (steps.size() > 2 ? 27 : 9); ++code) {
    const std::array<int, 3> step = {code % 3 - 1, code / 3 % 3 - 1, steps.size() > 2 ? code / 9 - 1 : 0};
    const auto axes = std::count_if(step.begin(), step.end(), [](int to) { return to != 0; });
    if (axes == 0 || axes > moved) continue;
    std::ptrdiff_t distance = 0;
    for (std::size_t a = 0; a < steps.size(); ++a) distance += step[a] * static_cast<std::ptrdiff_t>(steps[a]);
    result.push_back(distance);
  }
  return result;
}

/// At every level: each active tile has one root, which is active and in its component, and a component has one root.
/// Returns the number of roots.
std::size_t expect_one_root_of_each_component(const RangesOfBlock& block, Neighbourhood neighbourhood, int moved) {
  const auto distances = distances_of(block.steps, moved);
  BlockComponents components(block.least.size(), block.steps, neighbourhood, distances);
  EXPECT_TRUE(components.find(block.least.data(), block.greatest.data(), block.tiles, block.rows));
  // by level: the root of each active tile
  std::map<std::uint32_t, std::map<Tile, Tile>> roots;
  for (const Tile tile : block.tiles) roots[block.greatest[tile]];
  for (const Tile tile : block.tiles) {
    std::uint32_t from = block.least[tile];
    components.for_roots(tile, [&](Tile root, const detail::TileEvents::Event& event) {
      const std::uint32_t to = event.leaves ? block.greatest[event.tile] : block.least[event.tile];
      for (auto level = roots.upper_bound(from); level != roots.end() && level->first <= to; ++level)
        EXPECT_TRUE(level->second.emplace(tile, root).second);
      from = to;
    });
    EXPECT_EQ(from, block.greatest[tile]);
  }
  for (const auto& [level, of_tile] : roots) {
    std::map<Tile, Tile> first_of_root;
    std::map<Tile, Tile> component;
    for (const Tile tile : block.tiles) {
      EXPECT_EQ(block.is_active(tile, level), of_tile.contains(tile));
      if (!block.is_active(tile, level) || component.contains(tile)) continue;
      const Tile root = of_tile.at(tile);
      EXPECT_TRUE(block.is_active(root, level));
      EXPECT_TRUE(std::binary_search(components.roots().begin(), components.roots().end(), root));
      EXPECT_TRUE(first_of_root.emplace(root, tile).second) << "two components have root " << root;
      component[tile] = tile;
      for (std::vector<Tile> open{tile}; !open.empty();) {
        const Tile next = open.back();
        open.pop_back();
        EXPECT_EQ(of_tile.at(next), root) << "tile " << next << " at level " << level;
        for (const std::ptrdiff_t distance : distances) {
          const auto other = static_cast<Tile>(next + distance);
          if (block.is_active(other, level) && component.emplace(other, tile).second) open.push_back(other);
        }
      }
      EXPECT_TRUE(component.contains(root)) << "root " << root << " of another component";
    }
  }
  return components.roots().size();
}

/// All neighbourhoods, with the number of axes along which neighbours differ.
std::vector<std::pair<Neighbourhood, int>> neighbourhoods_of(std::size_t dim) {
  return {{Neighbourhood::faces, 1},
          {Neighbourhood::faces_and_edges, dim > 2 ? 2 : 1},
          {Neighbourhood::all, static_cast<int>(dim)}};
}

TEST(BlockComponents, OfNoiseHaveOneRootAtEveryLevel) {
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    std::mt19937 random(seed);
    const std::uint32_t values = seed % 3 == 0 ? 4 : seed % 3 == 1 ? 40 : 1u << 31;
    const std::vector<std::size_t> sizes =
        seed % 2 == 0 ? std::vector<std::size_t>{13, 11} : std::vector<std::size_t>{6, 5, 4};
    const auto drawn = [&](std::size_t, std::size_t, std::size_t) { return std::uint32_t(random() % values); };
    std::map<std::array<std::size_t, 3>, std::uint32_t> corners;
    const RangesOfBlock block(sizes, [&](std::size_t x, std::size_t y, std::size_t z) {
      const auto [corner, is_new] = corners.try_emplace({x, y, z}, 0);
      if (is_new) corner->second = drawn(x, y, z);
      return corner->second;
    });
    for (const auto& [neighbourhood, moved] : neighbourhoods_of(sizes.size())) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", neighbours differ along " + std::to_string(moved));
      EXPECT_GT(expect_one_root_of_each_component(block, neighbourhood, moved), std::size_t{0});
    }
  }
}

TEST(BlockComponents, OfWavesHaveOneRootAtEveryLevel) {
  // Sheets that are divided and joined; the parts of some meet far from the tile that leaves.
  const RangesOfBlock block({15, 14, 13}, [](std::size_t x, std::size_t y, std::size_t z) {
    const double u = 0.5 * static_cast<double>(x), v = 0.6 * static_cast<double>(y), w = 0.7 * static_cast<double>(z);
    const double sum = std::sin(u) * std::cos(v) + std::sin(v) * std::cos(w) + std::sin(w) * std::cos(u);
    return static_cast<std::uint32_t>(500.0 + 150.0 * sum);
  });
  for (const auto& [neighbourhood, moved] : neighbourhoods_of(3))
    EXPECT_LT(expect_one_root_of_each_component(block, neighbourhood, moved), block.tiles.size() / 20);
}

TEST(BlockComponents, OfARampHaveTheFewestRoots) {
  // Tile x has the levels x + 1 to x + 3, so every third tile is a root.
  const RangesOfBlock block({30, 4, 3}, [](std::size_t x, std::size_t y, std::size_t z) {
    return static_cast<std::uint32_t>(x + (y + z) % 2 + (y * z) % 2);
  });
  for (const auto& [neighbourhood, moved] : neighbourhoods_of(3)) {
    const std::uint32_t most = *std::max_element(block.greatest.begin(), block.greatest.end());
    std::uint32_t widest = 0;
    for (const Tile tile : block.tiles) widest = std::max(widest, block.greatest[tile] - block.least[tile]);
    EXPECT_EQ(expect_one_root_of_each_component(block, neighbourhood, moved), (most + widest - 1) / widest);
  }
}

/// The neighbours among the active tiles around a tile, and kApart if these do not connect them, by definition.
std::uint32_t around_by_definition(std::uint32_t active, int dim, int moved) {
  const auto steps_between = [](int a, int b) {
    const std::array<int, 3> apart = {std::abs(a % 3 - b % 3), std::abs(a / 3 % 3 - b / 3 % 3),
                                      std::abs(a / 9 - b / 9)};
    return std::pair(*std::max_element(apart.begin(), apart.end()),
                     static_cast<int>(std::count_if(apart.begin(), apart.end(), [](int by) { return by != 0; })));
  };
  const auto are_neighbours = [&](int a, int b) {
    const auto [farthest, axes] = steps_between(a, b);
    return farthest == 1 && axes <= moved;
  };
  const int self = detail::bit_of_step(0, 0, 0);
  std::uint32_t ends = 0;
  for (int bit = dim == 2 ? 9 : 0; bit < (dim == 2 ? 18 : 27); ++bit)
    if ((active >> bit & 1u) != 0 && are_neighbours(self, bit)) ends |= 1u << bit;
  std::uint32_t reached = ends & -ends;
  for (bool more = true; more;) {
    more = false;
    for (int a = 0; a < 27; ++a)
      for (int b = 0; b < 27; ++b)
        if ((reached >> a & 1u) != 0 && (active >> b & 1u) != 0 && (reached >> b & 1u) == 0 && are_neighbours(a, b)) {
          reached |= 1u << b;
          more = true;
        }
  }
  return (ends & ~reached) == 0 ? ends : ends | detail::kApart;
}

TEST(TilesAround, AreThoseByDefinitionOnAllInstructionSets) {
  for (const int dim : {2, 3}) {
    const std::vector<std::size_t> steps =
        dim == 2 ? std::vector<std::size_t>{1, 70} : std::vector<std::size_t>{1, 30, 150};
    const std::size_t first = dim == 2 ? 71 : 181, room = 2 * first + 80;
    std::mt19937 random(static_cast<unsigned>(dim));
    std::vector<std::int32_t> enter(room), leave(room);
    std::vector<std::int32_t> order(2 * room);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    for (std::size_t i = 0; i < room; ++i) std::tie(enter[i], leave[i]) = std::minmax(order[2 * i], order[2 * i + 1]);
    std::vector<detail::TileAround> around;
    for (int code = dim == 2 ? 9 : 0; code < (dim == 2 ? 18 : 27); ++code) {
      const std::ptrdiff_t distance = (code % 3 - 1) + (code / 3 % 3 - 1) * static_cast<std::ptrdiff_t>(steps[1]) +
                                      (dim == 2 ? 0 : (code / 9 - 1) * static_cast<std::ptrdiff_t>(steps.back()));
      if (distance != 0) around.push_back({distance, static_cast<std::uint32_t>(code)});
    }
    const auto expected = [&](std::size_t tile, std::int32_t now, int moved) {
      std::uint32_t active = 0;
      for (const auto& other : around) {
        const std::size_t at = tile + static_cast<std::size_t>(other.distance);
        if (enter[at] < now && now < leave[at]) active |= 1u << other.bit;
      }
      return around_by_definition(active, dim, moved);
    };
    for (const auto& [neighbourhood, moved] : neighbourhoods_of(static_cast<std::size_t>(dim))) {
      const std::uint32_t neighbours = around_by_definition((1u << 27) - 1, dim, moved) & ~detail::kApart;
      // In 2D both are the same, and the function takes `faces`.
      const Neighbourhood kind = dim == 2 && moved == 1 ? Neighbourhood::faces : neighbourhood;
      std::size_t apart = 0;
      for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
        const OnlyTargets only(left & -left);
        for (const std::size_t count : {1, 5, 16, 29}) {
          std::vector<std::uint32_t> at_enter(count + detail::kEventsBeyond), at_leave(count + detail::kEventsBeyond);
          detail::find_tiles_around({&enter[first], &leave[first], at_enter.data(), at_leave.data()}, count, around,
                                    neighbours, kind);
          for (std::size_t i = 0; i < count; ++i) {
            ASSERT_EQ(at_enter[i], expected(first + i, enter[first + i], moved)) << dim << " " << moved << " " << i;
            ASSERT_EQ(at_leave[i], expected(first + i, leave[first + i], moved)) << dim << " " << moved << " " << i;
            apart += at_enter[i] >> 31;
          }
        }
      }
      EXPECT_GT(apart, std::size_t{0});
    }
  }
}

}  // namespace
}  // namespace tegl::test
