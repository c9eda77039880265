// SPDX-License-Identifier: BSD-3-Clause
//
// The emitted builder of 5-cubes: its tiles pass the certificate, join what the general builder joins, and have the
// components of the definition. The tests of copies with faults show that each of these checks can fail.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "builder5_edges.hpp"
#include "five_cube_beside.hpp"
#include "five_cube_checks.hpp"
#include "five_cube_high_side.hpp"
#include "five_cube_map.hpp"
#include "five_cube_sign.hpp"
#include "five_cube_square.hpp"
#include "share.hpp"

namespace tegl::test {
namespace {

using Checks = FiveCubeChecks<builders::FiveCubeBuilder, builders::FiveKey, builders::FiveCube>;

constexpr std::size_t kShare = unless_sanitized(1000, 100);

TEST(FiveCubeBuilder, RandomTilesPassTheCertificateAndAgreeWithTheGeneralBuilder) {
  const std::size_t tiles = cases_to_test(100'000, kShare);
  for (const FiveKeys how : kAllFiveKeys)
    EXPECT_EQ(Checks().fault_of_random(how, tiles / kAllFiveKeys.size()), "") << static_cast<int>(how);
}

TEST(FiveCubeBuilder, ComponentsAreThoseOfTheDefinition) {
  Checks checks;
  std::mt19937_64 random(3);
  for (int i = 0; i < 20'000; ++i) ASSERT_EQ(checks.fault_by_definition(static_cast<std::uint32_t>(random())), "");
}

/// A random key in which each face and the tile have a centre, low or high.
template <class Key>
Key random_centres(std::mt19937_64& random, FiveKeys how) {
  Key key = random_five_key<Key>(random, how);
  key.high_cubes = ~key.low_cubes & 0xff'ffff'ffffu;
  key.high_tesseracts = static_cast<std::uint16_t>(~unsigned{key.low_tesseracts} & 0x3ffu);
  key.tile = random() % 2 == 0 ? tile::Choice::low : tile::Choice::high;
  return key;
}

TEST(FiveCubeBuilder, FacetsAreThoseOfTheDefinition) {
  Checks checks;
  std::mt19937_64 random(5);
  const std::size_t tiles = cases_to_test(20'000, unless_sanitized(600, 100));
  for (std::size_t i = 0; i < tiles; ++i) {
    const FiveKeys how = i % 2 == 0 ? FiveKeys::resolved : FiveKeys::few_high_resolved;
    ASSERT_EQ(checks.fault_by_centres(random_centres<builders::FiveKey>(random, how)), "");
  }
}

TEST(FiveCubeBuilder, OwnVerticesLieInsideTheirFaces) {
  Checks checks;
  for (const FiveKeys how : kAllFiveKeys) {
    std::mt19937_64 random(8);
    for (std::size_t i = 0; i < unless_sanitized(4000, 400); ++i)
      ASSERT_EQ(checks.fault_of_own_vertices(random_five_key<builders::FiveKey>(random, how)), "");
  }
}

TEST(FiveCubeBuilder, OneHighCornerIsCutOffByOneSimplex) {
  builders::FiveCubeBuilder builder;
  for (unsigned v = 0; v < 32; ++v) {
    builders::FiveKey key;
    key.signature = 1u << v;
    const auto contour = builder.build(key);
    EXPECT_EQ(contour.simplices.size(), 1u);
    EXPECT_TRUE(contour.own.empty());
    EXPECT_TRUE(contour.is_settled);
  }
}

/// A key with the faces of another.
builders::edges::FiveKey as_edges(const builders::FiveKey& key) {
  return {key.signature,      key.high_squares,    key.low_cubes, key.high_cubes,
          key.low_tesseracts, key.high_tesseracts, key.tile};
}

TEST(FiveCubeBuilder, FromTheEdgesIsTheSameAsByTables) {
  builders::FiveCubeBuilder by_tables;
  builders::edges::FiveCubeBuilder from_edges;
  for (const FiveKeys how : kAllFiveKeys) {
    std::mt19937_64 random(11);
    for (int i = 0; i < 2000; ++i) {
      const auto key = random_five_key<builders::FiveKey>(random, how);
      const auto expected = by_tables.build(key);
      const auto contour = from_edges.build(as_edges(key));
      ASSERT_TRUE(std::equal(contour.simplices.begin(), contour.simplices.end(), expected.simplices.begin(),
                             expected.simplices.end()))
          << key.signature;
      ASSERT_EQ(contour.own.size(), expected.own.size());
      ASSERT_EQ(contour.components, expected.components);
      ASSERT_EQ(contour.side_copies, expected.side_copies);
      ASSERT_EQ(contour.is_settled, expected.is_settled);
      for (unsigned c = 0; c < 40; ++c) {
        ASSERT_EQ(from_edges.cube_vertices(c), by_tables.cube_vertices(c));
        for (unsigned j = 0; j < by_tables.cube_vertices(c); ++j)
          ASSERT_EQ(from_edges.cube_mask(c, j), by_tables.cube_mask(c, j));
      }
      for (std::size_t v = 0; v < contour.own.size(); ++v) {
        ASSERT_EQ(contour.own[v].points.corners, expected.own[v].points.corners);
        ASSERT_EQ(contour.own[v].points.edges, expected.own[v].points.edges);
        ASSERT_EQ(contour.own[v].repeat, expected.own[v].repeat);
        ASSERT_EQ(contour.own[v].face, expected.own[v].face);
      }
    }
  }
}

/// What is wrong with the first of a few tiles of a copy of the builder with a fault: the message of a check, or of the
/// exception of a builder that finds no closed manifold; "" if nothing is.
template <class Builder, class Key, class Cube>
std::string fault_found() {
  for (const FiveKeys how : kAllFiveKeys) try {
      std::string fault = FiveCubeChecks<Builder, Key, Cube>().fault_of_random(how, 40);
      if (!fault.empty()) return fault;
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
  return "";
}

// The templates of fault_found for the fault in namespace `space`.
#define TEGL_FAULT(space) \
  fault_found<builders::space::FiveCubeBuilder, builders::space::FiveKey, builders::space::FiveCube>

TEST(FaultyBuilder, OfThe5CubeIsFound) {
  using testing::HasSubstr;
  EXPECT_THAT((TEGL_FAULT(five_cube_map)()), HasSubstr("a triangle in a single tetrahedron"));
  EXPECT_THAT((TEGL_FAULT(five_cube_sign)()), HasSubstr("orientation"));
  EXPECT_THAT((TEGL_FAULT(five_cube_square)()), HasSubstr("a triangle in a single tetrahedron"));
  EXPECT_THAT((TEGL_FAULT(five_cube_high_side)()), HasSubstr("facets join other vertices"));
}

TEST(FaultyBuilder, OfTheCopyOfAVertexWithoutCornersIsFound) {
  using namespace builders::five_cube_beside;
  EXPECT_THAT((FiveCubeChecks<FiveCubeBuilder, FiveKey, FiveCube>().fault_of_random(FiveKeys::squares, 4000)),
              testing::HasSubstr("a mean in the boundary of its face"));
}

TEST(FaultyBuilder, OfTheSideThatA5CubeJoinsDiffersFromTheDefinition) {
  using namespace builders::five_cube_high_side;
  FiveCubeChecks<FiveCubeBuilder, FiveKey, FiveCube> checks;
  std::mt19937_64 random(6);
  std::string fault;
  for (int i = 0; i < 200 && fault.empty(); ++i)
    fault = checks.fault_by_centres(random_centres<FiveKey>(random, FiveKeys::few_high_resolved));
  EXPECT_NE(fault, "");
}

}  // namespace
}  // namespace tegl::test
