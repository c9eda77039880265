// SPDX-License-Identifier: BSD-3-Clause
//
// Example 10: the contour before triangulation: its polygons in cubes (in 4D polyhedra in tesseracts) and their
// incidences.
#include <tegl/check.hpp>
#include <tegl/facet_hierarchy.hpp>
#include <tegl/polygons.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <vector>

int main() {
  // A torus in 40 x 40 x 20 samples.
  std::vector<float> values;
  for (int z = 0; z < 20; ++z)
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x) {
        const double ring = std::hypot(x - 19.4, y - 19.3) - 11.0;
        values.push_back(static_cast<float>(4.6 - std::hypot(ring, z - 9.6)));
      }
  const tegl::Image<float, 3> image(values.data(), tegl::Grid<3>::unit({40, 40, 20}));

  auto facets = tegl::extract_facets<double>(image, 0.0);
  facets.connect_up();  // builds the upward incidences, which are optional
  std::map<std::size_t, int> polygons;
  for (std::size_t f = 0; f < facets.count(2); ++f) ++polygons[facets.down(2, f).size()];
  for (const auto& [corners, count] : polygons) std::printf("%5d polygons of %zu corners\n", count, corners);

  // The neighbours of polygon 0: the polygons on the other side of its segments.
  for (const tegl::Index segment : facets.down(2, 0))
    for (const tegl::Index neighbour : facets.up(1, segment))
      if (neighbour != 0) std::printf("polygon 0 meets polygon %u in segment %u\n", neighbour, segment);

  const tegl::FacetReport report = tegl::check(facets);
  std::printf("Euler characteristic %d, open segments %d\n", int(report.euler), int(report.border));

  // The triangulation method determines the surface.
  const auto surface = tegl::triangulate(facets, tegl::PolygonTriangulation::halving_chord);
  const tegl::MeshReport triangles = tegl::check(surface);
  const bool as_expected = report.euler == 0 && report.border == 0 && triangles.euler == 0 &&
                           triangles.boundary_simplices == 0 && triangles.bad_links == 0 && facets.up(1, 0).size() == 2;
  return as_expected ? 0 : 1;
}
