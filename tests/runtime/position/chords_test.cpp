// SPDX-License-Identifier: BSD-3-Clause
//
// The smoothing of relaxed positions, for each instruction set, against the geometry of the squares around one edge.
#include "position/chords.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "only_targets.hpp"
#include "position/contour_net.hpp"

namespace tegl::test {
namespace {

using detail::ChordMoves;
using Side = detail::ContourNet<3>::Side;

/// Links of all sides to points anywhere, for `points` points with `curves` curves each.
std::vector<std::uint32_t> random_links(std::size_t points, int curves, std::mt19937_64& random) {
  std::vector<std::uint32_t> links(2 * points * static_cast<std::size_t>(curves));
  for (std::uint32_t& link : links) {
    const auto side = static_cast<std::uint32_t>(random() % 9 / 2 % 4);  // `across` more often than the others
    link = side == 3 ? ~std::uint32_t{0} : side << 30 | static_cast<std::uint32_t>(random() % points);
  }
  return links;
}

/// A neighbour in the plane of the point's edge (first coordinate, from 0 to 1) and the other axis, whose coordinate is
/// 0 at the edge: in the square before (-1 to 0) or after (0 to 1).
std::array<float, 2> neighbour(Side side, float place, bool before) {
  const float beyond = before ? place - 1 : place;
  switch (side) {
    case Side::across:
      return {place, before ? -1.0f : 1.0f};
    case Side::lower:
      return {0, beyond};
    default:
      return {1, beyond};
  }
}

/// The new position of point p by the definition: on the way to the weighted mean of its chords.
float moved(const ChordMoves& moves, const std::vector<float>& places, std::size_t p) {
  float sum = 0, all = 0;
  for (int c = 0; c < moves.curves; ++c) {
    const std::uint32_t* const links = moves.links + 2 * (static_cast<std::size_t>(c) * moves.points + p);
    std::array<std::array<float, 2>, 2> at;
    bool exist = true;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto side = static_cast<Side>(links[i] >> 30);
      exist = exist && side != Side::none;
      if (exist) at[i] = neighbour(side, places[links[i] & 0x3fffffffu], i == 0);
    }
    if (!exist) continue;
    const float before = -at[0][1], after = at[1][1];
    sum += (places[p] - (at[0][0] * after + at[1][0] * before) / (before + after)) * moves.weights[c];
    all += moves.weights[c];
  }
  if (!(all > 0)) return places[p];
  return std::clamp(places[p] - moves.factor * sum / all, moves.low, moves.high);
}

void expect_moves(std::size_t points, int curves, const std::array<float, 4>& weights, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const std::vector<std::uint32_t> links = random_links(points, curves, random);
  std::vector<float> places(points);
  for (float& place : places) place = 0.01f + 0.98f * static_cast<float>(random() >> 40) * 0x1p-24f;
  for (const float factor : {0.62f, -0.74f}) {
    const ChordMoves moves{links.data(), points, curves, weights.data(), factor, 0.01f, 0.99f};
    std::vector<float> of_first_target;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      const OnlyTargets only(target);
      SCOPED_TRACE(hwy::TargetName(target));
      // in two parts, of which the second may have no whole register
      const std::size_t middle = points - points / 3;
      std::vector<float> next(points + 1, -1.0f);
      detail::move_to_chords(moves, places.data(), 0, middle, next.data());
      EXPECT_EQ(next[middle], -1.0f) << "written past the end";
      detail::move_to_chords(moves, places.data(), middle, points, next.data());
      EXPECT_EQ(next.back(), -1.0f) << "written past the end";
      for (std::size_t p = 0; p < points; ++p) ASSERT_NEAR(next[p], moved(moves, places, p), 1e-6f) << p;
      if (of_first_target.empty()) of_first_target = next;
      EXPECT_EQ(std::memcmp(next.data(), of_first_target.data(), next.size() * sizeof(float)), 0);
    }
  }
}

TEST(Chords, MovesAreThoseOfTheDefinitionForAllInstructionSets) {
  for (const std::size_t points : {3, 16, 31, 200, 5001})
    for (int curves = 1; curves <= 4; ++curves)
      expect_moves(points, curves, {1.0f, 0.5f, 1.0f, 0.25f}, points * 10 + static_cast<std::size_t>(curves));
}

TEST(Chords, PointsWithoutWeightStay) { expect_moves(100, 2, {0, 0, 0, 0}, 5); }

}  // namespace
}  // namespace tegl::test
