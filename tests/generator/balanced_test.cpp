// SPDX-License-Identifier: BSD-3-Clause
//
// Balanced fillings: a tile and its complement have the same simplices.
#include "filling/balanced.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "cubes/ambiguity.hpp"
#include "cubes/resolved_cube.hpp"

namespace tegl::gen {
namespace {

/// The simplices by ascending vertices, and the number of those that occur twice.
std::multiset<std::array<std::uint8_t, 4>> unoriented(const TileContour& contour) {
  std::multiset<std::array<std::uint8_t, 4>> result;
  for (const LocalFacet& facet : contour.facets)
    for (const LocalSimplex& s : facet.simplices) {
      std::array<std::uint8_t, 4> sorted{s[0], s[1], s[2], s[3]};
      std::sort(sorted.begin(), sorted.end());
      result.insert(sorted);
    }
  return result;
}

/// The first signature whose contour does not have the simplices of its complement's; 0 if there is none.
std::size_t unbalanced(const BalancedTesseracts& balanced) {
  for (std::size_t s = 1; s < 65535; ++s)
    if (unoriented(balanced.contours[s]) != unoriented(balanced.contours[65535 - s])) return s;
  return 0;
}

TEST(Balanced, TesseractsHaveTheSimplicesOfTheirComplements) {
  const Lattice lattice(TileKind::cube, 4);
  const auto depends_on_data = ambiguous_tesseracts();
  BalancedTesseracts balanced = make_balanced_tesseracts(lattice, depends_on_data);
  EXPECT_EQ(unbalanced(balanced), 0u);
  const ContourBuilder low(lattice, 4, Alternative::low, Triangulation::compact);
  std::uint64_t of_low = 0;
  bool low_is_balanced = true;
  for (std::size_t s = 1; s < 65535; ++s) {
    if (depends_on_data[s]) {
      ASSERT_TRUE(balanced.contours[s].facets.empty());
      continue;
    }
    const TileContour other = low.build(s);
    for (const LocalFacet& facet : other.facets) of_low += facet.simplices.size();
    if (s % 16 == 0 && low_is_balanced) low_is_balanced = unoriented(other) == unoriented(low.build(65535 - s));
  }
  EXPECT_FALSE(low_is_balanced);
  // few more simplices than the table of a fixed alternative, where each signature counts once
  EXPECT_LT(static_cast<double>(balanced.simplices), 1.07 * static_cast<double>(of_low));
  // An entry with a component that is coned from another vertex is found.
  const auto is_changed = [](TileContour& contour) {
    for (LocalFacet& facet : contour.facets) {
      if (facet.simplices.size() < 3) continue;
      const std::uint8_t apex = facet.simplices[0][0];
      const auto other = std::find_if(facet.points.begin(), facet.points.end(), [&](auto v) { return v != apex; });
      for (LocalSimplex& s : facet.simplices)
        if (std::find(s.begin(), s.end(), *other) == s.end()) s[0] = *other;
      return true;
    }
    return false;
  };
  std::size_t changed = 1;
  while (!is_changed(balanced.contours[changed])) ++changed;
  EXPECT_EQ(unbalanced(balanced), changed);
}

/// The triangles of a list, by ascending vertices.
std::multiset<std::array<std::uint8_t, 3>> triangles_of(const ResolvedCube& cube, const tables::ResolvedList& list) {
  std::multiset<std::array<std::uint8_t, 3>> result;
  for (std::size_t t = list.first_triangle; t < std::size_t{list.first_triangle} + list.triangle_count; ++t) {
    std::array<std::uint8_t, 3> sorted{cube.triangles[3 * t], cube.triangles[3 * t + 1], cube.triangles[3 * t + 2]};
    std::sort(sorted.begin(), sorted.end());
    result.insert(sorted);
  }
  return result;
}

/// The first signature of a cube without ambiguity whose triangles are not its complement's; 0 if there is none.
unsigned unbalanced(const ResolvedCube& cube) {
  const auto ambiguous = ambiguous_cubes(cube);
  for (unsigned s = 0; s < 256; ++s)
    if (!ambiguous[s] && triangles_of(cube, cube.entries[cube.first_entry[s]].separate) !=
                             triangles_of(cube, cube.entries[cube.first_entry[255 - s]].separate))
      return s;
  return 0;
}

TEST(Balanced, CubesWithoutAmbiguityHaveTheTrianglesOfTheirComplements) {
  EXPECT_EQ(unbalanced(make_resolved_cube()), 0u);
}

TEST(Balanced, ASwappedChordOfACubeIsFound) {
  ResolvedCube cube = make_resolved_cube();
  const tables::ResolvedList& list = cube.entries[cube.first_entry[3]].separate;  // a quadrilateral
  ASSERT_EQ(list.triangle_count, 2);
  std::uint8_t* const t = cube.triangles.data() + 3 * std::size_t{list.first_triangle};
  ASSERT_EQ(t[0], t[3]);  // a fan a b c, a c d becomes a b d, b c d
  ASSERT_EQ(t[2], t[4]);
  const std::uint8_t b = t[1];
  t[2] = t[5];
  t[3] = b;
  EXPECT_EQ(unbalanced(cube), 3u);
}

}  // namespace
}  // namespace tegl::gen
