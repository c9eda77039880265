// SPDX-License-Identifier: BSD-3-Clause
//
// How the faces of the unit cube lie in a grid, for the cells whose contours make up that of an image: its tiles and,
// where the border is closed, the caps. A cap belongs to a cell of the border, and is the contour of the tile that has
// this cell as its lower half (along its own last axis) and low corners only in the other, pressed flat onto the
// border: the high part of the cell, in the form of a contour that fits those of the tiles inside and of the caps
// around.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tile/built_tile.hpp"

namespace tegl::detail {

/// 0: a tile; 1 + 2 a + side: the cap of a cell in the border across axis a, at its first or last samples.
template <int N>
class CellKind {
 public:
  static constexpr unsigned kCount = 2 * N + 1;
  constexpr explicit CellKind(unsigned number) noexcept : number_(number) {}
  constexpr CellKind(int axis, unsigned side) noexcept : number_(1 + 2 * static_cast<unsigned>(axis) + side) {}

  [[nodiscard]] constexpr unsigned number() const noexcept { return number_; }
  [[nodiscard]] constexpr bool is_cap() const noexcept { return number_ != 0; }
  /// Of a cap: the axis across the border. N for a tile.
  [[nodiscard]] constexpr int across() const noexcept { return is_cap() ? static_cast<int>(number_ - 1) / 2 : N; }
  [[nodiscard]] constexpr unsigned side() const noexcept { return is_cap() ? (number_ - 1) % 2 : 0; }
  /// Corners that are samples of the image: the first ones.
  [[nodiscard]] constexpr unsigned corners() const noexcept { return 1u << (is_cap() ? N - 1 : N); }
  /// The grid's axis of the cell's axis j; a cap has none for its last.
  [[nodiscard]] constexpr int axis(int j) const noexcept { return j < across() ? j : j + 1; }
  /// A set of the cell's axes (but a cap's last) as one of the grid's.
  [[nodiscard]] constexpr unsigned spread(unsigned axes) const noexcept {
    unsigned result = 0;
    for (int j = 0; j < N - (is_cap() ? 1 : 0); ++j) result |= (axes >> j & 1u) << axis(j);
    return result;
  }
  /// Whether the frame "the cell's axes, a cap's last pointing outwards" is a mirror image of the grid's.
  [[nodiscard]] constexpr bool is_mirrored() const noexcept {
    return is_cap() && ((N - 1 - across()) % 2 != 0) != (side() == 0);
  }

 private:
  unsigned number_;
};

/// Where a face of a cell is kept: in the layers or between them, `shift` away from the cell's own row and sample, in
/// slot `slot` of that row.
struct FaceWhere {
  std::uint8_t shift = 0;  ///< bit a: one sample further along axis a
  std::uint8_t slot = 0;
  bool in_slab = false;
};

/// Slots and places for all kinds of cells and faces.
template <int N>
class GridCells {
 public:
  GridCells(const CubeFaces& cube, bool has_caps) : faces_(cube.cells().size()) {
    const unsigned kinds = has_caps ? CellKind<N>::kCount : 1;
    where_.resize(kinds * faces_);
    for (unsigned number = 0; number < kinds; ++number)
      for (std::size_t f = 0; f < faces_; ++f) where_[number * faces_ + f] = find(CellKind<N>(number), cube.cells()[f]);
  }
  /// Slots of a row.
  [[nodiscard]] std::size_t slots(bool in_slab) const noexcept { return slots_[in_slab ? 1 : 0]; }
  /// Where the face with this number in the lattice is, if it can have vertices of the contour.
  [[nodiscard]] const FaceWhere& where(CellKind<N> kind, std::size_t face) const noexcept {
    return where_[kind.number() * faces_ + face];
  }

 private:
  static constexpr unsigned kLast = 1u << (N - 1);

  FaceWhere find(CellKind<N> kind, const CubeFaces::Cell& face) {
    if (face.dim == 0 || face.dim == 2) return {};  // no vertices of their own
    const bool outwards = kind.is_cap() && (face.axes & kLast) != 0;
    if (kind.is_cap() && (face.base & kLast) != 0) return {};  // all low
    const unsigned axes = kind.spread(face.axes), shift = kind.spread(face.base);
    // The caps across the last axis at its last samples belong to the slab below them.
    const unsigned up = kind.across() == N - 1 ? kind.side() << (N - 1) : 0;
    const bool in_slab = (axes & kLast) != 0;
    return {static_cast<std::uint8_t>(shift | up), slot(axes | (outwards ? 1u << N : 0), in_slab), in_slab};
  }
  std::uint8_t slot(unsigned key, bool in_slab) {
    if (numbers_[key] == 0) numbers_[key] = static_cast<std::uint8_t>(++slots_[in_slab ? 1 : 0]);
    return static_cast<std::uint8_t>(numbers_[key] - 1);
  }

  std::size_t faces_;
  std::vector<FaceWhere> where_;
  std::array<std::uint8_t, 2u << N> numbers_{};  ///< one more than the slot
  std::array<std::size_t, 2> slots_{};
};

}  // namespace tegl::detail
