// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate in five dimensions: random tiles, every choice in every face at random.
#include <gtest/gtest.h>

#include "filling/resolutions.hpp"
#include "share.hpp"

namespace tegl::gen {
namespace {

constexpr std::size_t kShare = test::unless_sanitized(1500, 200);

TEST(ResolutionsIn5D, RandomTilesPass) {
  const std::uint64_t tiles = test::cases_to_test(10000, kShare);
  const ResolutionFigures figures = certify_sample(TileKind::cube, 5, tiles, 5, 0);
  EXPECT_EQ(figures.tiles, tiles);
  for (const std::uint64_t facets : figures.by_filling) EXPECT_GT(facets, tiles / 20) << "a way of filling hardly seen";
  EXPECT_GT(figures.euler.at(0), tiles) << "tiles with several components";
}

}  // namespace
}  // namespace tegl::gen
