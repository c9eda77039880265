// SPDX-License-Identifier: BSD-3-Clause
//
// Example 5: images in existing memory, and missing values. A buffer of (r, g, b) pixels serves as an image of its
// green channel, upside down, without a copy. Samples that are NaN are missing: the contour ends at them.
#include <tegl/check.hpp>
#include <tegl/extract.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

namespace {

constexpr std::size_t kWidth = 60, kHeight = 40;

/// A bright spot at (30, 14), which falls by 10 per pixel.
double spot(std::size_t x, std::size_t y) {
  return 255.0 - 10.0 * std::hypot(static_cast<double>(x) - 30.0, static_cast<double>(y) - 14.0);
}

bool strides() {
  std::vector<std::uint8_t> pixels(3 * kWidth * kHeight);  // r, g, b, r, g, b, ... row by row from the top
  for (std::size_t y = 0; y < kHeight; ++y)
    for (std::size_t x = 0; x < kWidth; ++x)
      pixels[3 * (y * kWidth + x) + 1] = static_cast<std::uint8_t>(std::max(0.0, spot(x, y)));

  // The first sample is the green value of the last row. A step in x skips 3 bytes; a step in y goes back one row.
  const tegl::Image<std::uint8_t, 2> green(&pixels[3 * (kHeight - 1) * kWidth + 1],
                                           tegl::Grid<2>::unit({kWidth, kHeight}), {3, -3 * std::ptrdiff_t(kWidth)});
  const tegl::Contour<2> line = tegl::extract(green, 175.5);
  double y = 0.0;
  for (const auto& vertex : line.vertices)
    y += static_cast<double>(vertex[1]) / static_cast<double>(line.vertices.size());
  std::printf("strides: %zu segments; the ring around row 14 has its centre at y = %.2f\n", line.simplices.size(), y);
  // Row 14 from the top is row 25 from the bottom.
  return tegl::check(line).boundary_simplices == 0 && std::abs(y - 25.0) < 0.6;
}

bool missing() {
  std::vector<float> values;
  for (std::size_t y = 0; y < kHeight; ++y)
    for (std::size_t x = 0; x < kWidth; ++x) values.push_back(static_cast<float>(spot(x, y)));
  const auto grid = tegl::Grid<2>::unit({kWidth, kHeight});
  const std::size_t whole = tegl::extract(tegl::Image<float, 2>(values.data(), grid), 175.5).simplices.size();

  // One sample on the ring is missing, as if a sensor failed.
  values[14 * kWidth + 38] = std::numeric_limits<float>::quiet_NaN();
  const tegl::Contour<2> line = tegl::extract(tegl::Image<float, 2>(values.data(), grid), 175.5);
  const tegl::MeshReport report = tegl::check(line);
  std::printf("missing: %zu segments of %zu are left, with %zu ends\n", line.simplices.size(), whole,
              static_cast<std::size_t>(report.boundary_simplices));
  // Instead of a ring, one line with two ends at the gap.
  return line.simplices.size() < whole && report.components == 1 && report.boundary_simplices == 2;
}

}  // namespace

int main() { return strides() && missing() ? 0 : 1; }
