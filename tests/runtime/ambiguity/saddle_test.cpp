// SPDX-License-Identifier: BSD-3-Clause
//
// The decisions for the bilinear and the trilinear interpolant in a square and a cube, by signs of polynomials:
// compared with sweeps, fine grids and the cases of the literature; and the fast decision against the exact one.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "ambiguity/saddle.hpp"
#include "multilinear.hpp"
#include "named_cells.hpp"
#include "tegl/saddle.hpp"

namespace tegl {
namespace {

using tile::Choice;
using Cube = std::array<std::int64_t, 8>;
using Values = std::array<double, 8>;

constexpr std::array<std::array<unsigned, 4>, 6> kSquares = {
    {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}}};

Values as_values(const Cube& cube) {
  Values values;
  std::transform(cube.begin(), cube.end(), values.begin(), [](std::int64_t x) { return static_cast<double>(x); });
  return values;
}

unsigned signature_of(const Values& values, double isovalue = 0.0) { return detail::signature_of(values, isovalue); }

bool is_ambiguous(unsigned signature, const std::array<unsigned, 4>& square) {
  const auto sign = [&](unsigned i) { return signature >> square[i] & 1u; };
  return sign(0) == sign(3) && sign(1) == sign(2) && sign(0) != sign(1);
}

unsigned ambiguous_squares(unsigned signature) {
  unsigned result = 0;
  for (unsigned q = 0; q < 6; ++q) result |= static_cast<unsigned>(is_ambiguous(signature, kSquares[q])) << q;
  return result;
}

/// Components of the high and of the low corners on the surface of a cube with decided squares.
struct Surface {
  test::Pieces pieces{8};
  std::size_t high = 0, low = 0;

