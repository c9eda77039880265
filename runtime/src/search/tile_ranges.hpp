// SPDX-License-Identifier: BSD-3-Clause
//
// The least and the greatest value of every tile, row by row: what all indexes of active tiles are made from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tegl/active_tiles.hpp"

namespace tegl::detail {

/// Whether a range (least, greatest] has values in it: only then is the tile active at some isovalue.
template <Value T>
[[nodiscard]] constexpr bool has_range(T least, T greatest) noexcept {
  return least < greatest;
}

/// Goes through the ranges of an image's tiles. One for each thread: it keeps room for a row. The values must outlive
/// it.
template <Value T, int N>
class TileRanges {
 public:
  explicit TileRanges(const Image<T, N>& image);

  [[nodiscard]] const TileGrid<N>& grid() const noexcept { return grid_; }
  /// Makes `least` and `greatest` those of a row of tiles. A tile with a missing corner gets an empty range, 0 and 0.
  void load(std::size_t row) noexcept;
  /// size(0) values each.
  [[nodiscard]] const T* least() const noexcept { return least_.data(); }
  [[nodiscard]] const T* greatest() const noexcept { return greatest_.data(); }

 private:
  void merge(const T* samples) noexcept;
  void leave_out_missing() noexcept;

  static constexpr unsigned kRows = 1u << (N - 1);  ///< of samples around a row of tiles

  Image<T, N> image_;
  TileGrid<N> grid_;
  std::array<const T*, kRows> rows_{};
  std::vector<T> least_, greatest_, gathered_;
  bool missing_ = false;
};

}  // namespace tegl::detail
