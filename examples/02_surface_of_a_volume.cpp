// SPDX-License-Identifier: BSD-3-Clause
//
// Example 2: a closed surface of a volume, saved as PLY. Three "metaballs" merge into one body. `close` caps the
// surface at the image border, so that it encloses a volume.
#include <tegl/check.hpp>
#include <tegl/extract.hpp>
#include <tegl/io.hpp>

#include <array>
#include <cstdio>
#include <vector>

namespace {

struct Ball {
  double x, y, z, strength;
};

/// The sum of the balls' fields at a point; at least 0.4, the isovalue, inside the body.
double field(double x, double y, double z) {
  constexpr std::array<Ball, 3> kBalls = {{{20, 32, 32, 90}, {42, 30, 36, 110}, {34, 40, 2, 60}}};
  double sum = 0.0;
  for (const Ball& b : kBalls)
    sum += b.strength / ((x - b.x) * (x - b.x) + (y - b.y) * (y - b.y) + (z - b.z) * (z - b.z) + 1.0);
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: %s OUT.ply\n", argv[0]);
    return 2;
  }
  constexpr std::size_t kSize = 64;
  std::vector<double> values;
  for (std::size_t z = 0; z < kSize; ++z)
    for (std::size_t y = 0; y < kSize; ++y)
      for (std::size_t x = 0; x < kSize; ++x)
        values.push_back(field(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)));
  const tegl::Image<double, 3> image(values.data(), tegl::Grid<3>::unit({kSize, kSize, kSize}));

  tegl::ExtractOptions options;
  options.close = true;
  const auto surface = tegl::extract(image, 0.4, options);
  tegl::write_mesh(surface, argv[1]);

  const tegl::MeshReport report = tegl::check(surface);
  std::printf("%s: %zu triangles, %zu component(s), Euler characteristic %lld, %zu open edges\n", argv[1],
              surface.simplices.size(), static_cast<std::size_t>(report.components),
              static_cast<long long>(report.euler), static_cast<std::size_t>(report.boundary_simplices));

  // One body without a tunnel: topologically a sphere. The file holds the same triangles.
  const bool sphere = report.components == 1 && report.euler == 2 && report.boundary_simplices == 0;
  return sphere && tegl::read_mesh(argv[1]).simplices.size() == 3 * surface.simplices.size() ? 0 : 1;
}
