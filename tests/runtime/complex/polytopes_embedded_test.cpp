// SPDX-License-Identifier: BSD-3-Clause
//
// Barycentric contours in single 4D polytopes do not intersect themselves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

#include "complex/complex_cases.hpp"
#include "complex/polyhedral_cases.hpp"
#include "known_polytopes.hpp"
#include "polytopal_meshes.hpp"
#include "tegl/complex.hpp"
#include "tegl/intersections.hpp"

namespace tegl::test {
namespace {

/// Values on both sides of 0, half of them uniform, half log-uniform.
std::vector<double> values_about_zero(std::size_t count, unsigned seed) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const double share = 0.1 + 0.2 * static_cast<double>(random() % 5);
  const bool logs = random() % 2 == 0;
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const double size = logs ? std::exp(7.0 * (uniform() - 0.5)) : uniform() + 1e-9;
    values.push_back(uniform() < share ? size : -size);
  }
  return values;
}

std::uint64_t intersections_in(Complex<4>& cell, const std::vector<double>& values, Ambiguity rule,
                               Triangulation triangulation) {
  cell.set_values(values);
  ExtractOptions options;
  options.ambiguity = rule;
  options.triangulation = triangulation;
  const Intersections<4> found = find_intersections(extract<double>(cell, 0.0, options));
  EXPECT_EQ(found.flat, 0u);
  return found.pair_count;
}

/// Values for which the compact contour intersects itself, as in one of 3 000 cells (docs/embedding.md). The
/// barycentric one does not, and the search finds what there is.
TEST(PolytopesEmbedded, BarycentricContoursDoNotIntersectThemselvesWhereCompactOnesDo) {
  struct Case {
    Ambiguity rule;
    unsigned seed;
  };
  const std::vector<Point4> points = products(regular_polygon(5), regular_polygon(6)).points;
  Complex<4> cell = hull(points).complex();
  for (const auto& [rule, seed] :
       {Case{Ambiguity::low, 622}, {Ambiguity::low, 1305}, {Ambiguity::high, 1868}, {Ambiguity::high, 2230}}) {
    const std::vector<double> values = values_about_zero(points.size(), seed);
    EXPECT_GT(intersections_in(cell, values, rule, Triangulation::compact), 0u) << seed;
    EXPECT_EQ(intersections_in(cell, values, rule, Triangulation::barycentric), 0u) << seed;
  }
}

/// Barycentric contours; compact ones may intersect themselves (docs/embedding.md).
TEST(PolytopesEmbedded, BarycentricContoursOfSingleCellsDoNotIntersectThemselves) {
  for (const std::vector<Point4>& points :
       {products(regular_polygon(5), regular_polygon(6)).points, rhombic_cells(0).points, cell24_points()}) {
    Complex<4> cell = hull(points).complex();
    for (const Ambiguity rule : kAllRules)
      for (unsigned seed = 0; seed < 40; ++seed) {
        const auto values = values_about_zero(points.size(), seed);
        EXPECT_EQ(intersections_in(cell, values, rule, Triangulation::barycentric), 0u)
            << points.size() << " corners, rule " << static_cast<int>(rule) << " " << seed;
      }
  }
}

}  // namespace
}  // namespace tegl::test
