// SPDX-License-Identifier: BSD-3-Clause
//
// Two equal cells are found among cells of all types, and among many.
#include "tegl/equal_cells.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace tegl::test {
namespace {

TEST(EqualCells, AreFoundInCellsOfAllTypes) {
  const auto find = [](const CellLists& cells) {
    const auto equal = find_equal_cells(cells);
    return equal ? std::pair(equal->first, equal->second) : std::pair(std::size_t{0}, std::size_t{0});
  };
  EXPECT_EQ(find({}), std::pair(std::size_t{0}, std::size_t{0}));
  using enum CellType;
  EXPECT_EQ(find({.types = {tetrahedron, tetrahedron, tetrahedron, tetrahedron},
                  .corners = {0, 1, 2, 4, 1, 2, 4, 7, 4, 1, 0, 2, 7, 4, 2, 1}}),
            std::pair(std::size_t{0}, std::size_t{2}));
  EXPECT_EQ(find({.types = {pyramid, tetrahedron, hexahedron, tetrahedron, voxel},
                  .corners = {0, 1, 3, 2, 9, 1, 5, 7, 8, 0, 1, 3, 2, 4, 5, 7, 6, 5, 7, 8, 9, 0, 1, 2, 3, 4, 5, 6, 7}}),
            std::pair(std::size_t{2}, std::size_t{4}));
  // a polyhedron by its faces alone, and as many corners in another cell
  EXPECT_EQ(find({.types = {pyramid, tetrahedron, tetrahedron, polyhedron},
                  .corners = {0, 1, 3, 2, 9, 5, 7, 8, 9, 4, 7, 8, 9},
                  .ends = {5, 9, 13, 13},
                  .face_corners = {9, 8, 7, 9, 8, 5, 9, 7, 5, 8, 7, 5},
                  .face_ends = {3, 6, 9, 12},
                  .face_lists_ends = {0, 0, 0, 4}}),
            std::pair(std::size_t{1}, std::size_t{3}));
  // two 4-simplices by their facets
  CellLists polytopes{.types = {polytope, simplex4, polytope}, .corners = {1, 2, 3, 4, 5}, .ends = {0, 5, 5}};
  for (int copy = 0; copy < 2; ++copy)
    for (Index facet = 0; facet < 5; ++facet) {
      for (Index face = 0; face < 5; ++face) {
        if (face == facet) continue;
        for (Index corner = 0; corner < 5; ++corner)
          if (corner != facet && corner != face) polytopes.face_corners.push_back(corner);
        polytopes.face_ends.push_back(polytopes.face_corners.size());
      }
      polytopes.facet_ends.push_back(polytopes.face_ends.size());
    }
  polytopes.facet_lists_ends = {5, 5, 10};
  EXPECT_EQ(find(polytopes), std::pair(std::size_t{0}, std::size_t{2}));
}

TEST(EqualCells, AreFoundAmongManyCells) {
  // triangles around a point, and tetrahedra of a strip: one point in all cells, and neighbours with near numbers
  for (const std::size_t corners : {std::size_t{3}, std::size_t{4}}) {
    CellLists cells;
    for (Index c = 0; c < 200'000; ++c) {
      if (corners == 3)
        cells.corners.insert(cells.corners.end(), {0, c + 1, c + 2});
      else
        cells.corners.insert(cells.corners.end(), {c, c + 1, c + 2, c + 3});
    }
    cells.types.assign(200'000, corners == 3 ? CellType::triangle : CellType::tetrahedron);
    EXPECT_FALSE(find_equal_cells(cells));
    for (const std::size_t copied : {std::size_t{123'456}, std::size_t{77}}) {  // the second copy comes later
      cells.types.push_back(cells.types[0]);
      for (std::size_t k = corners; k-- > 0;) cells.corners.push_back(cells.corners[corners * copied + k]);
      const auto equal = find_equal_cells(cells);
      ASSERT_TRUE(equal);
      EXPECT_EQ(equal->first, 123'456U);
      EXPECT_EQ(equal->second, 200'000U);
    }
  }
}

}  // namespace
}  // namespace tegl::test
