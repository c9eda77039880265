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

/// Tiles of a chunk of rows, in order. A tile is a record of 64-bit words: six of its lists; the other two, the cubes
/// with vertices, the numbers of own vertices and of simplices; the masks; the simplices, two per word.
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
    if (end > words_.capacity()) words_.reserve(std::min(most, end + unused(words_.capacity())));
    words_.resize(end);
    std::uint64_t* const to = words_.data() + first;
    const std::uint64_t sizes = std::uint64_t{filling.own_vertices} << kOwnAt | std::uint64_t{filling.simplex_count}
                                                                                    << kSimplicesAt;
    to[0] = to[1] = 0;
    for (unsigned f = 0; f < 6; ++f) to[0] |= std::uint64_t{tile.lists[f]} << (kListBits * f);
    to[1] = std::uint64_t{tile.lists[6]} | std::uint64_t{tile.lists[7]} << kListBits |
            std::uint64_t{tile.with_vertices} << kCubesAt | sizes;
    if (filling.own_vertices != 0) std::memcpy(to + kHead, filling.masks, filling.own_vertices * sizeof *to);
    std::memcpy(to + kHead + filling.own_vertices, filling.simplices, 4 * std::size_t{filling.simplex_count});
  }

  /// The tile at offset `at`, which is advanced to the next one: its lists, its cubes with vertices and its filling.
  ResolvedView read(std::size_t& at, ResolvedTile& tile) const noexcept {
    constexpr unsigned kMask = (1u << kListBits) - 1;
    const std::uint64_t* const from = words_.data() + at;
    for (unsigned f = 0; f < 8; ++f)
      tile.lists[f] = static_cast<std::uint16_t>(from[f / 6] >> (kListBits * (f % 6)) & kMask);
    tile.with_vertices = static_cast<std::uint8_t>(from[1] >> kCubesAt);
    const auto own = static_cast<std::uint32_t>(from[1] >> kOwnAt & 0xffu);
    const auto simplices = static_cast<std::uint32_t>(from[1] >> kSimplicesAt);
    at += kHead + own + (simplices + 1) / 2;
    return {reinterpret_cast<const std::uint8_t*>(from + kHead + own), simplices, own, from + kHead};
  }

 private:
  /// How many words more than needed a list of `words` gets when it grows. Short lists get few: all chunks of a batch
  /// have one, and threads enlarge theirs at the same time. Long ones get more, so that they are seldom copied.
  static constexpr std::size_t unused(std::size_t words) noexcept { return words / (words < 1024 ? 16 : 4); }

  static constexpr std::size_t kHead = 2;  ///< words before the masks
  static constexpr unsigned kListBits = 10, kCubesAt = 20, kOwnAt = 28, kSimplicesAt = 36;
  static_assert(ResolvedCubes::kNone < 1u << kListBits);

  Buffer<std::uint64_t> words_;
  bool is_full_ = false;
};

}  // namespace tegl::detail
