// SPDX-License-Identifier: BSD-3-Clause
//
// The emitted builders of the cube, as compiled.
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "builder3.hpp"
#include "builder3_edges.hpp"
#include "builder_checks.hpp"

namespace tegl::test {
namespace {

builders::CubeContour by_table(unsigned signature, unsigned high_squares, Choice centre) {
  builders::CubeContour contour;
  builders::build_cube(signature, high_squares, static_cast<builders::Choice>(centre), contour);
  return contour;
}

builders::edges::CubeContour by_edges(unsigned signature, unsigned high_squares, Choice centre) {
  builders::edges::CubeContour contour;
  builders::edges::build_cube(signature, high_squares, static_cast<builders::edges::Choice>(centre), contour);
  return contour;
}

constexpr Choice kChoices[] = {Choice::separate, Choice::low, Choice::high};

/// All numbers of a contour.
template <class Contour>
std::vector<std::uint32_t> numbers_of(const Contour& contour) {
  std::vector<std::uint32_t> numbers{contour.facets, contour.triangles, contour.own_vertices};
  numbers.insert(numbers.end(), contour.facet_end, contour.facet_end + contour.facets);
  for (unsigned t = 0; t < contour.triangles; ++t)
    numbers.insert(numbers.end(), contour.vertices[t], contour.vertices[t] + 3);
  numbers.insert(numbers.end(), contour.masks, contour.masks + contour.own_vertices);
  return numbers;
}

TEST(CubeBuilder, ByTableIsTheContourOfTheGeneralBuilderTheDefinitionAndTheTable) {
  EXPECT_EQ(fault_of_cubes(by_table), "");
}

TEST(CubeBuilder, ByEdgesIsTheContourOfTheGeneralBuilderTheDefinitionAndTheTable) {
  EXPECT_EQ(fault_of_cubes(by_edges), "");
}

/// With every set of squares, so bits of squares that are not ambiguous have no effect.
TEST(CubeBuilder, TableAndEdgesGiveTheSameBytes) {
  for (unsigned signature = 0; signature < 256; ++signature) {
    ASSERT_EQ(builders::ambiguous_squares(signature), builders::edges::ambiguous_squares(signature));
    for (unsigned high = 0; high < 64; ++high)
      for (const Choice centre : kChoices) {
        const auto numbers = numbers_of(by_table(signature, high, centre));
        ASSERT_EQ(numbers, numbers_of(by_edges(signature, high, centre))) << signature << " " << high;
        ASSERT_EQ(numbers, numbers_of(by_table(signature, high & builders::ambiguous_squares(signature), centre)));
      }
  }
}

}  // namespace
}  // namespace tegl::test
