// SPDX-License-Identifier: BSD-3-Clause
//
// Decides the faces of many tiles at once: of the 64 tiles in a word of a row, by registers and without branches on the
// samples. In noise nearly every tile has ambiguous faces, and branches would be mispredicted. If rounding could decide
// a face, it is marked as unsure and must be decided individually (face_estimator.hpp, tegl/saddle.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "ambiguity/cube_words.hpp"
#include "image/bitplanes.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::detail {

/// Face numbers: first squares (in cubes 2 * axis across + side; in tesseracts as kTesseractSquares), then cubes (in
/// tesseracts 2 * omitted axis + side), then, in tesseracts, the tile.
template <int N>
inline constexpr unsigned kFirstCube = N == 3 ? 6 : 24;
inline constexpr unsigned kTesseractFace = 32;

/// The tiles in one word of a row (N = 3 or 4) and the decisions on their faces.
template <int N>
struct FaceBlock {
  static constexpr std::size_t kRows = std::size_t{1} << (N - 1);
  static constexpr std::size_t kSamples = kWordBits + 1;
  static constexpr std::size_t kPitch = 80;  ///< some entries past the samples are read but not used

  /// Rows of samples around the tiles. Bit a - 1 of a row's number is its side along axis a.
  alignas(64) std::array<std::array<double, kPitch>, kRows> samples;
  std::size_t tiles = 0;
  /// By tile: bit f is set if face f is high. Undefined for unambiguous faces.
  using Faces = std::conditional_t<N == 3, std::uint8_t, std::uint64_t>;
  alignas(64) std::array<Faces, kPitch> high;
  /// By tile: bit i is set if rounding could decide a face of tile i. No others are.
  std::uint64_t unsure = 0;
};

/// Decides all faces by the means of their corners.
template <int N>
void decide_by_means(FaceBlock<N>& block, double isovalue) noexcept;
/// Decides squares by their saddles (tegl/saddle.hpp) and tesseracts by their means. Cubes are not decided.
template <int N>
void decide_by_saddles(FaceBlock<N>& block, double isovalue) noexcept;

/// Questions about pairs of diagonal edges of cubes, A and C, B and D: whether A and C are joined inside the cube
/// (tegl/saddle.hpp). `ends`: values at the lower and upper ends of A, C, B, D.
struct JoinQuestions {
  static constexpr std::size_t kMost = kWordBits;
  enum Answer : std::uint8_t { no, yes, unsure };

  std::size_t count = 0;
  /// `answer` writes zeros to the entries of `ends` and `sign` from `count` up to the next whole register.
  alignas(64) std::array<std::array<double, kMost>, 8> ends;
  alignas(64) std::array<double, kMost> sign;  ///< 1: A and C are high; -1: they are low
  /// With AVX-512, the entries from `count` up to the next whole register are written, too, and have no meaning.
  std::array<Answer, kMost> answers;

  /// Adds a question. `value(corner)`: the sample at a corner of the cube.
  template <class Value>
  void add(const tables::CubeJoin& join, const Value& value) noexcept {
    for (std::size_t e = 0; e < ends.size(); ++e) ends[e][count] = value(join.corners[e]);
    sign[count++] = kSigns[join.high];
  }

  static constexpr std::array<double, 2> kSigns = {-1.0, 1.0};  ///< by CubeJoin::high, which is hard to predict
};
/// Asks about cubes of a block that have one pair of edges.
void ask(const FaceBlock<3>& block, const OpenCubes& cubes, JoinQuestions& questions) noexcept;
void answer(JoinQuestions& questions, double isovalue) noexcept;

}  // namespace tegl::detail
