// SPDX-License-Identifier: BSD-3-Clause
//
// What the bilinear and the trilinear interpolant make of a square and a cube, decided by signs of polynomials: held
// against sweeps through the cube and against grids in it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <random>

#include "multilinear.hpp"
#include "tegl/saddle.hpp"

namespace tegl {
namespace {

using facets::Choice;
using Cube = std::array<std::int64_t, 8>;

constexpr std::array<std::array<unsigned, 4>, 6> kSquares = {
    {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}}};

CubeDecision decide(const Cube& cube) {
  std::array<double, 8> values;
  for (std::size_t v = 0; v < 8; ++v) values[v] = static_cast<double>(cube[v]);
  return decide_cube<double>(values, 0.0);
}

/// Regions of the high corners on the surface of a cube, and of the low ones, with squares decided as said.
struct Surface {
  test::Pieces pieces{8};
  std::size_t high = 0, low = 0;

  Surface(const Cube& cube, unsigned high_squares) {
    // Bits before all else: g++ 12 miscompiles comparisons of what is >= 0 with a bit of high_squares.
    unsigned signature = 0;
    for (unsigned v = 0; v < 8; ++v) signature |= static_cast<unsigned>(cube[v] >= 0) << v;
    const auto sign = [&](unsigned v) { return signature >> v & 1u; };
    for (unsigned v = 0; v < 8; ++v)
      for (unsigned step = 1; step < 8; step *= 2)
        if (sign(v) == sign(v ^ step)) pieces.join(v, v ^ step);
    for (unsigned q = 0; q < 6; ++q) {
      const auto& s = kSquares[q];
      if (sign(s[0]) != sign(s[3]) || sign(s[1]) != sign(s[2]) || sign(s[0]) == sign(s[1])) continue;
      const unsigned joined = high_squares >> q & 1u;
      const std::size_t first = sign(s[0]) == joined ? 0 : 1;
      pieces.join(s[first], s[3 - first]);
    }
    for (unsigned v = 0; v < 8; ++v)
      if (pieces.find(v) == v) ++(sign(v) != 0 ? high : low);
  }
};

/// Pieces of {f >= 0} in the cube, by a sweep.
std::size_t high_pieces(const Cube& cube) {
  test::Pieces pieces(8);
  const test::Stack stack(cube, 2);
  stack.high_part([&](int v, int w) { pieces.join(static_cast<std::size_t>(v), static_cast<std::size_t>(w)); });
  std::size_t count = 0;
  for (std::size_t v = 0; v < 8; ++v) count += cube[v] >= 0 && pieces.find(v) == v;
  return count;
}

/// The same of {f < 0}, which is {f <= -1 / scale}, with the largest scale that the sweep takes. A critical value of
/// samples up to 20 is 0 or larger than that.
std::size_t low_pieces(const Cube& cube) {
  std::int64_t most = 1;
  for (const std::int64_t value : cube) most = std::max(most, std::abs(value));
  const std::int64_t scale = (test::kLargestSample - 1) / most;
  Cube inverted;
  for (std::size_t v = 0; v < 8; ++v) inverted[v] = -cube[v] * scale - 1;
  return high_pieces(inverted);
}

/// What the decision of a cube says: pieces of high and low.
std::pair<std::size_t, std::size_t> decided_pieces(const Cube& cube) {
  const CubeDecision decision = decide(cube);
  const Surface surface(cube, decision.high_squares);
  return {surface.high - (decision.centre == Choice::high ? 1 : 0),
          surface.low - (decision.centre == Choice::low ? 1 : 0)};
}

TEST(Saddle, PiecesOfRandomCubesAreThoseOfTheTrilinearInterpolant) {
  std::mt19937_64 random(1);
  std::array<int, 3> choices{};
  for (const std::int64_t most : {1, 2, 3, 5, 20, 1000, 1000000})
    for (int i = 0; i < 20000; ++i) {
      std::uniform_int_distribution<std::int64_t> sample(-most, most);
      Cube cube;
      for (auto& value : cube) value = sample(random);
      const auto expected = std::pair{high_pieces(cube), low_pieces(cube)};
      ASSERT_EQ(decided_pieces(cube), expected) << ::testing::PrintToString(cube);
      ++choices[static_cast<std::size_t>(decide(cube).centre)];
    }
  for (const int count : choices) EXPECT_GT(count, 50);
}

}  // namespace
}  // namespace tegl
