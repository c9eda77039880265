// SPDX-License-Identifier: BSD-3-Clause
//
// Example 16: the face-centred cubic lattice against cubic samples. With equally many samples, the contour is nearer to
// the exact surface. And a cubic image whose cells are divided into simplices.
#include <tegl/check.hpp>
#include <tegl/division.hpp>
#include <tegl/lattice.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace {

double wavy_ball(double x, double y, double z) {
  return 0.7 - std::sqrt(x * x + y * y + z * z) + 0.05 * std::cos(9.0 * x) * std::cos(8.0 * y) * std::cos(7.0 * z);
}

/// An image of wavy_ball with about 27 000 samples in [-1, 1]^3. The layers of a staggered one are `layer` steps apart.
tegl::OwnedImage<float, 3> sampled(double layer) {
  const double step = 2.0 / 30.0 / std::cbrt(layer);
  const bool is_staggered = layer < 1.0;
  tegl::OwnedImage<float, 3> image;
  for (int a = 0; a < 3; ++a) {
    const double here = a == 2 ? layer * step : step;
    const auto size = static_cast<std::size_t>(std::lround(2.0 / here)) + 1;
    image.grid.axes[a] = tegl::Axis::uniform(size, -0.5 * here * static_cast<double>(size - 1), here);
  }
  const auto& axes = image.grid.axes;
  for (std::size_t k = 0; k < axes[2].size(); ++k)
    for (std::size_t j = 0; j < axes[1].size(); ++j)
      for (std::size_t i = 0; i < axes[0].size(); ++i) {
        // Odd layers are shifted by half a step along the other axes.
        const double half = is_staggered && k % 2 == 1 ? 0.5 * step : 0.0;
        image.values.push_back(static_cast<float>(wavy_ball(axes[0][i] + half, axes[1][j] + half, axes[2][k])));
      }
  return image;
}

/// Root mean square of the field at the centres of triangles; at the exact surface it is 0.
double error_of(const tegl::Contour<3>& surface) {
  double sum = 0.0;
  for (const auto& triangle : surface.simplices) {
    std::array<double, 3> centre{};
    for (const tegl::Index v : triangle)
      for (std::size_t a = 0; a < 3; ++a) centre[a] += static_cast<double>(surface.vertices[v][a]) / 3.0;
    sum += std::pow(wavy_ball(centre[0], centre[1], centre[2]), 2);
  }
  return std::sqrt(sum / static_cast<double>(surface.simplices.size()));
}

void report(const char* name, std::size_t samples, const tegl::Contour<3>& surface) {
  std::printf("%-22s %zu samples, %zu triangles, error %.5f\n", name, samples, surface.simplices.size(),
              error_of(surface));
}

}  // namespace

int main() {
  const auto cubic = sampled(1.0);
  const auto fcc = sampled(tegl::layer_step(tegl::Lattice::fcc));
  const auto of_cubic = tegl::extract(cubic.view(), 0.0);
  const auto of_fcc = tegl::extract_lattice(fcc.view(), tegl::Lattice::fcc, 0.0);
  report("cubic", cubic.values.size(), of_cubic);
  report("face-centred cubic", fcc.values.size(), of_fcc);

  // Each cube as six tetrahedra: no cell is ambiguous.
  const auto divided = tegl::extract(tegl::divided_complex(cubic.view(), tegl::Division::kuhn), 0.0);
  report("cubic, divided", cubic.values.size(), divided);

  const bool closed = tegl::check(of_cubic).boundary_simplices == 0 && tegl::check(of_fcc).boundary_simplices == 0 &&
                      tegl::check(divided).boundary_simplices == 0;
  return closed && tegl::check(of_fcc).euler == 2 && error_of(of_fcc) < 0.9 * error_of(of_cubic) ? 0 : 1;
}