  Surface(unsigned signature, unsigned high_squares) {
    const auto sign = [&](unsigned v) { return signature >> v & 1u; };
    for (unsigned v = 0; v < 8; ++v)
      for (unsigned step = 1; step < 8; step *= 2)
        if (sign(v) == sign(v ^ step)) pieces.join(v, v ^ step);
    for (unsigned q = 0; q < 6; ++q) {
      const auto& s = kSquares[q];
      if (!is_ambiguous(signature, s)) continue;
      const std::size_t first = sign(s[0]) == (high_squares >> q & 1u) ? 0 : 1;
      pieces.join(s[first], s[3 - first]);
    }
    for (unsigned v = 0; v < 8; ++v)
      if (pieces.find(v) == v) ++(sign(v) != 0 ? high : low);
  }
};

/// Components of {f >= 0} in the cube, by a sweep.
std::size_t high_pieces(const Cube& cube) {
  test::Pieces pieces(8);
  const test::Stack stack(cube, 2);
  stack.high_part([&](int v, int w) { pieces.join(static_cast<std::size_t>(v), static_cast<std::size_t>(w)); });
  std::size_t count = 0;
  for (std::size_t v = 0; v < 8; ++v) count += cube[v] >= 0 && pieces.find(v) == v;
  return count;
}

/// Components of {f < 0}, which equals {f <= -1 / scale}, with the largest scale that the sweep supports. For samples
/// up to 20 a critical value is 0 or larger than 1 / scale.
std::size_t low_pieces(const Cube& cube) {
  std::int64_t most = 1;
  for (const std::int64_t value : cube) most = std::max(most, std::abs(value));
  const std::int64_t scale = (test::kLargestSample - 1) / most;
  Cube inverted;
  for (std::size_t v = 0; v < 8; ++v) inverted[v] = -cube[v] * scale - 1;
  return high_pieces(inverted);
}

using Counts = std::pair<std::size_t, std::size_t>;

/// Components of high and low according to the decision of a cube.
Counts decided_pieces(const Values& values) {
  const CubeDecision decision = decide_cube<double>(values, 0.0);
  const Surface surface(signature_of(values), decision.high_squares);
  return {surface.high - (decision.centre == Choice::high ? 1 : 0),
          surface.low - (decision.centre == Choice::low ? 1 : 0)};
}

Cube random_cube(std::mt19937_64& random, std::int64_t most) {
  std::uniform_int_distribution<std::int64_t> sample(-most, most);
  Cube cube;
  for (auto& value : cube) value = sample(random);
  return cube;
}

TEST(Saddle, PiecesOfRandomCubesAreThoseOfTheTrilinearInterpolant) {
  std::mt19937_64 random(1);
  std::array<int, 3> choices{};
  for (const std::int64_t most : {1, 2, 3, 5, 20, 1000, 1000000})
    for (int i = 0; i < 20000; ++i) {
      const Cube cube = random_cube(random, most);
      ASSERT_EQ(decided_pieces(as_values(cube)), (Counts{high_pieces(cube), low_pieces(cube)}))
          << ::testing::PrintToString(cube);
      ++choices[static_cast<std::size_t>(cube_choice<double>(as_values(cube), 0.0))];
    }
  for (const int count : choices) EXPECT_GT(count, 50);
}

/// Components of high and low by neighbours in a grid of n^3 small cubes. Only neighbours between which f is linear are
/// joined, so the numbers are upper bounds.
Counts grid_pieces(const Cube& cube, std::int64_t n) {
  const std::int64_t m = n + 1;
  std::vector<bool> is_high(static_cast<std::size_t>(m * m * m));
  test::Pieces pieces(is_high.size());
  const auto weight = [&](std::int64_t at, unsigned side) { return side != 0 ? at : n - at; };
  Counts counts{0, 0};
  for (std::int64_t z = 0, i = 0; z < m; ++z)
    for (std::int64_t y = 0; y < m; ++y)
      for (std::int64_t x = 0; x < m; ++x, ++i) {
        std::int64_t f = 0;
        for (unsigned v = 0; v < 8; ++v) f += cube[v] * weight(x, v & 1u) * weight(y, v & 2u) * weight(z, v & 4u);
        const auto here = static_cast<std::size_t>(i);
        is_high[here] = f >= 0;
        if (x > 0 && is_high[here - 1] == is_high[here]) pieces.join(here, here - 1);
        const auto row = static_cast<std::size_t>(m), layer = static_cast<std::size_t>(m * m);
        if (y > 0 && is_high[here - row] == is_high[here]) pieces.join(here, here - row);
        if (z > 0 && is_high[here - layer] == is_high[here]) pieces.join(here, here - layer);
      }
  for (std::size_t i = 0; i < is_high.size(); ++i)
    if (pieces.find(i) == i) ++(is_high[i] ? counts.first : counts.second);
  return counts;
}

TEST(Saddle, PiecesInGridsAreThoseDecidedOrTooThinForTheGrid) {
  std::mt19937_64 random(2);
  int thin = 0, tunnels = 0;
  for (int i = 0; i < 4000 || tunnels < 100; ++i) {
    const Cube cube = random_cube(random, 1000);
    const CubeDecision decision = decide_cube<double>(as_values(cube), 0.0);
    if (decision.centre == Choice::separate && i >= 4000) continue;
    tunnels += decision.centre != Choice::separate;
    const Counts decided = decided_pieces(as_values(cube));
    Counts found;
    for (const std::int64_t n : {8, 16, 48}) {
      found = grid_pieces(cube, n);
      ASSERT_GE(found.first, decided.first) << ::testing::PrintToString(cube);
      ASSERT_GE(found.second, decided.second) << ::testing::PrintToString(cube);
      if (found == decided) break;
    }
    thin += found != decided;
  }
  EXPECT_LT(thin, 60);
}

/// Ways to join components of `signature`'s high corners by the planes across an axis: each as a list of components.
using Outcome = std::array<std::size_t, 8>;
std::set<Outcome> outcomes_of(unsigned signature, const Surface& surface, unsigned axis, int& pairs) {
  const auto has = [&](unsigned v) { return (signature >> v & 1u) != 0; };
  std::vector<std::array<unsigned, 2>> joins;
  const unsigned step = 1u << axis, x = 1u << (axis + 1) % 3, y = 1u << (axis + 2) % 3;
  test::Pieces regions = surface.pieces;
  for (const auto& [a, c, b, d] : {std::array{0u, x | y, x, y}, std::array{x, y, 0u, x | y}}) {
    const unsigned end = has(a) ? a : a | step, other = has(c) ? c : c | step;
    const bool others_stay = (has(b) && has(b | step)) || (has(d) && has(d | step));
    if (has(end) && has(other) && !others_stay && regions.find(end) != regions.find(other))
      joins.push_back({end, other});
  }
  pairs = static_cast<int>(joins.size());
  std::set<Outcome> result;
  for (unsigned some = 0; some < 1u << joins.size(); ++some) {
    test::Pieces joined = surface.pieces;
    for (std::size_t j = 0; j < joins.size(); ++j)
      if ((some >> j & 1u) != 0) joined.join(joins[j][0], joins[j][1]);
    Outcome least{};
    for (unsigned v = 0; v < 8; ++v)
      for (unsigned w = 8; w-- > 0;)
        if (has(v) && has(w) && joined.find(v) == joined.find(w)) least[v] = w + 1;
    result.insert(least);
  }
  return result;
}

TEST(Saddle, OnlyTwoRegionsAreEverJoinedAndOnePairOfEdgesTellsWhether) {
  int entries = 0, with_high = 0, with_low = 0, with_both = 0;
  for (unsigned signature = 0; signature < 256; ++signature) {
    const unsigned ambiguous = ambiguous_squares(signature);
    unsigned high_squares = 0;
    do {
      ++entries;
      std::array<bool, 2> joinable{};
      for (const bool low : {false, true}) {
        const unsigned corners = low ? ~signature & 0xffu : signature;
        const Surface surface(corners, low ? ~high_squares : high_squares);
        std::array<int, 3> pairs{};
        std::set<Outcome> common = outcomes_of(corners, surface, 0, pairs[0]);
        for (const unsigned axis : {1u, 2u}) {
          const std::set<Outcome> others = outcomes_of(corners, surface, axis, pairs[axis]);
          std::erase_if(common, [&](const Outcome& outcome) { return !others.contains(outcome); });
        }
        joinable[low ? 1 : 0] = common.size() > 1;
        if (common.size() == 1) continue;
        EXPECT_EQ(surface.high, 2u) << signature;
        EXPECT_NE(std::count(pairs.begin(), pairs.end(), 1), 0) << signature;
      }
      with_high += joinable[0];
      with_low += joinable[1];
      with_both += joinable[0] && joinable[1];
      high_squares = (high_squares - ambiguous) & ambiguous;
    } while (high_squares != 0);
  }
  EXPECT_EQ(entries, 656);
  EXPECT_EQ(with_high, 98);
  EXPECT_EQ(with_low, 98);
  EXPECT_EQ(with_both, 8);
}

/// Maps corner v to corner_of(v): exchanges and reverses axes.
struct Symmetry {
  std::array<unsigned, 3> axes;
  unsigned flip;
  [[nodiscard]] unsigned corner_of(unsigned v) const {
    unsigned result = 0;
    for (unsigned a = 0; a < 3; ++a) result |= (v >> a & 1u) << axes[a];
    return result ^ flip;
  }
  [[nodiscard]] unsigned square_of(unsigned square) const {
    const unsigned axis = axes[square / 2];
    return 2 * axis + ((square & 1u) ^ (flip >> axis & 1u));
  }
};

std::vector<Symmetry> symmetries() {
  std::vector<Symmetry> result;
  std::array<unsigned, 3> axes = {0, 1, 2};
  do
    for (unsigned flip = 0; flip < 8; ++flip) result.push_back({axes, flip});
  while (std::next_permutation(axes.begin(), axes.end()));
  return result;
}

template <class Value>
std::array<Value, 8> moved(const Symmetry& symmetry, const std::array<Value, 8>& cube) {
  std::array<Value, 8> result;
  for (unsigned v = 0; v < 8; ++v) result[symmetry.corner_of(v)] = cube[v];
  return result;
}

CubeDecision moved(const Symmetry& symmetry, CubeDecision decision) {
  unsigned squares = 0;
  for (unsigned q = 0; q < 6; ++q) squares |= (decision.high_squares >> q & 1u) << symmetry.square_of(q);
  decision.high_squares = static_cast<std::uint8_t>(squares);
  return decision;
}

/// Values for which rounding matters: a product of a difference and a factor, changed by a few units in the last place.
Values nearly_degenerate(std::mt19937_64& random, double isovalue) {
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const double size = std::ldexp(1.0, pick(3) == 0 ? pick(600) - 300 : 0);
  std::uniform_real_distribution<double> uniform(-size, size);
  Values f;
  for (auto& x : f) x = pick(4) == 0 ? size * (pick(5) - 2) : uniform(random);
  if (pick(2) == 0)  // nearly degenerate in one square, or in all squares across an axis
    f[3] = f[1] * f[2] / f[0];
  if (pick(2) == 0) {
    const double slope = uniform(random) / size;
    for (unsigned v = 0; v < 4; ++v) f[v + 4] = f[v] * slope;
  }
  if (pick(2) == 0) f[7] = f[4] * f[3] / f[0];
  Values values;
  for (unsigned v = 0; v < 8; ++v) {
    values[v] = f[v] + isovalue;
    for (int i = pick(4); i > 0; --i) values[v] = std::nextafter(values[v], uniform(random));
    if (!std::isfinite(values[v])) values[v] = isovalue;
  }
  return values;
}

TEST(Saddle, FilteredDecisionsAreTheExactOnes) {
  std::mt19937_64 random(3);
  int differ = 0;
  for (int i = 0; i < 400000; ++i) {
    const double isovalue = i % 3 == 0 ? 0.0 : std::ldexp(static_cast<double>(random() % 1000), -(i % 7) - 3);
    const Values values = nearly_degenerate(random, isovalue);
    const CubeDecision exact = detail::decide_cube_exactly(values, isovalue);
    differ += !(decide_cube<double>(values, isovalue) == exact);
    differ += !(detail::decide_squares(values, isovalue, signature_of(values, isovalue)) ==
                CubeDecision{exact.high_squares, Choice::separate});
    for (const auto& s : kSquares) {
      const std::array<double, 4> square = {values[s[0]], values[s[1]], values[s[2]], values[s[3]]};
      if (is_ambiguous(signature_of(values, isovalue), s))
        differ += detail::square_is_high(square, isovalue) != detail::square_is_high_exactly(square, isovalue);
    }
  }
  EXPECT_EQ(differ, 0);
}

TEST(Saddle, DecisionsMoveWithTheSymmetriesOfTheCube) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 6000; ++i) {
    const Values values = i % 2 == 0 ? as_values(random_cube(random, 1 + i % 11)) : nearly_degenerate(random, 0.0);
    const CubeDecision decision = decide_cube<double>(values, 0.0);
    for (const Symmetry& symmetry : symmetries())
      ASSERT_EQ(decide_cube<double>(moved(symmetry, values), 0.0), moved(symmetry, decision))
          << ::testing::PrintToString(values);
  }
}

