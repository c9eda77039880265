// SPDX-License-Identifier: BSD-3-Clause
//
// What tests of polyhedra and of prisms over polyhedra have in common: meshes, options, missing values.
#pragma once

#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "invariants.hpp"
#include "polyhedral_meshes.hpp"
#include "tegl/complex.hpp"

namespace tegl::test {

inline ExtractOptions polyhedra_options(Triangulation triangulation, Ambiguity ambiguity = Ambiguity::low,
                                        unsigned threads = 0) {
  ExtractOptions options;
  options.triangulation = triangulation;
  options.ambiguity = ambiguity;
  options.work.threads = threads;
  return options;
}

/// Polyhedra that fill space, merged ones beside cells of all types among them: from `along` truncated octahedra along
/// each axis, from `sites` Voronoi cells, and from grids of `samples` points along each axis.
inline std::vector<std::pair<std::string, FacedMesh>> space_fillings(int along, std::size_t sites,
                                                                     std::size_t samples) {
  const MeshData<3> points = grid_points<3>({samples, samples, samples}, 0.1);
  return {{"truncated octahedra", truncated_octahedra(along, 0.1)},
          {"Voronoi", voronoi_cells(sites, 3)},
          {"merged hexahedra", merged(faced(cube_mesh(points, true)), 0.7, 1)},
          {"merged wedges", merged(faced(wedge_mesh(points)), 0.7, 2)},
          {"merged mixed", merged(faced(mixed_mesh(points, 5)), 0.5, 3)}};
}

/// The values with every 50th missing, at random.
inline std::vector<double> with_missing(std::vector<double> values) {
  std::mt19937_64 random(9);
  for (double& value : values)
    if (random() % 50 == 0) value = std::numeric_limits<double>::quiet_NaN();
  return values;
}

/// The contour of a complex with missing values is a manifold with boundary, and has the counted size.
template <int N>
void expect_boundary_beside_missing(const Complex<N>& complex) {
  for (const Ambiguity a : {Ambiguity::low, Ambiguity::mean}) {
    const ExtractOptions options = polyhedra_options(Triangulation::compact, a);
    const auto contour = extract(complex, 0.5, options);
    EXPECT_GT(expect_oriented_manifold(contour).boundary_simplices, 100u);
    EXPECT_EQ((ContourSize{contour.vertices.size(), contour.simplices.size()}), count(complex, 0.5, options));
  }
}

}  // namespace tegl::test
