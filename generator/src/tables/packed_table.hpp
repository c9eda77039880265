// SPDX-License-Identifier: BSD-3-Clause
//
// A tile table as one array of 32-bit words, for shaders and GPU kernels, whose constant data has neither bytes nor
// structs. GLSL, WGSL and CUDA tables consist of this array and a few lines of look-up.
//
// Words; little-endian in files:
//   0  kPackedMagic ("TEGL")        6  group elements, 0 if flat         12  offset of the lists
//   1  table contract version       7  bytes per permutation row         13  offset of the simplices
//   2  dimension n                  8  most simplices of a signature     14  offset of the permutations
//   3  0 barycentric, 1 compact     9  most own vertices of a signature  15  offset of the reversal bits
//   4  lists                       10  words per list, 1 or 3            16  offset of the side masks
//   5  simplices                   11  offset of the signatures          17  side masks
// The offset of an empty part is 0. At the offsets:
//   signatures    by class only: list | element << 12 | slot swaps << 24, one word per signature
//   lists         1 word (n < 4): first simplex | simplices << 16 | cone vertices << 24
//                 3 words: first simplex, simplices | cone vertices << 16 | side vertices << 24, first side mask
//   simplices     one word each: local vertex j in bits 8 j ... 8 j + 7
//   permutations  bytes, four to a word, lowest first; row g starts at byte g x (word 7)
//   reversal      bit g: group element g reverses the orientation
//   side masks    two words each, bits 0-31 first
// The meaning of the entries is documented in table_contract.hpp.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tables/tile_tables.hpp"

namespace tegl::gen {

/// The first word of a table.
inline constexpr std::uint32_t kPackedMagic = 0x4c474554;
/// Number of words in the header.
inline constexpr std::uint32_t kPackedHeader = 18;

/// The words and the offsets of their parts, which the header holds too.
struct PackedTable {
  std::uint32_t list_stride = 0;     ///< words per list
  std::uint32_t signatures = 0;      ///< offset of the entries of signatures, in words
  std::uint32_t lists = 0;           ///< offset of the lists, in words
  std::uint32_t simplices = 0;       ///< offset of the simplices, in words
  std::uint32_t permutations = 0;    ///< offset of the permutations, in words
  std::uint32_t reversals = 0;       ///< offset of the reversal bits, in words
  std::uint32_t side_masks = 0;      ///< offset of the side masks, in words
  std::vector<std::uint32_t> words;  ///< the table
};

/// Packs a table. Errors: Internal if a number exceeds its bits (never for n <= 4).
[[nodiscard]] PackedTable pack(const TileTables& table);

/// The words as little-endian bytes on every platform.
[[nodiscard]] std::string to_bytes(const std::vector<std::uint32_t>& words);

}  // namespace tegl::gen
