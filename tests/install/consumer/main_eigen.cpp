// SPDX-License-Identifier: BSD-3-Clause
//
// Uses the installed core library with Eigen: the vertices of a circle as a matrix. Returns 0 only if they are right.
#include <cmath>
#include <cstdio>
#include <vector>

#include "tegl/eigen.hpp"
#include "tegl/tegl.hpp"

int main() {
  constexpr std::size_t kSize = 33;
  tegl::Grid<2> grid = tegl::Grid<2>::unit({kSize, kSize});
  for (tegl::Axis& axis : grid.axes) axis = tegl::Axis::uniform(kSize, -1.0, 2.0 / (kSize - 1));
  std::vector<double> values;
  for (std::size_t y = 0; y < kSize; ++y)
    for (std::size_t x = 0; x < kSize; ++x) values.push_back(-std::hypot(grid.axes[0][x], grid.axes[1][y]));
  const auto contour = tegl::extract<double>(tegl::Image<double, 2>(values.data(), grid), -0.7);
  const auto vertices = tegl::vertex_matrix(contour);
  const auto radii = vertices.rowwise().norm();
  const auto segments = tegl::simplex_matrix(contour);
  std::printf("2D: %ld segments, radii %.4f to %.4f\n", static_cast<long>(segments.rows()), radii.minCoeff(),
              radii.maxCoeff());
  return segments.rows() > 50 && std::abs(radii.minCoeff() - 0.7) < 0.01 && std::abs(radii.maxCoeff() - 0.7) < 0.01 ? 0
                                                                                                                    : 1;
}
