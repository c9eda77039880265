// SPDX-License-Identifier: BSD-3-Clause
//
// Points of the contour on the rays from the centres of several 4D tiles, in the lanes of registers. The searches in
// several registers take turns, as each step of one waits for the step before.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tegl::detail {

/// Two opposite corners of a tile, by axis.
struct TileBox {
  std::array<double, 4> from, to;
};

/// Rays of tiles in groups of kGroup places. A group has rays of one tile; its last places may be unused.
struct RaysOfTiles {
  static constexpr std::size_t kGroup = 8, kMostGroups = 32;
  static constexpr std::size_t kMost = kGroup * kMostGroups;  ///< places
  struct Tile {
    alignas(64) std::array<double, 16> products;
    TileBox box;
  };

  std::size_t groups = 0, tiles = 0;
  std::array<std::uint8_t, kMostGroups> tile_of, rays_in;  ///< by group: number of its tile, and of its rays
  std::array<Tile, kMostGroups> of_tiles;
  /// By axis: the ends of rays, in the unit tile. `place_on_rays` replaces them by the points. Finite, also at places
  /// without a ray.
  alignas(64) std::array<std::array<double, kMost>, 4> ends{};

  /// Whether there is room for a tile with `count` rays.
  [[nodiscard]] bool has_room(std::size_t count) const noexcept {
    return groups + (count + kGroup - 1) / kGroup <= kMostGroups;
  }
  /// The place of the first ray of the tile that is added next; its others follow.
  [[nodiscard]] std::size_t next_place() const noexcept { return groups * kGroup; }
  /// Adds a tile with `count` rays, at least one. `products`: of TileHeights.
  void add(const std::array<double, 16>& products, const TileBox& box, std::size_t count) noexcept {
    of_tiles[tiles].products = products;
    of_tiles[tiles].box = box;
    for (; count > kGroup; count -= kGroup) add_group(kGroup);
    add_group(count);
    ++tiles;
  }
  void clear() noexcept { groups = tiles = 0; }

 private:
  void add_group(std::size_t rays) noexcept {
    tile_of[groups] = static_cast<std::uint8_t>(tiles);
    rays_in[groups++] = static_cast<std::uint8_t>(rays);
  }
};

/// Replaces the ends of rays by the points at their levels (TileHeights<4>::level), in the box of their tile: equal to
/// Placement::Cell of ray_coordinate.
void place_on_rays(double epsilon, RaysOfTiles& rays) noexcept;

}  // namespace tegl::detail
