// SPDX-License-Identifier: BSD-3-Clause
//
// Positions in a grid of the faces of cells that have a contour: tiles and, for closed borders, caps. A cap belongs to
// a cell of the border. It is the contour of a tile whose lower half along its own last axis is this cell and whose
// upper half has low corners only, projected onto the border. This is the high part of the cell, and it matches the
// contours of adjacent tiles and caps.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tile/built_tile.hpp"

namespace tegl::detail {

/// 0: a tile. 1 + 2 a + side: the cap of a cell in the border across axis a, at its first or last samples.
template <int N>
class CellKind {
 public:
  static constexpr unsigned kCount = 2 * N + 1;
  constexpr explicit CellKind(unsigned number) noexcept : number_(number) {}
  constexpr CellKind(int axis, unsigned side) noexcept : number_(1 + 2 * static_cast<unsigned>(axis) + side) {}

  [[nodiscard]] constexpr unsigned number() const noexcept { return number_; }
  [[nodiscard]] constexpr bool is_cap() const noexcept { return number_ != 0; }
  /// Axis across the border of a cap; N for a tile.
  [[nodiscard]] constexpr int across() const noexcept { return is_cap() ? static_cast<int>(number_ - 1) / 2 : N; }
  [[nodiscard]] constexpr unsigned side() const noexcept { return is_cap() ? (number_ - 1) % 2 : 0; }
  /// Number of corners that are samples of the image; they come first.
  [[nodiscard]] constexpr unsigned corners() const noexcept { return 1u << (is_cap() ? N - 1 : N); }
  /// Axis of the grid for axis j of the cell. Undefined for the last axis of a cap.
  [[nodiscard]] constexpr int axis(int j) const noexcept { return j < across() ? j : j + 1; }
  /// Maps a set of the cell's axes (except a cap's last) to axes of the grid.
  [[nodiscard]] constexpr unsigned spread(unsigned axes) const noexcept {
    unsigned result = 0;
    for (int j = 0; j < N - (is_cap() ? 1 : 0); ++j) result |= (axes >> j & 1u) << axis(j);
    return result;
  }
  /// Whether the frame of the cell's axes, with a cap's last axis pointing outwards, is a mirror image of the grid's.
  [[nodiscard]] constexpr bool is_mirrored() const noexcept {
    return is_cap() && ((N - 1 - across()) % 2 != 0) != (side() == 0);
  }

 private:
  unsigned number_;
};

/// Storage position of a cell's face: in a layer or between layers, in slot `slot` of the row that is displaced by
/// `shift` from the cell's own row and sample.
struct FaceWhere {
  std::uint8_t shift = 0;  ///< bit a: one sample further along axis a
  std::uint8_t slot = 0;
  bool in_slab = false;
};

/// Slots and storage positions for all kinds of cells and faces.
template <int N>
class GridCells {
 public:
  GridCells(const CubeFaces& cube, bool has_caps) : faces_(cube.cells().size()) {
    const unsigned kinds = has_caps ? CellKind<N>::kCount : 1;
    where_.resize(kinds * faces_);
    for (unsigned number = 0; number < kinds; ++number)
      for (std::size_t f = 0; f < faces_; ++f) where_[number * faces_ + f] = find(CellKind<N>(number), cube.cells()[f]);
  }
  /// Number of slots per row.
  [[nodiscard]] std::size_t slots(bool in_slab) const noexcept { return slots_[in_slab ? 1 : 0]; }
  /// Storage position of the face with this lattice number. Requires that it can have contour vertices.
  [[nodiscard]] const FaceWhere& where(CellKind<N> kind, std::size_t face) const noexcept {
    return where_[kind.number() * faces_ + face];
  }

 private:
  static constexpr unsigned kLast = 1u << (N - 1);

  FaceWhere find(CellKind<N> kind, const CubeFace& face) {
    if (face.dim == 0 || face.dim == 2) return {};  // no vertices of their own
    const bool outwards = kind.is_cap() && (face.axes & kLast) != 0;
    if (kind.is_cap() && (face.base & kLast) != 0) return {};  // all corners low
    const unsigned axes = kind.spread(face.axes), shift = kind.spread(face.base);
    // Caps across the last axis at its last samples belong to the slab below them.
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
  std::array<std::uint8_t, 2u << N> numbers_{};  ///< slot + 1; 0: none yet
  std::array<std::size_t, 2> slots_{};
};

}  // namespace tegl::detail