TEST(Saddle, WithSignsExchangedHighAndLowAreExchangedAwayFromTies) {
  std::mt19937_64 random(5);
  int tunnels = 0;
  for (int i = 0; i < 50000; ++i) {
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Values values, inverted;
    for (unsigned v = 0; v < 8; ++v) inverted[v] = -(values[v] = uniform(random));
    const CubeDecision decision = decide_cube<double>(values, 0.0), other = decide_cube<double>(inverted, 0.0);
    ASSERT_EQ(decision.high_squares ^ other.high_squares, ambiguous_squares(signature_of(values)));
    tunnels += decision.centre != Choice::separate;
    const Choice exchanged = decision.centre == Choice::high  ? Choice::low
                             : decision.centre == Choice::low ? Choice::high
                                                              : Choice::separate;
    ASSERT_EQ(other.centre, exchanged);
  }
  EXPECT_GT(tunnels, 100);
}

TEST(Saddle, ScalesAndOffsetsThatRoundNothingChangeNothing) {
  std::mt19937_64 random(6);
  for (int i = 0; i < 3000; ++i) {
    const Values values = as_values(random_cube(random, 1 + i % 100));
    const CubeDecision decision = decide_cube<double>(values, 0.0);
    // Products of two values near 2^-537 are near the smallest doubles and coarsely rounded.
    for (const int exponent : {-1070, -700, -539, -538, -537, -1, 1, 500, 1000}) {
      Values scaled, shifted;
      for (unsigned v = 0; v < 8; ++v) {
        scaled[v] = std::ldexp(values[v], exponent);
        shifted[v] = std::ldexp(values[v] + 3.0, exponent);
      }
      ASSERT_EQ(decide_cube<double>(scaled, 0.0), decision) << exponent;
      ASSERT_EQ(decide_cube<double>(shifted, std::ldexp(3.0, exponent)), decision) << exponent;
    }
  }
}

