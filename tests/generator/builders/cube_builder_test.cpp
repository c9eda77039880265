// SPDX-License-Identifier: BSD-3-Clause
//
// The emitted builders of the cube, as compiled.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <vector>

#include "../coned_part.hpp"
#include "builder3.hpp"
#include "builder3_barycentric.hpp"
#include "builder3_barycentric_edges.hpp"
#include "builder3_edges.hpp"
#include "builder_checks.hpp"
#include "builders/cube_rule.hpp"
#include "cubes/resolved_cube.hpp"
#include "tegl/generated/tables.hpp"

namespace tegl::test {
namespace {

builders::CubeContour cube_by_table(unsigned signature, unsigned high_squares, Choice centre) {
  builders::CubeContour contour;
  builders::build_cube(signature, high_squares, static_cast<builders::Choice>(centre), contour);
  return contour;
}

builders::edges::CubeContour cube_by_edges(unsigned signature, unsigned high_squares, Choice centre) {
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
  EXPECT_EQ(fault_of_cubes(cube_by_table), "");
}

TEST(CubeBuilder, ByEdgesIsTheContourOfTheGeneralBuilderTheDefinitionAndTheTable) {
  EXPECT_EQ(fault_of_cubes(cube_by_edges), "");
}

/// With every set of squares, so bits of squares that are not ambiguous have no effect.
TEST(CubeBuilder, TheDefinitionByCentresIsThatByRegions) {
  for_each_cube([](unsigned signature, unsigned high) {
    const auto is_high = [high](unsigned base, unsigned axes) {
      const unsigned axis = (axes & 1u) == 0 ? 0 : (axes & 2u) == 0 ? 1 : 2;
      return (high >> (2 * axis + (base >> axis & 1u)) & 1u) != 0;
    };
    for (const Choice centre : {Choice::low, Choice::high})
      EXPECT_EQ(eulers_of_facets(3, signature, centre == Choice::high, is_high),
                eulers_by_definition<3>(signature, is_high, centre))
          << signature << " " << high;
  });
}

TEST(CubeBuilder, TableAndEdgesGiveTheSameBytes) {
  for (unsigned signature = 0; signature < 256; ++signature) {
    ASSERT_EQ(builders::ambiguous_squares(signature), builders::edges::ambiguous_squares(signature));
    for (unsigned high = 0; high < 64; ++high)
      for (const Choice centre : kChoices) {
        const auto numbers = numbers_of(cube_by_table(signature, high, centre));
        ASSERT_EQ(numbers, numbers_of(cube_by_edges(signature, high, centre))) << signature << " " << high;
        ASSERT_EQ(numbers, numbers_of(cube_by_table(signature, high & builders::ambiguous_squares(signature), centre)));
      }
  }
}

builders::barycentric::CubeContour coned_by_table(unsigned signature, unsigned high_squares, Choice centre) {
  builders::barycentric::CubeContour contour;
  builders::barycentric::build_cube(signature, high_squares, static_cast<builders::barycentric::Choice>(centre),
                                    contour);
  return contour;
}

builders::edges::barycentric::CubeContour coned_by_edges(unsigned signature, unsigned high_squares, Choice centre) {
  builders::edges::barycentric::CubeContour contour;
  builders::edges::barycentric::build_cube(signature, high_squares,
                                           static_cast<builders::edges::barycentric::Choice>(centre), contour);
  return contour;
}

TEST(CubeBuilder, BarycentricConesTheFacetsOfTheGeneralBuilderAndOfTheDefinition) {
  EXPECT_EQ(fault_of_barycentric_cubes(coned_by_table), "");
  EXPECT_EQ(fault_of_barycentric_cubes(coned_by_edges), "");
  EXPECT_NE(fault_of_barycentric_cubes(cube_by_table), "");
}

TEST(CubeBuilder, BarycentricTableAndEdgesGiveTheSameBytes) {
  for (unsigned signature = 0; signature < 256; ++signature)
    for (unsigned high = 0; high < 64; ++high)
      for (const Choice centre : kChoices) {
        ASSERT_EQ(numbers_of(coned_by_table(signature, high, centre)),
                  numbers_of(coned_by_edges(signature, high, centre)))
            << signature << " " << high;
      }
}

TEST(CubeBuilder, BarycentricHasAsManyTrianglesAsTheBarycentricTable) {
  const tables::TileTable& table = tables::kTile3Barycentric;
  for (unsigned signature = 0; signature < 256; ++signature) {
    const auto contour = coned_by_table(signature, 0, Choice::separate);
    const tables::List& list = table.lists[table.list_of[signature]];
    EXPECT_EQ(contour.triangles, list.simplex_count);
    EXPECT_EQ(contour.own_vertices, list.cone_vertices);
  }
}

/// The figures of docs/builders.md.
TEST(CubeBuilder, FillingIsAFunctionOfThePolygonsExceptFor24Hexagons) {
  std::map<std::uint64_t, unsigned> fillings;
  std::map<std::size_t, unsigned> polygons;
  for (const gen::FillingRow& row : gen::make_filling_rule(gen::make_resolved_cube()))
    if (fillings[row.key]++ == 0) ++polygons[row.polygons.size()];
  EXPECT_EQ(fillings.size(), 646u);
  EXPECT_EQ(polygons, (std::map<std::size_t, unsigned>{{1, 338}, {2, 264}, {3, 40}, {4, 4}}));
  EXPECT_EQ(std::count_if(fillings.begin(), fillings.end(), [](const auto& f) { return f.second == 2; }), 24);
  EXPECT_TRUE(std::all_of(fillings.begin(), fillings.end(), [](const auto& f) { return f.second <= 2; }));
}

}  // namespace
}  // namespace tegl::test
