// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the cells that the extraction without tables builds: active tiles of a slab, and caps.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kernel/extract_layers.hpp"
#include "tile/grid_cells.hpp"

namespace tegl::detail {

/// A tile or cap with a contour.
struct Cell {
  std::uint64_t signature;
  std::uint32_t row, i;    ///< first sample
  std::uint32_t tile = 0;  ///< number of the built tile
  std::uint8_t kind;
};

/// The tiles of a slab that have a missing corner; none until the first is added.
template <int N>
class TilesWithoutValues {
 public:
  explicit TilesWithoutValues(const RowShape<N>& shape) : shape_(shape) {}

  [[nodiscard]] bool any() const noexcept { return !bits_.empty(); }
  void clear() noexcept { bits_.clear(); }
  /// Takes the tiles between two layers whose missing samples are given by bits, as RowShape has them; an empty one has
  /// none.
  void set(const std::array<const std::vector<Word>*, 2>& missing) {
    clear();
    if (missing[0]->empty() && missing[1]->empty()) return;
    bits_.assign(shape_.rows() * shape_.pitch(), 0);
    for (std::size_t row = 0; row < shape_.rows(); ++row) {
      if (!shape_.has_cells(shape_.index_of(row), kAll)) continue;
      for (unsigned shift = 0; shift <= kAll; ++shift) {
        const std::vector<Word>& layer = *missing[shift >> (N - 1)];
        if (layer.empty()) continue;
        const Word* const from = layer.data() + shape_.shifted(row, shift) * shape_.pitch();
        Word* const to = bits_.data() + row * shape_.pitch();
        for (std::size_t w = 0; w < shape_.words(); ++w)
          to[w] |= (shift & 1u) == 0 ? from[w] : from[w] >> 1 | from[w + 1] << (kWordBits - 1);
      }
    }
  }
  /// Whether the tile that starts at sample i of a row has a missing corner.
  [[nodiscard]] bool has(std::size_t row, std::size_t i) const noexcept {
    return any() && (bits_[row * shape_.pitch() + i / kWordBits] >> (i % kWordBits) & 1u) != 0;
  }
  /// Whether the tile of a cell has a missing corner.
  [[nodiscard]] bool has(const Cell& cell) const noexcept {
    const CellKind<N> kind(cell.kind);
    const unsigned back = kind.is_cap() && kind.side() == 1 && kind.across() != N - 1 ? 1u << kind.across() : 0;
    return any() && has(shape_.unshifted(cell.row, back), cell.i - (back & 1u));
  }

 private:
  static constexpr unsigned kAll = (1u << N) - 1;

  const RowShape<N>& shape_;
  std::vector<Word> bits_;
};

/// Finds the cells of a slab that have a contour.
template <int N>
class CellFinder {
 public:
  /// `closed`: bit mask of axes across which borders have caps.
  CellFinder(const RowShape<N>& shape, unsigned closed) : shape_(shape), closed_(closed) {}

  /// Appends the cells that start in a row of slab k, which lies between `layers`, ordered by kind; caps with their
  /// tiles.
  void find(std::size_t k, const std::array<const Word*, 2>& layers, std::size_t row, std::vector<Cell>& out) const {
    const auto index = shape_.index_of(row);
    if (shape_.has_cells(index, kAll)) sweep(CellKind<N>(0), layers, row, kRowOfCells, out);
    for (int axis = 0; axis < N; ++axis)
      for (unsigned side = 0; side < 2; ++side) {
        if ((closed_ >> axis & 1u) == 0 || !shape_.has_cells(index, kAll ^ 1u << axis)) continue;
        const CellKind<N> kind(axis, side);
        if (axis == 0) {
          sweep(kind, layers, row, side == 0 ? 0 : shape_.size(0) - 1, out);
        } else if (axis == N - 1) {
          if (side == 0 ? k == 0 : k + 2 == shape_.layers())
            sweep(kind, {layers[side], nullptr}, row, kRowOfCells, out);
        } else if (index[axis] == (side == 0 ? 0 : shape_.size(axis) - 1)) {
          sweep(kind, layers, row, kRowOfCells, out);
        }
      }
  }

 private:
  static constexpr unsigned kAll = (1u << N) - 1;
  static constexpr std::size_t kRowOfCells = ~std::size_t{0};

  /// Appends the cells of one kind in a row. `only`: the only sample where a cell may start; kRowOfCells: no
  /// restriction.
  void sweep(CellKind<N> kind, const std::array<const Word*, 2>& layers, std::size_t row, std::size_t only,
             std::vector<Cell>& out) const {
    struct Corner {
      const Word* row;
      unsigned ahead;
    };
    // the rows of the corners
    std::array<Corner, kAll + 1> corners;
    for (unsigned c = 0; c < kind.corners(); ++c) {
      const unsigned shift = kind.spread(c);
      corners[c] = {layers[shift >> (N - 1)] + shape_.shifted(row, shift) * shape_.pitch(), shift & 1u};
    }
    // cells with contour, 64 at a time
    for (std::size_t w = 0; w < shape_.words(); ++w) {
      Word any = 0, all = ~Word{0};
      for (unsigned c = 0; c < kind.corners(); ++c) {
        const Word* const at = corners[c].row + w;
        const Word word = corners[c].ahead == 0 ? at[0] : at[0] >> 1 | at[1] << (kWordBits - 1);
        any |= word;
        all &= word;
      }
      Word rest = (kind.is_cap() ? any : any & ~all) & shape_.mask(w, only == kRowOfCells);
      if (only != kRowOfCells) rest &= w == only / kWordBits ? Word{1} << (only % kWordBits) : 0;
      for (; rest != 0; rest &= rest - 1) {
        const std::size_t i = w * kWordBits + static_cast<std::size_t>(std::countr_zero(rest));
        std::uint64_t signature = 0;
        for (unsigned c = 0; c < kind.corners(); ++c) {
          const std::size_t sample = i + corners[c].ahead;
          signature |= (corners[c].row[sample / kWordBits] >> (sample % kWordBits) & 1u) << c;
        }
        out.push_back({signature, static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(i), 0,
                       static_cast<std::uint8_t>(kind.number())});
      }
    }
  }

  const RowShape<N>& shape_;
  unsigned closed_;
};

}  // namespace tegl::detail