template <class T>
class SaddleOfType : public ::testing::Test {};
using Types = ::testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::int32_t, float, double>;
TYPED_TEST_SUITE(SaddleOfType, Types);

TYPED_TEST(SaddleOfType, DecidesAsTheSameNumbersInOtherTypes) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 2000; ++i) {
    const double isovalue = i % 2 == 0 ? 50.0 : 49.7;
    std::array<TypeParam, 8> values;
    Values doubles;
    for (unsigned v = 0; v < 8; ++v)
      values[v] = static_cast<TypeParam>(doubles[v] = static_cast<double>(random() % 101));
    ASSERT_EQ(decide_cube<TypeParam>(values, isovalue), detail::decide_cube_exactly(doubles, isovalue));
    ASSERT_EQ(cube_choice<TypeParam>(values, isovalue), detail::decide_cube_exactly(doubles, isovalue).centre);
    const std::array<TypeParam, 4> square = {values[0], values[1], values[2], values[3]};
    if (!is_ambiguous(signature_of(doubles, isovalue), kSquares[4])) continue;
    ASSERT_EQ(square_is_high<TypeParam>(square, isovalue),
              (detail::decide_cube_exactly(doubles, isovalue).high_squares >> 4 & 1) != 0);
  }
}

TEST(Saddle, TiesOfTheLargestAndLeastIntegersAreExact) {
  // 46341^2 = 2147488281: differences whose products differ by one part in 2^62.
  const std::int32_t most = std::numeric_limits<std::int32_t>::max(), least = std::numeric_limits<std::int32_t>::min();
  EXPECT_TRUE((square_is_high<std::int32_t>(std::array{most, least, -1 - most, most}, 0.0) ==
               (std::int64_t{most} * most >= std::int64_t{least} * least)));
  EXPECT_TRUE(square_is_high<std::int32_t>(std::array{most, -most, -most, most}, 0.0));
  EXPECT_FALSE(square_is_high<std::int32_t>(std::array{most, -most, -most, most - 1}, 0.0));
  EXPECT_TRUE(square_is_high<std::int32_t>(std::array{-most, most, most - 1, 2 - most}, 0.0));
  EXPECT_FALSE(square_is_high<std::int32_t>(std::array{-most, most, most - 2, 1 - most}, 0.0));
}

