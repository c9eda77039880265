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
  static constexpr std::size_t kGroup = 8, kMostGroups = 32, kMostTiles = 16;
  static constexpr std::size_t kMost = kGroup * kMostGroups;  ///< places

  std::size_t groups = 0, tiles = 0;
  std::array<std::uint8_t, kMostGroups> tile_of, rays_in;  ///< by group: number of its tile, and of its rays
  std::array<TileBox, kMostTiles> boxes;
  /// By corner and tile: samples. Those of tiles from `tiles` on do not matter.
  alignas(64) std::array<std::array<double, kMostTiles>, 16> samples{};
  /// By place: the corner that the ray ends at, as a bit, or 0.
  alignas(64) std::array<std::uint64_t, kMost> corners{};
  /// By axis: the ends of rays that end at no corner, in the unit tile. `place_on_rays` writes the points of all.
  /// Finite, also at places without a ray.
  alignas(64) std::array<std::array<double, kMost>, 4> ends{};

  /// Whether there is room for a tile with `count` rays.
  [[nodiscard]] bool has_room(std::size_t count) const noexcept {
    return tiles < kMostTiles && groups + (count + kGroup - 1) / kGroup <= kMostGroups;
  }
  /// The place of the first ray of the tile that is added next; its others follow.
  [[nodiscard]] std::size_t next_place() const noexcept { return groups * kGroup; }
  /// Adds a tile with `count` rays, at least one. The tile's samples and box are those of number `tiles`.
  void add(std::size_t count) noexcept {
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

/// Points in boxes.
struct PointsInBoxes {
  static constexpr std::size_t kMost = 16;
  /// By axis and point: two opposite corners of the box; position between them, from 0 to 1. Finite, also from `count`
  /// on.
  alignas(64) std::array<std::array<double, kMost>, 4> from{}, to{}, at{};
  alignas(64) std::array<std::array<double, 4>, kMost> points;  ///< by point; set by `place_in_boxes`
};

/// Places `count` points in their boxes, as Placement::Cell does. Also sets other entries of `points`.
void place_in_boxes(std::size_t count, PointsInBoxes& points) noexcept;

/// Sets the points at the levels of rays (TileHeights<4>::level), in the box of their tile: equal to Placement::Cell of
/// ray_coordinate. They replace `ends`.
void place_on_rays(double isovalue, double epsilon, RaysOfTiles& rays) noexcept;

}  // namespace tegl::detail
