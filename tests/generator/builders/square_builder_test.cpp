// SPDX-License-Identifier: BSD-3-Clause
//
// The emitted builders of the square, as compiled.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "builder2.hpp"
#include "builder2_edges.hpp"
#include "builder_checks.hpp"
#include "tegl/generated/tables.hpp"

namespace tegl::test {
namespace {

builders::SquareContour square_by_table(unsigned signature, bool centre_high) {
  builders::SquareContour contour;
  builders::build_square(signature, centre_high, contour);
  return contour;
}

builders::edges::SquareContour square_by_edges(unsigned signature, bool centre_high) {
  builders::edges::SquareContour contour;
  builders::edges::build_square(signature, centre_high, contour);
  return contour;
}

TEST(SquareBuilder, ByTableIsTheContourOfTheGeneralBuilderAndOfTheDefinition) {
  EXPECT_EQ(fault_of_squares(square_by_table), "");
}

TEST(SquareBuilder, ByEdgesIsTheContourOfTheGeneralBuilderAndOfTheDefinition) {
  EXPECT_EQ(fault_of_squares(square_by_edges), "");
}

TEST(SquareBuilder, TableAndEdgesGiveTheSameBytes) {
  for (unsigned signature = 0; signature < 16; ++signature)
    for (const bool high : {false, true})
      EXPECT_EQ(facets_of_square(square_by_table(signature, high)), facets_of_square(square_by_edges(signature, high)))
          << signature;
}

TEST(SquareBuilder, WithLowCentreItHasTheSegmentsOfTheTable) {
  const tables::TileTable& table = tables::kTile2Compact;
  for (unsigned signature = 0; signature < 16; ++signature) {
    const tables::List& list = table.lists[table.list_of[signature]];
    const builders::SquareContour contour = square_by_table(signature, false);
    ASSERT_EQ(contour.count, list.simplex_count);
    EXPECT_TRUE(std::equal(contour.segments[0], contour.segments[0] + 2 * contour.count,
                           table.simplices + 2 * std::size_t{list.first_simplex}))
        << signature;
  }
}

TEST(SquareBuilder, TwoSignaturesAreAmbiguous) {
  for (unsigned signature = 0; signature < 16; ++signature)
    EXPECT_EQ(builders::is_ambiguous_square(signature), facets_of_square(square_by_table(signature, false)) !=
                                                            facets_of_square(square_by_table(signature, true)));
}

}  // namespace
}  // namespace tegl::test