TEST(Saddle, WhatIsRoundedOffAtTheIsovalueDecides) {
  const std::array<double, 4> even = {1.0, -1.0, -1.0, 1.0}, odd = {-1.0, 1.0, 1.0, -1.0};
  for (const auto& square : {even, odd}) {
    EXPECT_TRUE(square_is_high<double>(square, 0.0));
    EXPECT_FALSE(square_is_high<double>(square, 0x1p-60));
    EXPECT_TRUE(square_is_high<double>(square, -0x1p-60));
    EXPECT_FALSE(square_is_high<double>(square, 5e-324));
  }
  // The double cone.
  const Values cone = {-1.0, -1.0, -1.0, 3.0, 3.0, -1.0, -1.0, -1.0};
  EXPECT_EQ(cube_choice<double>(cone, 0.0), Choice::high);
  EXPECT_EQ(cube_choice<double>(cone, 0x1p-60), Choice::separate);
  EXPECT_EQ(cube_choice<double>(cone, -0x1p-60), Choice::high);
}

TEST(Saddle, InfiniteValuesAreLargeAndNothingIsUndefined) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(square_is_high<double>(std::array{inf, -1.0, -1.0, 1.0}, 0.0));
  EXPECT_FALSE(square_is_high<double>(std::array{1.0, -inf, -1.0, 1.0}, 0.0));
  EXPECT_TRUE(square_is_high<double>(std::array{inf, -inf, -1.0, 1.0}, 0.0));
  EXPECT_FALSE(square_is_high<double>(std::array{inf, -inf, -2.0, 1.0}, 0.0));
  EXPECT_TRUE(square_is_high<double>(std::array{1e308, -1e308, -1e-308, 1e-308}, 0.0));
  std::mt19937_64 random(8);
  const std::array<double, 9> values = {inf,    -inf,   nan, 0.0, 1.0, -1.0, std::numeric_limits<double>::max(),
                                        5e-324, -5e-324};
  for (int i = 0; i < 20000; ++i) {
    Values cube;
    for (auto& x : cube) x = values[random() % values.size()];
    const double isovalue = values[3 + random() % 6];
    ASSERT_EQ(decide_cube<double>(cube, isovalue), detail::decide_cube_exactly(cube, isovalue));
  }
}

