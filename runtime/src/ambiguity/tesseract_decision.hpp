// SPDX-License-Identifier: BSD-3-Clause
//
// Resolution of ambiguous 4D tiles from the data: their squares, cubes and interior by an estimator.
#pragma once

#include <array>
#include <cstdint>

#include "ambiguity/cube_decision.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

/// The filling of a 4D tile: its resolution and the lists of its cubes.
struct ResolvedTile {
  ResolvedKey key;
  std::array<std::uint16_t, 8> cubes{};  ///< keys; only from resolved_tile
  ResolvedCubes::Lists lists{};
  std::uint8_t with_vertices = 0;                      ///< bit set of the cubes that own vertices
  std::uint32_t apart = ResolvedTesseract::kNotKnown;  ///< as in ResolvedTesseract::find
};

/// Whether a 4D tile is combined from its cubes if ambiguities are resolved from the data. This holds if the data
/// affect the tile, and always in the barycentric triangulation, as the cubes' barycentres are listed with their tiles.
inline bool is_put_together(const FaceEstimator<4>& estimator, unsigned signature) noexcept {
  return estimator.triangulation() == Triangulation::barycentric || ambiguous_signatures<4>()[signature];
}
/// Resolves a 4D tile.
ResolvedTile resolved_tile(const FaceEstimator<4>& estimator, const std::array<std::size_t, 4>& base,
                           unsigned signature) noexcept;
/// The ambiguous tiles of a word, and their resolutions.
struct TesseractsOfWord {
  std::size_t count = 0;
  std::array<std::uint8_t, kWordBits> bits;
  std::array<std::uint16_t, kWordBits> signatures;
  std::array<ResolvedTile, kWordBits> tiles;
  std::uint64_t unsure = 0;  ///< tiles that rounding could decide: resolved_tile must be used for them
};
void resolve(const FaceEstimator<4>& estimator, const FaceBlock<4>& block, TesseractsOfWord& of) noexcept;

/// Resolves the ambiguous tiles of a row of tesseracts in order, a word at a time if that is faster.
class RowOfTesseracts {
 public:
  /// For the row of `base`, which has `samples` samples. `tiles`: its active tiles.
  /// `of_word`: room for the tiles of a word. It is large, and making it costs more than a row of few tiles.
  RowOfTesseracts(const FaceEstimator<4>& estimator, const std::array<std::size_t, 4>& base, std::size_t samples,
                  const RowTiles& tiles, TesseractsOfWord& of_word) noexcept
      : estimator_(estimator),
        tiles_(tiles),
        at_once_(samples <= kMostListed && RowFaces<4>::can_use(estimator)),
        faces_(estimator, base, samples),
        of_word_(of_word) {}
  /// Resolves number `ordinal` of the active tiles, based at `base`. Ordinals must increase from call to call. The
  /// result is valid until the next call.
  const ResolvedTile& resolve(const std::array<std::size_t, 4>& base, std::uint32_t ordinal,
                              unsigned signature) noexcept;

 private:
  void begin_word(std::size_t word, std::uint32_t ordinal) noexcept;

  const FaceEstimator<4>& estimator_;
  RowTiles tiles_;
  bool at_once_;
  std::size_t word_ = ~std::size_t{0};
  bool has_many_ = false;  ///< whether the word is decided at once
  RowFaces<4> faces_;
  TesseractsOfWord& of_word_;
  std::uint32_t first_ = 0;                     ///< ordinal of the word's first tile resolved at once
  std::array<std::uint8_t, kWordBits> number_;  ///< by ordinal from there on: number in of_word_
  ResolvedTile alone_;                          ///< the last one not resolved at once
};

}  // namespace tegl::detail
