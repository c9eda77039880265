// SPDX-License-Identifier: BSD-3-Clause
//
// Resolution of ambiguous squares and cubes from the data: their keys (tile/cube_key.hpp) by an estimator.
#pragma once

#include <array>
#include <cstdint>

#include "ambiguity/cube_words.hpp"
#include "ambiguity/face_estimator.hpp"
#include "ambiguity/face_signs.hpp"
#include "tile/cube_key.hpp"
#include "tile/row_table.hpp"
#include "tile/variant_table.hpp"

namespace tegl::detail {

/// Key of the cube along `axes` based at `base`, in an image of three or four dimensions.
template <int N>
CubeKey cube_key(const FaceEstimator<N>& estimator, const std::array<std::size_t, N>& base, unsigned axes,
                 unsigned signature) noexcept;

/// Decides all faces of a row's tiles, one word of tiles at a time (N = 3 or 4). Faster than deciding tile by tile if
/// many of a word's tiles are ambiguous.
template <int N>
class RowFaces {
 public:
  using Index = std::array<std::size_t, N>;
  /// Number of ambiguous tiles in a word from which this is faster.
  static constexpr std::size_t kMany = 6;

  /// For the row of `base`, which has `samples` samples.
  RowFaces(const FaceEstimator<N>& estimator, const Index& base, std::size_t samples) noexcept
      : estimator_(estimator), base_(base), samples_(samples) {}
  /// False for a caller's estimator.
  static bool can_use(const FaceEstimator<N>& estimator) noexcept { return !estimator.is_callers(); }

  /// Returns the faces of a word's tiles, all decided. The most recent word is cached.
  const FaceBlock<N>& look_at(std::size_t word) noexcept;

 private:
  const FaceEstimator<N>& estimator_;
  Index base_;
  std::size_t samples_;
  std::size_t word_ = ~std::size_t{0};
  FaceBlock<N> block_;
};

/// Replaces the signatures of a word's ambiguous tiles by their keys. Returns the tiles that rounding could decide, as
/// bits by number among the active tiles: these must be resolved individually.
[[nodiscard]] Word resolve(const FaceEstimator<3>& estimator, const RowTable& table, const FaceBlock<3>& block,
                           CubesOfWord& cubes) noexcept;

/// Key of an ambiguous tile.
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
