// SPDX-License-Identifier: BSD-3-Clause
//
// How the data fill an ambiguous square or cube: its key (tile/cube_key.hpp) by an estimator.
#pragma once

#include <array>
#include <cstdint>

#include "ambiguity/face_estimator.hpp"
#include "ambiguity/face_signs.hpp"
#include "tile/cube_key.hpp"
#include "tile/extract_rows.hpp"
#include "tile/variant_table.hpp"

namespace tegl::detail {

/// The key of the cube along `axes` based at `base` of an image of three or four dimensions.
template <int N>
unsigned cube_key(const FaceEstimator<N>& estimator, const std::array<std::size_t, N>& base, unsigned axes,
                  unsigned signature) noexcept;

/// The faces of a row's tiles, N = 3 or 4, a word of tiles at a time: where many of a word's tiles are ambiguous this
/// is quicker than to ask for them one by one.
template <int N>
class RowFaces {
 public:
  using Index = std::array<std::size_t, N>;
  /// So many ambiguous tiles of a word are worth it.
  static constexpr std::size_t kMany = 6;

  /// Of the row through `base`, which has `samples`.
  RowFaces(const FaceEstimator<N>& estimator, const Index& base, std::size_t samples) noexcept
      : estimator_(estimator), base_(base), samples_(samples) {}
  /// Not for a caller's estimator.
  static bool can_use(const FaceEstimator<N>& estimator) noexcept { return !estimator.is_callers(); }

  /// Decides all faces of a word's tiles, unless it was the last one.
  const FaceBlock<N>& look_at(std::size_t word) noexcept;

 private:
  const FaceEstimator<N>& estimator_;
  Index base_;
  std::size_t samples_;
  std::size_t word_ = ~std::size_t{0};
  FaceBlock<N> block_;
};

/// Tiles at a word, with ambiguous signatures, and what becomes of them: with key 0, that it is to be asked for by
/// itself.
struct TilesOfWord {
  std::size_t count = 0;
  std::array<std::uint8_t, kWordBits> bits, signatures;
  std::array<Variant, kWordBits> variants;
};
void resolve(const FaceEstimator<3>& estimator, const RowTable& table, const FaceBlock<3>& block,
             TilesOfWord& tiles) noexcept;

/// The key of an ambiguous tile.
template <int N>
unsigned resolved_key(const FaceEstimator<N>& estimator, const std::array<std::size_t, N>& base,
                      unsigned signature) noexcept;
template <>
unsigned resolved_key<2>(const FaceEstimator<2>& estimator, const std::array<std::size_t, 2>& base,
                         unsigned signature) noexcept;
template <>
unsigned resolved_key<3>(const FaceEstimator<3>& estimator, const std::array<std::size_t, 3>& base,
                         unsigned signature) noexcept;

}  // namespace tegl::detail
