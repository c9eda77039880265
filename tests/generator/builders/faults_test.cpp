// SPDX-License-Identifier: BSD-3-Clause
//
// Copies of the emitted builders with one fault each (CMakeLists.txt): the checks of the other tests find every one.
#include <gtest/gtest.h>

#include <string>

#include "builder_checks.hpp"
#include "missing_axis.hpp"
#include "swapped_map.hpp"
#include "swapped_ring.hpp"
#include "wrong_corners.hpp"
#include "wrong_end.hpp"
#include "wrong_filling.hpp"
#include "wrong_kind.hpp"
#include "wrong_mask.hpp"
#include "wrong_own_vertices.hpp"
#include "wrong_resolution.hpp"
#include "wrong_run.hpp"
#include "wrong_segment.hpp"
#include "wrong_sign.hpp"
#include "wrong_square.hpp"
#include "wrong_triangle.hpp"

namespace tegl::test {
namespace {

// The contour of a builder in namespace `space`.
#define TEGL_SQUARE(space)                                \
  [](unsigned signature, bool centre_high) {              \
    space::SquareContour contour;                         \
    space::build_square(signature, centre_high, contour); \
    return contour;                                       \
  }
#define TEGL_CUBE(space)                                                                     \
  [](unsigned signature, unsigned high_squares, Choice centre) {                             \
    space::CubeContour contour;                                                              \
    space::build_cube(signature, high_squares, static_cast<space::Choice>(centre), contour); \
    return contour;                                                                          \
  }

TEST(FaultyBuilder, OfTheSquareIsFound) {
  EXPECT_NE(fault_of_squares(TEGL_SQUARE(builders::wrong_segment)), "");
  EXPECT_NE(fault_of_squares(TEGL_SQUARE(builders::edges::swapped_ring)), "");
  EXPECT_NE(fault_of_squares(TEGL_SQUARE(builders::edges::wrong_run)), "");
}

TEST(FaultyBuilder, OfTheCubeIsFound) {
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::swapped_map)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_corners)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_sign)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::missing_axis)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_square)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_end)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_filling)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_mask)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::edges::wrong_kind)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::wrong_triangle)), "");
  EXPECT_NE(fault_of_cubes(TEGL_CUBE(builders::wrong_resolution)), "");
  EXPECT_NE(fault_of_barycentric_cubes(TEGL_CUBE(builders::edges::barycentric::wrong_own_vertices)), "");
}

}  // namespace
}  // namespace tegl::test
