// SPDX-License-Identifier: BSD-3-Clause
//
// Neighbouring tiles: the consistent tables leave no hole between two tiles, the table by class with inversion does,
// and the check detects injected holes.
#include "filling/pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "base/error.hpp"

namespace tegl::gen {
namespace {

std::vector<TileContour> all_contours(const ContourBuilder& builder) {
  std::vector<TileContour> contours;
  for (Signature s = 0; s <= builder.tile().full(); ++s) contours.push_back(builder.build(s));
  return contours;
}

TEST(Pairs, OfConsistentTablesMatchInEveryAlternativeAndTriangulation) {
  for (const int n : {2, 3}) {
    const CubeLattice lattice(n);
    for (const Alternative a : {Alternative::low, Alternative::high})
      for (const Triangulation t : {Triangulation::barycentric, Triangulation::compact}) {
        const ContourBuilder builder(lattice, n, a, t);
        const PairFigures figures = certify_pairs(builder, all_contours(builder));
        EXPECT_EQ(n == 2 ? 2u * 4 * 4 * 4 : 3u * 16 * 16 * 16, figures.pairs);
        EXPECT_EQ(0u, figures.unmatched) << unmatched_text(n, figures);
      }
  }
}

TEST(Pairs, OfTheTableByClassMatchUnlessHighAndLowAreExchanged) {
  for (const int n : {2, 3}) {
    const CubeLattice lattice(n);
    const ContourBuilder builder(lattice, n, Alternative::low, Triangulation::compact);
    for (const GroupKind kind : {GroupKind::Full, GroupKind::Rotations})
      for (const bool inversion : {false, true}) {
        const auto unmatched = certify_pairs(builder, contours_by_class(builder, kind, inversion)).unmatched;
        if (n == 3 && inversion) {
          EXPECT_GT(unmatched, 0u);
        } else {
          EXPECT_EQ(0u, unmatched);
        }
      }
  }
}

TEST(Pairs, ThatLeaveAHoleDisagreeOnAnAmbiguousFaceOnly) {
  const CubeLattice lattice(3);
  const Tile& tile = lattice.tile(3);
  const ContourBuilder builder(lattice, 3, Alternative::low, Triangulation::compact);
  const auto contours = contours_by_class(builder, GroupKind::Rotations, true);
  std::uint64_t holes = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (Signature below = 0; below < 256; ++below)
      for (Signature above = 0; above < 256; ++above) {
        const Signature face = tile.restrict_to(static_cast<std::uint32_t>(2 * axis + 1), below);
        if (face != tile.restrict_to(static_cast<std::uint32_t>(2 * axis), above)) continue;
        const auto open = open_simplices(builder, contours[below], contours[above], axis);
        if (open.empty()) continue;
        ++holes;
        EXPECT_EQ(4u, open.size());
        EXPECT_TRUE(face == 6 || face == 9) << face;
      }
  EXPECT_EQ(holes, certify_pairs(builder, contours).unmatched);
}

TEST(Pairs, ASingleTurnedOrMissingTriangleIsSeen) {
  const CubeLattice lattice(3);
  const ContourBuilder builder(lattice, 3, Alternative::low, Triangulation::compact);
  auto contours = all_contours(builder);
  auto& triangle = contours[1].facets.at(0).simplices.at(0);
  std::swap(triangle[0], triangle[1]);
  EXPECT_EQ(3u * 16, certify_pairs(builder, contours).unmatched) << "a corner's triangle meets three faces";
  contours[1].facets.clear();
  EXPECT_EQ(3u * 16, certify_pairs(builder, contours).unmatched);
}

TEST(Pairs, AContourThatEndsInsideItsTileIsRefused) {
  const CubeLattice lattice(3);
  const ContourBuilder builder(lattice, 3, Alternative::low, Triangulation::compact);
  auto contours = all_contours(builder);
  contours[3].facets.at(0).simplices.pop_back();  // half of a quadrilateral
  try {
    (void)certify_pairs(builder, contours);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(ErrorCode::Internal, error.code());
  }
}

TEST(Pairs, ByClassInFourDimensionsAreRefused) {
  const CubeLattice lattice(4);
  const ContourBuilder builder(lattice, 4, Alternative::low, Triangulation::compact);
  EXPECT_THROW((void)contours_by_class(builder, GroupKind::Full, false), Error);
}

}  // namespace
}  // namespace tegl::gen
