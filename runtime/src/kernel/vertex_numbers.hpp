// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of the contour's vertices: bit planes with prefix sums that map "bit i of row r" to a vertex number.
//
// Vertices are numbered layer 0, slab 0, layer 1, slab 1, ... (extract_layers.hpp); within a layer or slab by row,
// within a row by category, within a category by bit. Every number is therefore base[row] + prefix[word] + popcount, so
// rows are independent and all passes get the same numbers. The base of a row is the first number of its chunk
// (Counter::place_layer and place_slab in first_vertices.cpp) and the row's offset in it (offset_layer_row and
// offset_slab_row in extract_count.cpp).
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "image/bitplanes.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Rows per *chunk* of a layer or slab: a chunk's rows are counted, numbered and written together. First numbers are
/// prefix sums over chunks and, within each chunk, over rows.
inline constexpr std::size_t kChunkRows = 32;
constexpr std::size_t chunk_of(std::size_t row) noexcept { return row / kChunkRows; }

/// Cells of one kind that own up to `Slots` vertices each. Bit i of plane j in a row is set if cell i has more than j
/// vertices.
template <unsigned Slots>
struct RankPlane {
  std::array<std::vector<Word>, Slots> bits;
  std::vector<std::uint32_t> prefix;  ///< vertices of the row before each word
  std::vector<Index> offset;          ///< by row: its first vertex relative to the chunk's first
  std::vector<std::uint32_t> count;   ///< vertices of each row; if 0, the row's bits are undefined
  std::vector<Index> chunk_first;     ///< first vertex of each chunk

  void allocate(std::size_t rows, std::size_t words) {
    for (auto& plane : bits) plane.assign(rows * words, 0);
    prefix.assign(rows * words, 0);
    offset.assign(rows, 0);
    count.assign(rows, 0);
    chunk_first.assign(chunk_of(rows - 1) + 1, 0);
  }
  /// Bytes for each row.
  static constexpr std::size_t row_bytes(std::size_t words) noexcept {
    return words * (Slots * sizeof(Word) + sizeof(std::uint32_t)) + sizeof(Index) + sizeof(std::uint32_t);
  }
  /// First vertex of a row.
  [[nodiscard]] Index first(std::size_t row) const noexcept { return chunk_first[chunk_of(row)] + offset[row]; }
  /// First vertex of cell i of a row. If the cell has none: first vertex of the next cell that has one.
  [[nodiscard]] Index id(std::size_t row, std::size_t words, std::size_t i) const noexcept {
    const std::size_t w = row * words + i / kWordBits;
    const Word below = (Word{1} << (i % kWordBits)) - 1;
    Index id = first(row) + prefix[w];
    for (const auto& plane : bits) id += static_cast<Index>(std::popcount(plane[w] & below));
    return id;
  }
};
using EdgePlane = RankPlane<1>;

}  // namespace tegl::detail