/// Components and Euler characteristic of the contour that a decision describes.
std::pair<int, int> contour_of(const Values& values) {
  const CubeDecision decision = decide_cube<double>(values, 0.0);
  const Surface surface(signature_of(values), decision.high_squares);
  if (surface.high == 0 || surface.low == 0) return {0, 0};
  const int loops = static_cast<int>(surface.high + surface.low) - 1;
  const int joined = decision.centre == Choice::separate ? 0 : 1;
  return {loops - joined, loops - 2 * joined};
}

TEST(Saddle, ContoursOfRandomCubesAreDiscsAndAtMostOneTunnel) {
  std::mt19937_64 random(9);
  for (int i = 0; i < 40000; ++i) {
    const Cube cube = random_cube(random, i % 2 == 0 ? 100 : 100000000);
    const auto expected = test::interpolant_topology<3>({{2, 2, 2}, {cube.begin(), cube.end()}});
    if (!expected.regular) continue;
    const std::pair<std::int64_t, std::int64_t> found = contour_of(as_values(cube));
    ASSERT_EQ(found, (std::pair{expected.contour.components, expected.contour.euler}))
        << ::testing::PrintToString(cube);
  }
}

TEST(Saddle, NamedCubesHaveTheContoursOfTheLiterature) {
  for (const auto& cell : test::kNamedCubes)
    for (const Symmetry& symmetry : symmetries()) {
      Values values, inverted;
      for (unsigned v = 0; v < 8; ++v) inverted[v] = -(values[v] = cell.values[v]);
      ASSERT_EQ(contour_of(moved(symmetry, values)), (std::pair{cell.components, cell.euler})) << cell.name;
      if (!cell.regular) continue;
      ASSERT_EQ(contour_of(moved(symmetry, inverted)), (std::pair{cell.components, cell.euler})) << cell.name;
    }
}

TEST(Saddle, NamedSquaresHaveTheContoursOfTheLiterature) {
  for (const auto& cell : test::kNamedSquares) {
    std::array<double, 4> values;
    unsigned signature = 0;
    for (unsigned v = 0; v < 4; ++v) {
      values[v] = cell.values[v];
      signature |= static_cast<unsigned>(cell.values[v] >= 0) << v;
    }
    const bool ambiguous = signature == 6 || signature == 9;
    EXPECT_EQ(cell.components, ambiguous ? 2 : signature == 0 || signature == 15 ? 0 : 1) << cell.name;
    if (!ambiguous) continue;
    const test::SampledField<2> field{{2, 2}, {cell.values.begin(), cell.values.end()}};
    EXPECT_EQ(square_is_high<double>(values, 0.0), test::interpolant_topology(field).high.components == 1) << cell.name;
  }
}

}  // namespace
}  // namespace tegl
