// SPDX-License-Identifier: BSD-3-Clause
//
// Replaces the signatures of a word's ambiguous cubes by the keys of their variants (tile/cube_key.hpp), for the
// decisions on their faces: by lookups in registers, and without branches on the decisions. Compiled for several
// instruction sets, the best of which is chosen at run time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "image/bitplanes.hpp"
#include "tile/row_table.hpp"

namespace tegl::detail {

/// The active tiles of one word of a row, N = 3.
struct CubesOfWord {
  Word active;                                             ///< by position in the word
  Word ambiguous;                                          ///< by number among the active tiles; not 0
  const std::uint16_t* at;                                 ///< positions of the active tiles along the row
  std::uint16_t* keys;                                     ///< signatures, and keys of ambiguous tiles once chosen
  std::int32_t more_simplices = 0, more_own_vertices = 0;  ///< than without resolution

  /// Changes the key of tile `number`, whose resolved cube was `before`, to `after`.
  void change(unsigned number, const Variant& before, const Variant& after) noexcept {
    more_simplices += after.more_simplices - before.more_simplices;
    more_own_vertices += after.more_own_vertices - before.more_own_vertices;
    keys[number] = after.key;
  }
};

/// Decision on the centre of a cube for which it matters.
enum class CentreRule : std::uint8_t { separate, by_bit, by_joins };

/// Cubes of a word whose centres the trilinear interpolant decides.
struct OpenCubes {
  std::size_t count = 0;
  alignas(64) std::array<std::uint8_t, kWordBits> numbers;   ///< among the active tiles
  alignas(64) std::array<std::uint8_t, kWordBits> places;    ///< in the word
  alignas(64) std::array<std::uint16_t, kWordBits> entries;  ///< of tables::ResolvedTable
};
/// Such cubes by the number of pairs of edges that may join inside them (tables::CubeJoin).
struct CubesByPairs {
  OpenCubes with_one, with_more;
};

/// Sets the keys of the ambiguous cubes. `high`: by position, bits of the squares that are high and, with
/// CentreRule::by_bit, of the centre (bit 6); 64 entries are read. `variants`: RowTable::variants. With
/// CentreRule::by_joins, cubes whose centre matters get the keys of separate ones and are listed in `open`. Up to 31
/// entries of `keys` past the last active tile are read, and written with the same values.
void choose_variants(const std::uint8_t* high, const Variant* variants, CentreRule rule, CubesOfWord& cubes,
                     CubesByPairs& open) noexcept;

}  // namespace tegl::detail
