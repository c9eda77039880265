// SPDX-License-Identifier: BSD-3-Clause
//
// Intersecting triangles found by the library, compared with those that CGAL finds.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "random_fields.hpp"
#include "tegl/extract.hpp"
#include "tegl/intersections.hpp"

namespace tegl::test {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Pairs = std::set<std::pair<Index, Index>>;

/// Pairs by CGAL. A flat triangle is paired with itself.
Pairs pairs_by_cgal(const Contour<3, double>& contour) {
  CGAL::Surface_mesh<Kernel::Point_3> mesh;
  using Face = CGAL::Surface_mesh<Kernel::Point_3>::Face_index;
  using Vertex = CGAL::Surface_mesh<Kernel::Point_3>::Vertex_index;
  for (const auto& v : contour.vertices) mesh.add_vertex(Kernel::Point_3(v[0], v[1], v[2]));
  for (const auto& s : contour.simplices) mesh.add_face(Vertex(s[0]), Vertex(s[1]), Vertex(s[2]));
  EXPECT_EQ(mesh.number_of_faces(), contour.simplices.size());
  std::vector<std::pair<Face, Face>> found;
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(found));
  Pairs result;
  for (const auto& [a, b] : found) {
    const auto i = static_cast<Index>(a), j = static_cast<Index>(b);
    result.insert({std::min(i, j), std::max(i, j)});
  }
  return result;
}

/// Compares the pairs; returns their number.
std::size_t expect_as_cgal(const Contour<3, double>& contour) {
  const Intersections<3> found = find_intersections(contour);
  Pairs pairs, expected = pairs_by_cgal(contour);
  for (const auto& pair : found.pairs) pairs.insert({pair.first, pair.second});
  std::size_t flat = 0;
  std::erase_if(expected, [&](const auto& pair) { return pair.first == pair.second && ++flat > 0; });
  EXPECT_EQ(found.flat, flat);
  EXPECT_EQ(pairs, expected);
  return pairs.size();
}

Contour<3, double> noise_contour(std::uint64_t seed, std::int64_t bound, double isovalue) {
  std::mt19937_64 bits(seed);
  const auto field = random_field<3>(bits, 14, bound, true);
  const auto image = image_of<float>(field);
  ExtractOptions options;
  options.ambiguity = Ambiguity::mean;
  return extract<double>(image.view(), isovalue, options);
}

TEST(IntersectionsByCgal, ContoursOfNoise) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) expect_as_cgal(noise_contour(seed, 1 << 23, 0.0));
}

// Samples at the isovalue give flat triangles, and vertices that touch.
TEST(IntersectionsByCgal, SamplesAtTheIsovalue) { EXPECT_GT(expect_as_cgal(noise_contour(4, 3, 0.0)), 1000u); }

TEST(IntersectionsByCgal, MovedVertices) {
  for (const double by : {0.02, 0.1, 0.5}) {
    auto contour = noise_contour(5, 1 << 23, 0.0);
    std::mt19937_64 bits(27);
    for (auto& vertex : contour.vertices)
      for (double& x : vertex) x += by * (static_cast<double>(random_below(bits, 2001)) / 1000 - 1);
    EXPECT_GT(expect_as_cgal(contour), 0u) << by;
  }
}

// Vertices in few positions: coplanar, collinear and equal ones everywhere.
TEST(IntersectionsByCgal, VerticesMovedToALattice) {
  for (const double step : {0.5, 0.25}) {
    auto contour = noise_contour(6, 1 << 23, 0.0);
    for (auto& vertex : contour.vertices)
      for (double& x : vertex) x = std::round(x / step) * step;
    EXPECT_GT(expect_as_cgal(contour), 1000u) << step;
  }
}

}  // namespace
}  // namespace tegl::test
