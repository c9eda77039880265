// SPDX-License-Identifier: BSD-3-Clause
//
// Minimum and maximum of every tile, row by row. All indexes of active tiles are built from these ranges.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "search/sample_view.hpp"

namespace tegl::detail {

/// Whether the range (least, greatest] is not empty, that is, the tile is active at some isovalue.
template <Value T>
[[nodiscard]] constexpr bool has_range(T least, T greatest) noexcept {
  return least < greatest;
}

/// Computes the ranges of the tiles of an image. It holds a buffer for one row: use one per thread. The samples must
/// outlive it.
template <Value T>
class TileRanges {
 public:
  explicit TileRanges(const SampleView<T>& samples);

  [[nodiscard]] const TileShape& grid() const noexcept { return grid_; }
  /// Computes `least` and `greatest` for a row of tiles. A tile with a missing corner gets the empty range (0, 0].
  void load(std::size_t row) noexcept;
  /// grid().size(0) values each.
  [[nodiscard]] const T* least() const noexcept { return least_.data(); }
  [[nodiscard]] const T* greatest() const noexcept { return greatest_.data(); }

 private:
  void merge(const T* samples) noexcept;
  void leave_out_missing() noexcept;

  SampleView<T> samples_;
  TileShape grid_;
  std::array<const T*, std::size_t{1} << (kMostAxes - 1)> rows_{};  ///< rows of samples around a row of tiles
  std::vector<T> least_, greatest_, gathered_;
  bool missing_ = false;
};

}  // namespace tegl::detail
