// SPDX-License-Identifier: BSD-3-Clause
//
// How the data fill an ambiguous tesseract: the resolution of its squares, cubes and inside by an estimator.
#pragma once

#include <array>
#include <cstdint>

#include "ambiguity/cube_decision.hpp"
#include "tile/tesseract_fill.hpp"

namespace tegl::detail {

/// What a tile of four dimensions is filled with: how it is resolved, and the lists of its cubes, and the keys of those
/// that have vertices of their own.
struct ResolvedTile {
  ResolvedKey key;
  std::array<std::uint16_t, 8> cubes{};
  ResolvedCubes::Lists lists{};
  std::uint8_t with_vertices = 0;  ///< set of the cubes that have vertices of their own
};

/// Whether a tile of four dimensions is put together from its cubes where data decide: if they have a say in it, and in
/// the barycentric triangulation always, as the cubes' barycentres are listed with their tiles.
inline bool is_put_together(const FaceEstimator<4>& estimator, unsigned signature) noexcept {
  return estimator.triangulation() == kBarycentric || ambiguous_signatures<4>()[signature];
}
/// The filling of such a tile.
ResolvedTile resolved_tile(const FaceEstimator<4>& estimator, const std::array<std::size_t, 4>& base,
                           unsigned signature) noexcept;
/// The same of tile `bit` of a block; false where it is to be asked for by itself.
bool resolve(const FaceEstimator<4>& estimator, const FaceBlock<4>& block, unsigned bit, unsigned signature,
             ResolvedTile& tile) noexcept;

/// The ambiguous tiles of a row of tesseracts, one after the other: decided a word at a time where that pays.
class RowOfTesseracts {
 public:
  /// Of the row through `base`, which has `samples`; `tiles`: its active tiles.
  RowOfTesseracts(const FaceEstimator<4>& estimator, const std::array<std::size_t, 4>& base, std::size_t samples,
                  const RowTiles& tiles) noexcept
      : estimator_(estimator),
        tiles_(tiles),
        at_once_(samples <= kMostListed && RowFaces<4>::can_use(estimator)),
        faces_(estimator, base, samples) {}
  /// Number `ordinal` of the active tiles, which is at `base`; numbers rise from call to call.
  ResolvedTile resolve(const std::array<std::size_t, 4>& base, std::uint32_t ordinal, unsigned signature) noexcept;

 private:
  const FaceEstimator<4>& estimator_;
  RowTiles tiles_;
  bool at_once_;
  std::size_t word_ = ~std::size_t{0};
  bool has_many_ = false;  ///< whether the word is decided at once
  RowFaces<4> faces_;
};

}  // namespace tegl::detail
