// SPDX-License-Identifier: BSD-3-Clause
//
// 4D tiles resolved from the data that counting has assembled, kept for writing, so that each is assembled once. A
// tetrahedron takes four bytes (local vertices) and not sixteen as in the contour.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "ambiguity/tesseract_decision.hpp"
#include "tegl/contour.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

/// Tiles of a chunk of rows, in order. A tile is a record of 64-bit words: its lists in two; the cubes with vertices,
/// the numbers of own vertices and of simplices; the masks; the simplices, two per word.
class AssembledTiles {
 public:
  /// Removes all tiles. Memory is kept. `expected`: words that will probably be kept; the first growth makes room for
  /// as many.
  void clear(std::size_t expected) noexcept {
    size_ = 0;
    expected_ = expected;
    is_full_ = false;
  }
  [[nodiscard]] bool is_full() const noexcept { return is_full_; }
  /// Offset of the next tile, for `read`.
  [[nodiscard]] std::size_t size() const noexcept { return size_; }

  /// Appends a tile with its filling, unless more than `most` words would be kept. If so, it is full. `filling`:
  /// combined from cubes. kAtOnce of its simplices are read even if it has fewer, so it must not be a view of the
  /// table's.
  void add(const ResolvedTile& tile, const ResolvedView& filling, std::size_t most) {
    const std::size_t first = size_, simplices = first + kHead + filling.own_vertices;
    const std::size_t end = simplices + (filling.simplex_count + 1) / 2;
    const std::size_t room = std::max(end, simplices + kAtOnce / 2);
    is_full_ = room > most;
    if (is_full_) return;
    if (room > words_.size()) enlarge(std::min(most, std::max(room + unused(words_.size()), expected_)));
    size_ = end;
    std::uint64_t* const to = words_.data() + first;
    std::memcpy(to, tile.lists.data(), sizeof tile.lists);
    to[2] = std::uint64_t{tile.with_vertices} | std::uint64_t{filling.own_vertices} << kOwnAt |
            std::uint64_t{filling.simplex_count} << kSimplicesAt;
    for (unsigned j = 0; j < filling.own_vertices; ++j) to[kHead + j] = filling.masks[j];
    // as many as most tiles have, at once
    auto* const out = reinterpret_cast<std::byte*>(words_.data() + simplices);
    std::memcpy(out, filling.simplices, 4 * kAtOnce);
    if (filling.simplex_count > kAtOnce)
      std::memcpy(out + 4 * kAtOnce, filling.simplices + 4 * kAtOnce,
                  4 * (std::size_t{filling.simplex_count} - kAtOnce));
  }

  /// The tile at offset `at`, which is advanced to the next one: its lists, its cubes with vertices and its filling.
  ResolvedView read(std::size_t& at, ResolvedTile& tile) const noexcept {
    const std::uint64_t* const from = words_.data() + at;
    std::memcpy(tile.lists.data(), from, sizeof tile.lists);
    tile.with_vertices = static_cast<std::uint8_t>(from[2] & 0xffu);
    const auto own = static_cast<std::uint32_t>(from[2] >> kOwnAt & 0xffu);
    const auto simplices = static_cast<std::uint32_t>(from[2] >> kSimplicesAt);
    at += kHead + own + (simplices + 1) / 2;
    return {reinterpret_cast<const std::uint8_t*>(from + kHead + own), simplices, own, from + kHead};
  }

 private:
  /// How many words more than needed a list of `words` gets when it grows. Short lists get few: all chunks of a batch
  /// have one, and threads enlarge theirs at the same time. Long ones get more, so that they are seldom copied.
  static constexpr std::size_t unused(std::size_t words) noexcept { return words / (words < 1024 ? 16 : 4); }

  [[gnu::noinline]] void enlarge(std::size_t words) {
    words_.reserve(words);  // exactly
    words_.resize(words);
  }

  static constexpr std::size_t kAtOnce = 32;
  static_assert(kAtOnce <= ResolvedCubes::kCubes * ResolvedCubes::kMostTriangles);  // ResolvedTesseract has so many

  static constexpr std::size_t kHead = 3;  ///< words before the masks
  static constexpr unsigned kOwnAt = 8, kSimplicesAt = 16;
  static_assert(sizeof(ResolvedTile::lists) == 2 * sizeof(std::uint64_t));

  Buffer<std::uint64_t> words_;
  std::size_t size_ = 0;  ///< of those in use
  std::size_t expected_ = 0;
  bool is_full_ = false;
};

}  // namespace tegl::detail
