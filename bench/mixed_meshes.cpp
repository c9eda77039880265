// SPDX-License-Identifier: BSD-3-Clause
//
// Time of contours of meshes of one type and of mixed ones, with about equally many cells: a gyroid, one thread,
// processor time, minimum of several runs.
//
//     mixed_meshes [RUNS]
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <utility>

#include "meshes.hpp"
#include "polyhedral_meshes.hpp"
#include "tegl/complex.hpp"
#include "timing.hpp"

namespace {

using namespace tegl;

double gyroid(const std::array<double, 3>& p) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) sum += std::sin(12 * p[i]) * std::cos(12 * p[(i + 1) % 3]);
  return sum;
}

template <class Mesh>
void measure(const char* name, const Mesh& mesh, int runs) {
  ExtractOptions options;
  options.work.threads = 1;
  Complex<3> complex = mesh.complex();
  complex.set_values(test::values_of(mesh, gyroid));
  ExtractStats stats;
  std::size_t triangles = 0;
  const auto least = [&] {
    double seconds = std::numeric_limits<double>::infinity();
    for (int run = 0; run < runs; ++run) {
      const double start = bench::worked_seconds();
      const auto result = extract_with_stats(complex, 0.0, options);
      seconds = std::min(seconds, bench::worked_seconds() - start);
      stats = result.stats;
      triangles = result.contour.simplices.size();
    }
    return 1e9 * seconds / static_cast<double>(stats.tiles);
  };
  const double first = least();
  complex.find_edges(options.work);
  const double known = least();
  std::printf("| %s | %zu | %zu | %zu | %.1f | %.1f |\n", name, static_cast<std::size_t>(stats.tiles),
              static_cast<std::size_t>(stats.active_tiles), triangles, first, known);
}

}  // namespace

int main(int argc, char** argv) {
  const int runs = argc > 1 ? std::atoi(argv[1]) : 9;
  const auto points = [](std::size_t n) { return test::grid_points<3>({n, n, n}, 0.15); };
  std::printf(
      "| cells | number | active | triangles | ns per cell | ns per cell, edges known |\n|---|---|---|---|---|---|\n");
  measure("tetrahedra", test::kuhn_mesh(points(45)), runs);
  measure("hexahedra", test::cube_mesh(points(80), true), runs);
  measure("wedges", test::wedge_mesh(points(64)), runs);
  measure("pyramids", test::pyramid_mesh(points(45)), runs);
  measure("mixed", test::mixed_mesh(points(56), 5), runs);
  measure("truncated octahedra", test::truncated_octahedra(32, 0.1), runs);
  return 0;
}
