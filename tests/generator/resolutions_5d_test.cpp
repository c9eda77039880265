// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate in five dimensions: ten thousand tiles, every choice in every face at random. By itself, as it takes
// more than a minute on two processors.
#include <gtest/gtest.h>

#include "tegl/gen/resolutions.hpp"

namespace tegl::gen {
namespace {

TEST(ResolutionsIn5D, TenThousandTilesPass) {
  const ResolutionFigures figures = certify_sample(TileKind::cube, 5, 10000, 5, 0);
  EXPECT_EQ(figures.tiles, 10000u);
  EXPECT_GT(figures.non_spherical, 5000u);
}

}  // namespace
}  // namespace tegl::gen
