// SPDX-License-Identifier: BSD-3-Clause
//
// Which corners of the cells of a grid are missing. Most images have none: then nothing is stored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/function_ref.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Reads `count` samples along axis 0 from an index on, as doubles. Indices may go one beyond the end of periodic axes.
template <int N>
using ReadSamples = FunctionRef<void(const std::array<std::size_t, N>& from, std::size_t count, double* out)>;

template <int N>
class MissingCorners {
 public:
  using Index = std::array<std::size_t, N>;
  static constexpr std::uint32_t kAll = ~std::uint32_t{0} >> (32 - (1u << N));

  /// `cells`: number of cells along each axis. Bit a of `periodic`: axis a is, and has as many samples as cells;
  /// otherwise it has one more. `wholly`: cells with a missing corner miss all, and so do those with infinite corners
  /// of both signs, whose mean does not exist. Errors: Cancelled.
  MissingCorners(const Index& cells, unsigned periodic, bool wholly, ReadSamples<N> read, const WorkOptions& work);

  /// Whether any cell has a missing corner.
  [[nodiscard]] bool any() const noexcept { return !of_cells_.empty(); }
  /// The missing corners of a cell (bit v: corner v).
  [[nodiscard]] std::uint32_t of_cell(const Index& cell) const noexcept {
    return any() ? of_cells_[number_of(cell)] : 0;
  }
  /// Whether a cell or one that shares a corner with it has missing corners.
  [[nodiscard]] bool is_near(const Index& cell) const noexcept { return any() && near_[number_of(cell)] != 0; }
  /// Moves a cell by steps of -1, 0 or 1; returns false if there is none.
  [[nodiscard]] bool move(Index& cell, const std::array<std::int8_t, N>& steps) const noexcept {
    for (int a = 0; a < N; ++a) {
      if (steps[a] == 0) continue;
      cell[a] += static_cast<std::size_t>(std::ptrdiff_t{steps[a]});  // modulo 2^64
      if (cell[a] < cells_[a]) continue;
      if ((periodic_ >> a & 1u) == 0) return false;
      cell[a] = steps[a] < 0 ? cells_[a] - 1 : 0;
    }
    return true;
  }
  /// Number of a cell, axis 0 fastest.
  [[nodiscard]] std::size_t number_of(const Index& cell) const noexcept {
    std::size_t number = 0;
    for (int a = N - 1; a >= 0; --a) number = number * cells_[a] + cell[a];
    return number;
  }

 private:
  void find_near(const WorkOptions& work);

  Index cells_;
  unsigned periodic_;
  std::vector<std::uint32_t> of_cells_;  ///< empty: none is missing
  std::vector<std::uint8_t> near_;
};

}  // namespace tegl::detail
