// SPDX-License-Identifier: BSD-3-Clause
//
// Ranges of all tiles of an image in memory, with a margin of constant tiles. So every tile has all its neighbours,
// each at a fixed distance, and loops need no border tests.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "search/sample_view.hpp"
#include "tegl/active_tiles.hpp"
#include "tegl/seed_set.hpp"

namespace tegl::detail {

/// Unsigned integer type with the order of the values. Algorithms on ranges are instantiated for four key types
/// instead of seven value types.
template <Value T>
using KeyOf = std::conditional_t<sizeof(T) == 1, std::uint8_t,
                                 std::conditional_t<sizeof(T) == 2, std::uint16_t,
                                                    std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;

/// -0 and 0 have the same key. NaN has none.
template <Value T>
KeyOf<T> key_of(T value) noexcept;
template <Value T>
T value_of(KeyOf<T> key) noexcept;

/// Place of a tile in the padded arrays, below 2^32.
using Place = std::uint32_t;

/// A step from a tile to a neighbour: -1, 0 or 1 along every axis.
using Step = std::array<std::int8_t, kMostAxes>;
/// The steps of a neighbourhood in `dim` dimensions, in scan order, the first axis fastest.
std::vector<Step> neighbour_steps(int dim, Neighbourhood neighbourhood);

/// Numbering of tiles with a margin: axis 0 fastest, one place more along every axis than there are tiles, and a margin
/// before and after.
class PaddedTiles {
 public:
  /// Throws TooLarge for 2^32 places or more.
  PaddedTiles(std::span<const std::size_t> tiles);

  [[nodiscard]] int dim() const noexcept { return dim_; }
  [[nodiscard]] std::size_t size(int axis) const noexcept { return sizes_[axis]; }
  [[nodiscard]] std::ptrdiff_t step(int axis) const noexcept { return steps_[axis]; }
  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }
  [[nodiscard]] std::size_t room() const noexcept { return room_; }
  /// Place of the first tile of a row (a line along axis 0); rows are in the order of TileGrid.
  [[nodiscard]] Place row_place(std::size_t row) const noexcept;
  [[nodiscard]] TileNumber number(Place place) const noexcept;
  [[nodiscard]] Place place(TileNumber number) const noexcept;
  [[nodiscard]] std::array<std::size_t, kMostAxes> index(Place place) const noexcept;

  /// Distances to the neighbours in scan order, the first axis of `order` fastest.
  [[nodiscard]] std::vector<std::ptrdiff_t> neighbours(Neighbourhood neighbourhood, std::span<const int> order) const;
  [[nodiscard]] std::vector<std::ptrdiff_t> neighbours(Neighbourhood neighbourhood) const;

  /// Calls visit(place) for all tiles, the first axis of `order` fastest.
  template <class Visit>
  void scan(std::span<const int> order, const Visit& visit) const {
    if (rows_ == 0) return;
    std::array<std::size_t, kMostAxes> at{};
    const std::size_t count = sizes_[order[0]];
    const std::ptrdiff_t step = steps_[order[0]];
    for (std::ptrdiff_t line = static_cast<std::ptrdiff_t>(lead_);;) {
      for (std::size_t i = 0; i < count; ++i) visit(static_cast<Place>(line + static_cast<std::ptrdiff_t>(i) * step));
      int k = 1;
      for (; k < dim_; ++k) {
        const int axis = order[k];
        line += steps_[axis];
        if (++at[axis] < sizes_[axis]) break;
        line -= steps_[axis] * static_cast<std::ptrdiff_t>(sizes_[axis]);
        at[axis] = 0;
      }
      if (k == dim_) return;
    }
  }

 private:
  int dim_ = 0;
  std::array<std::size_t, kMostAxes> sizes_{};
  std::array<std::ptrdiff_t, kMostAxes> steps_{};
  std::size_t rows_ = 0;
  std::size_t lead_ = 0;
  std::size_t room_ = 0;
};

/// Axes 0, 1, ... of an image.
std::vector<int> default_order(int dim);

/// The range (least, greatest] of every tile, which is active if least < T <= greatest. Both are 0 in the margin and
/// for tiles with a missing corner.
template <class Key>
struct RangeMap {
  PaddedTiles tiles;
  std::vector<Key> least, greatest;

  [[nodiscard]] bool constant(Place tile) const noexcept { return least[tile] == greatest[tile]; }
  [[nodiscard]] bool same(Place a, Place b) const noexcept {
    return least[a] == least[b] && greatest[a] == greatest[b];
  }
  [[nodiscard]] Key width(Place tile) const noexcept { return static_cast<Key>(greatest[tile] - least[tile]); }
  /// Whether the range of a is a proper subset of the range of b.
  [[nodiscard]] bool inside(Place a, Place b) const noexcept {
    return least[b] <= least[a] && greatest[a] <= greatest[b] && !same(a, b);
  }
  [[nodiscard]] bool overlap(Place a, Place b) const noexcept {
    return (least[a] < least[b] ? least[b] : least[a]) < (greatest[a] < greatest[b] ? greatest[a] : greatest[b]);
  }
};

/// Computes the ranges with `threads` threads. Errors: TooLarge, Cancelled.
template <Value T>
RangeMap<KeyOf<T>> map_ranges(const SampleView<T>& samples, unsigned threads, const Progress& progress);

}  // namespace tegl::detail
