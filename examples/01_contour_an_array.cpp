// SPDX-License-Identifier: BSD-3-Clause
//
// Example 1: the contour line of an array. An image is a pointer to values, a size and (optionally) coordinates;
// `extract` returns line segments that share their vertices.
#include <tegl/check.hpp>
#include <tegl/extract.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

int main() {
  // A cone-shaped hill, sampled on 101 x 81 points, stored row by row: x varies fastest.
  constexpr std::size_t kWidth = 101, kHeight = 81;
  std::vector<float> heights(kWidth * kHeight);

  // Coordinates: x from -5 km and y from -4 km, a sample every 0.1 km.
  tegl::Grid<2> grid;
  grid.axes = {tegl::Axis::uniform(kWidth, -5.0, 0.1), tegl::Axis::uniform(kHeight, -4.0, 0.1)};
  for (std::size_t j = 0; j < kHeight; ++j)
    for (std::size_t i = 0; i < kWidth; ++i)
      heights[j * kWidth + i] = static_cast<float>(1000.0 - 200.0 * std::hypot(grid.axes[0][i], grid.axes[1][j]));

  // The image is a view: it refers to `heights` and copies no samples.
  const tegl::Image<float, 2> image(heights.data(), grid);
  const tegl::Contour<2> line = tegl::extract(image, 400.0);  // at a height of 400 m: a circle of radius 3 km

  double length = 0.0;
  for (const auto& [a, b] : line.simplices)
    length += std::hypot(line.vertices[b][0] - line.vertices[a][0], line.vertices[b][1] - line.vertices[a][1]);
  const tegl::MeshReport report = tegl::check(line);
  std::printf("%zu segments, %zu vertices, %zu closed line(s), length %.4f km (exact: %.4f)\n", line.simplices.size(),
              line.vertices.size(), static_cast<std::size_t>(report.components), length, 6.0 * std::numbers::pi);

  // One closed line without ends or branches, of the exact length up to 10 m.
  const bool closed = report.components == 1 && report.boundary_simplices == 0 && report.nonmanifold_simplices == 0;
  return closed && std::abs(length - 6.0 * std::numbers::pi) < 0.01 ? 0 : 1;
}
