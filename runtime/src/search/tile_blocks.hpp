// SPDX-License-Identifier: BSD-3-Clause
//
// Blocks of tiles that fit in the cache, for seed_regions.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/workers.hpp"
#include "search/padded_ranges.hpp"

namespace tegl::detail {

/// The division of all tiles into blocks that fit in the cache, and the numbering of the tiles of a block and its
/// margin, the box: axis 0 fastest, the same for all blocks.
class BlockGrid {
 public:
  using Coordinates = std::array<std::size_t, kMostAxes>;
  /// A way around a link: distances from the tile to two neighbouring tiles, or twice to the same. At levels at which
  /// both are active, they connect the tile to the neighbour ahead.
  struct Detour {
    std::ptrdiff_t by, and_by;
  };
  /// A neighbour ahead, and the detours to it. Across an edge or a corner: by a tile between, to which the step along
  /// some of its axes leads. Across a face: by the two tiles one step ahead along a higher axis. A detour may consist
  /// of superfluous links, but their own detours have links across fewer axes, or across a face of a higher axis, or
  /// farther ahead. So this ends, and some connection has all its links.
  struct Ahead {
    std::ptrdiff_t distance;
    std::vector<Detour> detours;
  };
  /// A tile in the margin of a box, which belongs to an earlier block.
  struct Earlier {
    std::uint32_t tile;
    std::size_t blocks_back;  ///< number of the block minus the number of the earlier one
  };

  /// `face_detours`: whether neighbours across faces have detours.
  BlockGrid(const PaddedTiles& tiles, Neighbourhood neighbourhood, bool face_detours)
      : tiles_(tiles),
        neighbourhood_(neighbourhood),
        dim_(tiles.dim()),
        width_(kWidth[static_cast<std::size_t>(tiles.dim())]) {
    Coordinates counts{};
    std::array<std::size_t, kMostAxes> axes{};
    for (int a = 0; a < dim_; ++a) {
      axes[a] = width_;
      steps_[a] = a == 0 ? 1 : steps_[a - 1] * (width_ + 2);
      counts[a] = block_count(tiles.size(a), width_);
      count_ *= counts[a];
    }
    room_ = steps_[dim_ - 1] * (width_ + 2);
    find_places();
    find_neighbours(neighbourhood, face_detours);
    find_earlier(counts);
    order_blocks(counts);
  }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::size_t room() const noexcept { return room_; }  ///< number of tiles of a box
  [[nodiscard]] int dim() const noexcept { return dim_; }
  [[nodiscard]] Neighbourhood neighbourhood() const noexcept { return neighbourhood_; }
  [[nodiscard]] std::size_t width() const noexcept { return width_; }
  [[nodiscard]] std::size_t step(int axis) const noexcept { return steps_[axis]; }  ///< in a box
  [[nodiscard]] std::span<const std::size_t> steps() const noexcept {
    return {steps_.data(), static_cast<std::size_t>(dim_)};
  }
  [[nodiscard]] std::size_t size(int axis) const noexcept { return tiles_.size(axis); }
  /// Number of neighbours across faces.
  [[nodiscard]] std::size_t faces() const noexcept { return 2 * static_cast<std::size_t>(dim_); }
  /// Distances in a box; neighbours across faces first.
  [[nodiscard]] const std::vector<std::ptrdiff_t>& neighbours() const noexcept { return neighbours_; }
  /// One of each pair of opposite neighbours.
  [[nodiscard]] const std::vector<Ahead>& ahead() const noexcept { return ahead_; }
  [[nodiscard]] const std::vector<Earlier>& earlier() const noexcept { return earlier_; }
  /// The blocks, in groups: a block depends only on blocks of earlier groups.
  [[nodiscard]] const std::vector<std::vector<std::size_t>>& groups() const noexcept { return groups_; }

  /// The first tile of a block.
  [[nodiscard]] Coordinates first(std::size_t block) const noexcept {
    Coordinates first{};
    for (int a = 0; a < dim_; ++a) {
      const std::size_t count = block_count(tiles_.size(a), width_);
      first[a] = block % count * width_;
      block /= count;
    }
    return first;
  }
  /// Whether a block has the full width along all axes.
  [[nodiscard]] bool is_whole(const Coordinates& first) const noexcept {
    for (int a = 0; a < dim_; ++a)
      if (tiles_.size(a) - first[a] < width_) return false;
    return true;
  }
  /// Places of the tiles of a box, minus the box's origin.
  [[nodiscard]] const std::vector<Place>& places() const noexcept { return places_; }
  /// Place of the first tile of a box, in its margin.
  [[nodiscard]] Place origin(const Coordinates& first) const noexcept {
    std::ptrdiff_t origin = static_cast<std::ptrdiff_t>(tiles_.row_place(0));
    for (int a = 0; a < dim_; ++a) origin += (static_cast<std::ptrdiff_t>(first[a]) - 1) * tiles_.step(a);
    return static_cast<Place>(origin);
  }
  /// Calls visit(tile of the box, place, length) for the lines of a box along axis 0 that have tiles or a margin.
  template <class Visit>
  void for_lines(const Coordinates& first, const Visit& visit) const {
    const Place corner = origin(first);
    Coordinates at{};
    const auto length = [&](int a) { return std::min(width_, tiles_.size(a) - first[a]) + 2; };
    for (int axis = 0; axis < dim_;) {
      std::size_t tile = 0;
      for (int a = 1; a < dim_; ++a) tile += at[a] * steps_[a];
      visit(tile, static_cast<Place>(corner + places_[tile]), length(0));
      for (axis = 1; axis < dim_; ++axis) {
        if (++at[axis] < length(axis)) break;
        at[axis] = 0;
      }
    }
  }

