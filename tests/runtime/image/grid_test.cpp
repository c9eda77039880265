// SPDX-License-Identifier: BSD-3-Clause
//
// Axis and Grid: coordinates, parts, world maps, and invalid arguments.
#include "tegl/grid.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "tegl/contour.hpp"
#include "tegl/eigen.hpp"

namespace tegl {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Make>
std::string message_of_invalid_grid(const Make& make) {
  std::string message;
  try {
    make();
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidGrid);
    message.append(error.what());
  }
  return message;
}

TEST(Axis, UniformIsOriginPlusMultiplesOfTheStep) {
  const Axis axis = Axis::uniform(5, 10.0, -2.5);
  EXPECT_EQ(axis.size(), 5u);
  EXPECT_TRUE(axis.is_uniform());
  EXPECT_TRUE(axis.is_descending());
  EXPECT_EQ(axis[0], 10.0);
  EXPECT_EQ(axis[4], 0.0);
  EXPECT_EQ(axis.step(), -2.5);
}

TEST(Axis, RectilinearKeepsItsCoordinates) {
  const Axis axis = Axis::rectilinear({0.0, 5.0, 30.0, 100.0});
  EXPECT_EQ(axis.size(), 4u);
  EXPECT_FALSE(axis.is_uniform());
  EXPECT_FALSE(axis.is_descending());
  EXPECT_EQ(axis.origin(), 0.0);
  EXPECT_EQ(axis[2], 30.0);
  EXPECT_DOUBLE_EQ(axis.step(), 100.0 / 3);
  EXPECT_TRUE(Axis::rectilinear({1000.0, 850.0, 500.0}).is_descending());
}

TEST(Axis, RejectsWhatIsNoAxisAndSaysWhy) {
  EXPECT_NE(message_of_invalid_grid([] { Axis::uniform(0); }).find("0 samples"), std::string::npos);
  EXPECT_NE(message_of_invalid_grid([] { Axis::uniform(3, 0.0, 0.0); }).find("step 0"), std::string::npos);
  EXPECT_NE(message_of_invalid_grid([] { Axis::uniform(3, 0.0, kNan); }).find("nan"), std::string::npos);
  EXPECT_NE(message_of_invalid_grid([] { Axis::uniform(3, kInfinity, 1.0); }).find("inf"), std::string::npos);
  EXPECT_NE(message_of_invalid_grid([] { Axis::rectilinear({}); }).find("0 samples"), std::string::npos);
  EXPECT_NE(message_of_invalid_grid([] { Axis::rectilinear({1.0, kNan}); }).find("coordinate 1"), std::string::npos);
  EXPECT_NE(message_of_invalid_grid([] { Axis::rectilinear({1.0, 2.0, 2.0}); }).find("1 and 2"), std::string::npos);
  EXPECT_NE(message_of_invalid_grid([] { Axis::rectilinear({1.0, 2.0, 1.5}); }).find("ascending"), std::string::npos);
  EXPECT_NE(message_of_invalid_grid([] { Axis::rectilinear({3.0, 2.0, 2.5}); }).find("descending"), std::string::npos);
}

TEST(Axis, PartHasTheSameCoordinatesNameAndUnit) {
  Axis axis = Axis::uniform(10, 0.1, 0.1);
  axis.name = "time";
  axis.unit = "hours";
  const Axis part = axis.part(3, 4);
  ASSERT_EQ(part.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(part[i], axis[3 + i]);
  EXPECT_EQ(part.name, "time");
  EXPECT_EQ(part.unit, "hours");
  EXPECT_EQ(axis.part(9, 1)[0], axis[9]);
  EXPECT_THROW((void)axis.part(8, 3), Error);
  EXPECT_THROW((void)axis.part(0, 0), Error);
  EXPECT_THROW((void)axis.part(10, 1), Error);
}

TEST(Grid, HasAWorldMapUnlessItIsTheIdentity) {
  auto grid = Grid<3>::unit({4, 5, 6});
  EXPECT_EQ(grid.sizes(), (std::array<std::size_t, 3>{4, 5, 6}));
  EXPECT_FALSE(grid.has_world_map());
  grid.offset[1] = 1e-300;
  EXPECT_TRUE(grid.has_world_map());
  grid.offset[1] = 0;
  grid.linear[0][0] = -1;
  EXPECT_TRUE(grid.has_world_map());
}

TEST(EigenViews, AreTheArraysThemselves) {
  Contour<3, double> contour;
  contour.vertices = {{1, 2, 3}, {4, 5, 6}};
  contour.simplices = {{0, 1, 0}};
  EXPECT_EQ(vertex_matrix(contour).data(), contour.vertices.data()->data());
  EXPECT_EQ(vertex_matrix(contour).rows(), 2);
  EXPECT_EQ(vertex_matrix(contour)(1, 2), 6.0);
  EXPECT_EQ(simplex_matrix(contour).data(), contour.simplices.data()->data());
  EXPECT_EQ(simplex_matrix(contour)(0, 1), 1u);
  const Contour<3> empty;
  EXPECT_EQ(vertex_matrix(empty).rows(), 0);
  Matrix<3> matrix = identity<3>();
  as_eigen(matrix)(0, 2) = 5.0;
  EXPECT_EQ(matrix[0][2], 5.0);
  Vector<3> vector = unit_vector<3>(2);
  EXPECT_EQ(as_eigen(vector).data(), vector.data());
  as_eigen(vector) = as_eigen(matrix) * Eigen::Vector3d(1, 2, 3);
  EXPECT_EQ(vector, (Vector<3>{16, 2, 3}));
  EXPECT_EQ(to_vector(2.0 * as_eigen(vector)), (Vector<3>{32, 4, 6}));
  EXPECT_EQ(to_matrix(as_eigen(matrix).transpose()), (Matrix<3>{{{1, 0, 0}, {0, 1, 0}, {5, 0, 1}}}));
}

}  // namespace
}  // namespace tegl
