// SPDX-License-Identifier: BSD-3-Clause
//
// Example 7: five dimensions. The image holds volumes over time for several values of a parameter. Its contour is a
// hypersurface of 4-simplices in 5-space, again a manifold. There are no tables for 5D: a tile is built at its first
// occurrence.
#include <tegl/check.hpp>
#include <tegl/extract.hpp>
#include <tegl/tile_facets.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

int main() {
  // A ring in x, y, z that grows with time and is gone at the end; its thickness falls with the parameter p.
  const std::array<std::size_t, 5> sizes = {9, 9, 7, 7, 7};
  tegl::Grid<5> grid = tegl::Grid<5>::unit(sizes);
  const std::array<const char*, 5> names = {"x", "y", "z", "t", "p"};
  for (std::size_t a = 0; a < 5; ++a) {
    const double half = 1.6;
    grid.axes[a] = tegl::Axis::uniform(sizes[a], -half, 2 * half / static_cast<double>(sizes[a] - 1));
    grid.axes[a].name = names[a];
  }
  std::vector<float> values;
  for (std::size_t p = 0; p < sizes[4]; ++p)
    for (std::size_t t = 0; t < sizes[3]; ++t)
      for (std::size_t z = 0; z < sizes[2]; ++z)
        for (std::size_t y = 0; y < sizes[1]; ++y)
          for (std::size_t x = 0; x < sizes[0]; ++x) {
            const auto at = [&](int axis, std::size_t i) { return grid.axes[static_cast<std::size_t>(axis)][i]; };
            const double out = std::hypot(at(0, x), at(1, y)) - (0.95 + 0.1 * at(3, t));
            values.push_back(static_cast<float>(0.55 - std::hypot(std::hypot(out, at(2, z)), at(3, t), at(4, p))));
          }

  const tegl::Image<float, 5> image(values.data(), grid);
  const auto [contour, stats] = tegl::extract_with_stats(image, 0.0);
  const tegl::MeshReport report = tegl::check(contour);
  std::printf("%zu 4-simplices in %zu of %zu tiles, %zu vertices; components: %zu, Euler characteristic: %d\n",
              contour.simplices.size(), std::size_t(stats.active_tiles), std::size_t(stats.tiles),
              contour.vertices.size(), std::size_t(report.components), int(report.euler));

  // A single tile: two opposite corners of a 5-cube, kept separate, or joined because its centre is high.
  const std::uint64_t opposite = std::uint64_t{1} << 31 | 1;
  std::vector<tegl::tile::Choice> signs(tegl::kFaceCount<5>);
  const std::size_t apart = tegl::tile_facets<5>(opposite, {.choices = signs}).facets.size();
  signs[tegl::face_number<5>(0, 0b11111)] = tegl::tile::Choice::high;
  const std::size_t joined = tegl::tile_facets<5>(opposite, {.choices = signs}).facets.size();
  std::printf("two opposite corners of a tile: %zu pieces of contour, or %zu\n", apart, joined);

  // The boundary of a solid ring that is thick in four directions: a circle times a 3-sphere.
  const bool closed = report.boundary_simplices == 0 && report.nonmanifold_simplices == 0 && report.bad_links == 0;
  return closed && report.components == 1 && report.euler == 0 && apart == 2 && joined == 1 ? 0 : 1;
}