 private:
  static constexpr std::array<std::size_t, kMostAxes + 1> kWidth = {1, 4096, 64, 16, 8, 6};

  void find_places() {
    for (std::size_t tile = 0; tile < room_; ++tile) {
      std::ptrdiff_t place = 0;
      for (int a = 0; a < dim_; ++a)
        place += static_cast<std::ptrdiff_t>(tile / steps_[a] % (width_ + 2)) * tiles_.step(a);
      places_.push_back(static_cast<Place>(place));
    }
  }
  void find_neighbours(Neighbourhood neighbourhood, bool face_detours) {
    const auto moved = [](const Step& step) {
      return std::count_if(step.begin(), step.end(), [](int to) { return to != 0; });
    };
    std::vector<Step> steps = neighbour_steps(dim_, neighbourhood);
    std::stable_sort(steps.begin(), steps.end(), [&](const Step& a, const Step& b) { return moved(a) < moved(b); });
    for (const Step& step : steps) {
      std::vector<std::ptrdiff_t> parts = {0};  // distances of all parts of the step, the whole last
      for (int a = 0; a < dim_; ++a) {
        if (step[a] == 0) continue;
        const std::size_t count = parts.size();
        for (std::size_t i = 0; i < count; ++i)
          parts.push_back(parts[i] + step[a] * static_cast<std::ptrdiff_t>(steps_[a]));
      }
      const std::ptrdiff_t distance = parts.back();
      neighbours_.push_back(distance);
      if (distance <= 0) continue;
      std::vector<Detour> detours;
      for (std::size_t i = 1; i + 1 < parts.size(); ++i) detours.push_back({parts[i], parts[i]});
      if (face_detours && parts.size() == 2)
        for (int a = dim_; a-- > 0 && step[a] == 0;) {
          const auto aside = static_cast<std::ptrdiff_t>(steps_[a]);
          detours.push_back({aside, aside + distance});
        }
      ahead_.push_back({distance, std::move(detours)});
    }
  }
  void find_earlier(const Coordinates& counts) {
    for (std::size_t tile = 0; tile < room_; ++tile) {
      std::ptrdiff_t back = 0;
      bool is_earlier =
          false;  // decided by the last axis along which the tile is outside, as the numbers of blocks are
      std::size_t rest = tile;
      std::ptrdiff_t of_axis = 1;
      for (int a = 0; a < dim_; ++a) {
        const std::size_t at = rest % (width_ + 2);
        rest /= width_ + 2;
        if (at == 0 || at == width_ + 1) is_earlier = at == 0;
        back += at == 0 ? of_axis : at == width_ + 1 ? -of_axis : 0;
        of_axis *= static_cast<std::ptrdiff_t>(counts[a]);
      }
      if (is_earlier) earlier_.push_back({static_cast<std::uint32_t>(tile), static_cast<std::size_t>(back)});
    }
  }
  /// By the sum of 2^a times the coordinate along axis a, which is smaller for every adjacent block with a lower
  /// number.
  void order_blocks(const Coordinates& counts) {
    for (std::size_t block = 0; block < count_; ++block) {
      std::size_t group = 0;
      std::size_t rest = block;
      for (int a = 0; a < dim_; ++a) {
        group += (rest % counts[a]) << a;
        rest /= counts[a];
      }
      if (groups_.size() <= group) groups_.resize(group + 1);
      groups_[group].push_back(block);
    }
  }

  const PaddedTiles& tiles_;
  Neighbourhood neighbourhood_;
  int dim_;
  std::size_t width_;
  std::size_t count_ = 1;
  std::size_t room_ = 0;
  std::array<std::size_t, kMostAxes> steps_{};
  std::vector<Place> places_;
  std::vector<std::ptrdiff_t> neighbours_;
  std::vector<Ahead> ahead_;
  std::vector<Earlier> earlier_;
  std::vector<std::vector<std::size_t>> groups_;
};

/// Numbers of roots outside of a block, from a first number on, in the order in which they come.
class OutsideRoots {
 public:
  explicit OutsideRoots(std::size_t first) : first_(first), slots_(256) {}

  void clear() {
    places_.clear();
    std::fill(slots_.begin(), slots_.end(), 0);
  }
  std::uint32_t operator()(Place place) {
    if (2 * places_.size() >= slots_.size()) grow();
    std::uint32_t& slot = slot_of(place);
    if (slot == 0) {
      places_.push_back(place);
      slot = static_cast<std::uint32_t>(places_.size());
    }
    return static_cast<std::uint32_t>(first_ + slot - 1);
  }
  [[nodiscard]] Place place(std::uint32_t number) const noexcept { return places_[number - first_]; }
  [[nodiscard]] std::size_t size() const noexcept { return places_.size(); }

 private:
  /// The slot of a place, or the free one that it takes.
  std::uint32_t& slot_of(Place place) noexcept {
    std::size_t at = (place * 0x9e3779b1u >> 8) & (slots_.size() - 1);
    while (slots_[at] != 0 && places_[slots_[at] - 1] != place) at = (at + 1) & (slots_.size() - 1);
    return slots_[at];
  }
  void grow() {
    slots_.assign(2 * slots_.size(), 0);
    for (std::size_t i = 0; i < places_.size(); ++i) slot_of(places_[i]) = static_cast<std::uint32_t>(i + 1);
  }

  std::size_t first_;
  std::vector<Place> places_;
  std::vector<std::uint32_t> slots_;  ///< position in `places_` plus 1; 0: empty
};

}  // namespace tegl::detail
