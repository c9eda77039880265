// SPDX-License-Identifier: BSD-3-Clause
//
// Example 3: a volume over time is a 4D image. Its contour is extracted once, as tetrahedra in space and time. The
// surface at any time is then a slice of it, and varies continuously between two time steps. Here two balls approach
// each other; bisection finds the time at which they merge.
#include <tegl/check.hpp>
#include <tegl/extract.hpp>
#include <tegl/scrubber.hpp>
#include <tegl/slice.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace {

constexpr std::size_t kSize = 40, kSteps = 12;

/// Radius minus distance to the nearer ball: positive inside. Each ball moves half a voxel per step.
float inside(double x, double y, double z, double t) {
  const double left = std::hypot(x - (10.875 + 0.5 * t), y - 20.0, z - 20.0);
  const double right = std::hypot(x - (29.125 - 0.5 * t), y - 20.0, z - 20.0);
  return static_cast<float>(6.0 - std::min(left, right));
}

std::vector<float> sample() {
  std::vector<float> values;
  for (std::size_t t = 0; t < kSteps; ++t)
    for (std::size_t z = 0; z < kSize; ++z)
      for (std::size_t y = 0; y < kSize; ++y)
        for (std::size_t x = 0; x < kSize; ++x)
          values.push_back(
              inside(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z), static_cast<double>(t)));
  return values;
}

}  // namespace

int main() {
  const std::vector<float> values = sample();
  // [readme]
  // values: 12 volumes of 40 x 40 x 40 samples, one after the other
  const tegl::Image<float, 4> image(values.data(), tegl::Grid<4>::unit({40, 40, 40, 12}));
  // tetrahedra in space and time, and the surface of triangles at t = 7.3
  const auto contour = tegl::extract(image, 0.0);
  const auto surface = tegl::slice(contour, tegl::Hyperplane<4>::across(3, 7.3));
  const tegl::MeshReport report = tegl::check(surface);
  std::printf("t = 7.3: %zu triangles, %zu components, Euler characteristic %d, open edges: %zu\n",
              surface.simplices.size(), std::size_t(report.components), int(report.euler),
              std::size_t(report.boundary_simplices));
  // [/readme]

  // Bisection for the time at which two components become one.
  const tegl::Scrubber<4, float> scrubber(contour);  // for many slices: an index of the tetrahedra by time
  double apart = 0.0, joined = 11.0;
  while (joined - apart > 1e-6) {
    const double middle = (apart + joined) / 2.0;
    (tegl::check(scrubber.cut(middle)).components == 2 ? apart : joined) = middle;
  }
  // They touch at x = 20, where 10.875 + t/2 + 6 = 20: at t = 6.25, a quarter of the way between two steps.
  std::printf("they meet at t = %.6f\n", joined);
  return report.components == 1 && report.euler == 2 && std::abs(joined - 6.25) < 1e-5 ? 0 : 1;
}
