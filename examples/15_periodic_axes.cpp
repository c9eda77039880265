// SPDX-License-Identifier: BSD-3-Clause
//
// Example 15: periodic axes. A ball that crosses the date line is one component, and the surface of a crystal has the
// topology of its unit cell.
#include <tegl/check.hpp>
#include <tegl/measure.hpp>
#include <tegl/periodic.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace {

constexpr double kTurn = 6.283185307179586;

/// Samples of f(x, y, z) for 24 multiples of 1/24 along each axis.
template <class Field>
std::vector<float> samples_of(const Field& field) {
  std::vector<float> values;
  for (int i = 0; i < 24 * 24 * 24; ++i)
    values.push_back(static_cast<float>(field(i % 24 / 24.0, i / 24 % 24 / 24.0, i / 576 / 24.0)));
  return values;
}

double gyroid(double x, double y, double z) {
  return std::sin(kTurn * x) * std::cos(kTurn * y) + std::sin(kTurn * y) * std::cos(kTurn * z) +
         std::sin(kTurn * z) * std::cos(kTurn * x);
}

double ball(double x, double y, double z) { return 0.3 - std::hypot(x - std::round(x), y - 0.5, z - 0.5); }

}  // namespace

int main() {
  const tegl::Grid<3> grid = tegl::Grid<3>::unit({24, 24, 24});

  const std::vector<float> around = samples_of(ball);
  const tegl::Image<float, 3> world(around.data(), grid);
  // Axis 0 is periodic: the first sample follows the last one after one step.
  const auto surface = tegl::extract_periodic(world, tegl::sample_periods(grid, std::array{0}), 0.0);
  const tegl::MeshReport whole = tegl::check(surface);
  const tegl::MeshReport parts = tegl::check(tegl::extract(world, 0.0));
  const double volume = tegl::measure(surface).content.value_or(0.0);
  std::printf("a ball at the ends of x: %d component of volume %.0f; without the period %d parts\n",
              int(whole.components), volume, int(parts.components));

  const std::vector<float> crystal = samples_of(gyroid);
  const auto cell = tegl::extract_periodic(tegl::Image<float, 3>(crystal.data(), grid), {24.0, 24.0, 24.0}, 0.01);
  const tegl::MeshReport report = tegl::check(cell);
  // For pictures, vertices on the seam are doubled.
  const tegl::Unrolled<3, float> unrolled = tegl::unroll(cell);
  std::printf("a gyroid's cell: %zu triangles, Euler characteristic %d; unrolled, %zu more vertices\n",
              cell.simplices.size(), int(report.euler), unrolled.contour.vertices.size() - cell.vertices.size());

  return whole.components == 1 && whole.boundary_simplices == 0 && parts.components == 2 && report.euler == -8 &&
                 report.boundary_simplices == 0
             ? 0
             : 1;
}
