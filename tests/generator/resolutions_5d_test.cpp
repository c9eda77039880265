// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate in five dimensions: ten thousand tiles with random choices in every face. In a program of its own, as
// it takes more than a minute on two processors.
#include <gtest/gtest.h>

#include "filling/resolutions.hpp"

namespace tegl::gen {
namespace {

// Sanitizers make it ten times as slow, and a few tiles suffice for them.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::uint64_t kTiles = 200;
#else
constexpr std::uint64_t kTiles = 10000;
#endif

TEST(ResolutionsIn5D, TenThousandTilesPass) {
  const ResolutionFigures figures = certify_sample(TileKind::cube, 5, kTiles, 5, 0);
  EXPECT_EQ(figures.tiles, kTiles);
  for (const std::uint64_t facets : figures.by_filling)
    EXPECT_GT(facets, kTiles / 20) << "a way of filling hardly seen";
  EXPECT_GT(figures.euler.at(0), kTiles) << "tiles with several components";
}

}  // namespace
}  // namespace tegl::gen
