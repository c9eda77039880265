// SPDX-License-Identifier: BSD-3-Clause
//
// Random 4D tiles that are filled by nested copies. Few of the tiles of noise are.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <random>

#include "tegl/ambiguity.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::test {

/// Draws tiles; one object per thread.
class NestedTiles {
 public:
  explicit NestedTiles(Triangulation triangulation) : builder_(triangulation) {}

  /// A tile with random signs and random choices for squares; for every second one also for cubes.
  detail::ResolvedKey operator()(std::mt19937_64& bits) {
    detail::ResolvedKey key;
    do {
      const std::uint64_t random = bits();
      key.signature = static_cast<std::uint16_t>(random);
      key.squares = static_cast<std::uint32_t>(random >> 16) & 0xffffffu;
      key.low_cubes = key.high_cubes = 0;
      if (random >> 63 != 0) {
        key.low_cubes = static_cast<std::uint8_t>(random >> 40);
        key.high_cubes = static_cast<std::uint8_t>(random >> 48 & ~unsigned{key.low_cubes});
      }
      builder_.find(key);
    } while (!builder_.is_nested());
    return key;
  }

 private:
  detail::ResolvedTesseract builder_;
};

/// The key's choice for a face of an image of 2 x 2 x 2 x 2 samples, for Estimator::choose.
inline tile::Choice choice_of(const detail::ResolvedKey& key, const AmbiguousFace& face) {
  unsigned base = 0;
  for (unsigned a = 0; a < 4; ++a) base |= static_cast<unsigned>(face.base()[a]) << a;
  if (face.dim() == 4) return key.tile;
  if (face.dim() == 3) {
    const unsigned axis = static_cast<unsigned>(std::countr_one(face.axes()));
    const unsigned cube = 2 * axis + (base >> axis & 1u);
    if ((key.low_cubes >> cube & 1u) != 0) return tile::Choice::low;
    return (key.high_cubes >> cube & 1u) != 0 ? tile::Choice::high : tile::Choice::separate;
  }
  const auto at = std::find_if(detail::kTesseractSquares.begin(), detail::kTesseractSquares.end(),
                               [&](const auto& square) { return square.base == base && square.axes == face.axes(); });
  const auto square = static_cast<unsigned>(at - detail::kTesseractSquares.begin());
  return (key.squares >> square & 1u) != 0 ? tile::Choice::high : tile::Choice::low;
}

}  // namespace tegl::test
