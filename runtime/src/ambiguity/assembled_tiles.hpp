// SPDX-License-Identifier: BSD-3-Clause
//
// 4D tiles resolved from the data that counting has assembled, kept for writing, so that each is assembled once. A
// tetrahedron takes four bytes (local vertices) and not sixteen as in the contour.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "ambiguity/tesseract_decision.hpp"
#include "tegl/contour.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

/// Tiles of a chunk of rows, in order. A tile is a record of 64-bit words: its lists, in two words; the cubes with
/// vertices and the numbers of own vertices and of simplices; the masks; the simplices, two per word.
class AssembledTiles {
 public:
  /// Removes all tiles. Memory is kept.
  void clear() noexcept {
    words_.clear();
    is_full_ = false;
  }
  [[nodiscard]] bool is_full() const noexcept { return is_full_; }
  /// Offset of the next tile, for `read`.
  [[nodiscard]] std::size_t size() const noexcept { return words_.size(); }

  /// Appends a tile with its filling, unless more than `most` words would be kept. If so, it is full.
  void add(const ResolvedTile& tile, const ResolvedView& filling, std::size_t most) {
    const std::size_t first = words_.size();
    const std::size_t end = first + kHead + filling.own_vertices + (filling.simplex_count + 1) / 2;
    is_full_ = end > most;
    if (is_full_) return;
    if (end > words_.capacity()) words_.reserve(std::min(most, end + words_.capacity() / 4));
    words_.resize(end);
    std::uint64_t* const to = words_.data() + first;
    std::memcpy(to, tile.lists.data(), sizeof tile.lists);
    to[2] = std::uint64_t{tile.with_vertices} | std::uint64_t{filling.own_vertices} << kOwnAt |
            std::uint64_t{filling.simplex_count} << kSimplicesAt;
    for (std::uint32_t j = 0; j < filling.own_vertices; ++j) to[kHead + j] = filling.masks[j];
    std::memcpy(to + kHead + filling.own_vertices, filling.simplices, 4 * std::size_t{filling.simplex_count});
  }

  /// The tile at offset `at`, which is advanced to the next one: its lists, its cubes with vertices and its filling.
  ResolvedView read(std::size_t& at, ResolvedTile& tile) const noexcept {
    const std::uint64_t* const from = words_.data() + at;
    std::memcpy(tile.lists.data(), from, sizeof tile.lists);
    tile.with_vertices = static_cast<std::uint8_t>(from[2]);
    const auto own = static_cast<std::uint32_t>(from[2] >> kOwnAt & 0xffu);
    const auto simplices = static_cast<std::uint32_t>(from[2] >> kSimplicesAt);
    at += kHead + own + (simplices + 1) / 2;
    return {reinterpret_cast<const std::uint8_t*>(from + kHead + own), simplices, own, from + kHead};
  }

 private:
  static constexpr std::size_t kHead = 3;  ///< words before the masks
  static constexpr unsigned kOwnAt = 8, kSimplicesAt = 16;
  static_assert(sizeof(ResolvedCubes::Lists) == 2 * sizeof(std::uint64_t));

  Buffer<std::uint64_t> words_;
  bool is_full_ = false;
};

}  // namespace tegl::detail
