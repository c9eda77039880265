// SPDX-License-Identifier: BSD-3-Clause
//
// The faces of many tiles decided at once: of the 64 tiles at a word of a row, by registers and without a branch that
// depends on the samples. In noise nearly every tile has ambiguous faces, and no branch would be foreseen. Nothing is
// decided by rounding: where it could, the face is said to be unsure, and is to be looked at by itself
// (face_estimator.hpp, tegl/saddle.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "image/bitplanes.hpp"

namespace tegl::detail {

/// By number: squares (in cubes 2 * axis across + side; in tesseracts as kTesseractSquares), then cubes (in tesseracts
/// 2 * axis left out + side), then, in tesseracts, the tile.
template <int N>
inline constexpr unsigned kFirstCube = N == 3 ? 6 : 24;
inline constexpr unsigned kTesseractFace = 32;

/// A word's tiles of a row, N = 3 or 4, and what is known of their faces.
template <int N>
struct FaceBlock {
  static constexpr std::size_t kRows = std::size_t{1} << (N - 1);
  static constexpr std::size_t kSamples = kWordBits + 1;
  static constexpr std::size_t kPitch = 80;  ///< more are read, in vain

  /// The rows of samples around them: bit a - 1 of a row's number is its side along axis a.
  alignas(64) std::array<std::array<double, kPitch>, kRows> samples;
  std::size_t tiles = 0;
  /// By tile: bit f, face f is high. Of faces that are not ambiguous it means nothing.
  alignas(64) std::array<std::uint64_t, kPitch> high;
  /// By tile: not 0 where rounding could decide a face of it.
  alignas(64) std::array<std::uint64_t, kPitch> unsure;
};

/// All faces by the means of their corners.
template <int N>
void decide_by_means(FaceBlock<N>& block, double isovalue) noexcept;
/// Squares by their saddles (tegl/saddle.hpp); tesseracts by their means; cubes are left alone.
template <int N>
void decide_by_saddles(FaceBlock<N>& block, double isovalue) noexcept;

/// Pairs of diagonal edges of cubes, A and C, B and D: whether A and C are joined inside (tegl/saddle.hpp; the values
/// at the four edges' lower and upper ends, in this order).
struct JoinQuestions {
  static constexpr std::size_t kMost = kWordBits;
  enum Answer : std::uint8_t { no, yes, unsure };

  std::size_t count = 0;
  /// Of questions beyond `count`, up to the next whole register, `answer` fills in zeros.
  alignas(64) std::array<std::array<double, kMost>, 8> ends;
  alignas(64) std::array<double, kMost> sign;  ///< 1: A and C are high; -1: they are low
  std::array<Answer, kMost> answers;
};
void answer(JoinQuestions& questions, double isovalue) noexcept;

}  // namespace tegl::detail
