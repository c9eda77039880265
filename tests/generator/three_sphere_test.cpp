// SPDX-License-Identifier: BSD-3-Clause
//
// The test for 3-spheres, on manifolds whose type is known by construction.
#include "tegl/tile/three_sphere.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <stdexcept>
#include <vector>

#include "share.hpp"
#include "tegl/tile/disjoint_sets.hpp"
#include "tegl/tile/facets.hpp"

namespace tegl::tile {
namespace {

using Tetrahedra = std::vector<ThreeSphereTest::Tetrahedron>;

/// The join of two circles of m and n edges, which is a sphere.
Tetrahedra join_of_circles(std::uint16_t m, std::uint16_t n) {
  Tetrahedra result;
  for (std::uint16_t i = 0; i < m; ++i)
    for (std::uint16_t j = 0; j < n; ++j)
      result.push_back({i, static_cast<std::uint16_t>((i + 1) % m), static_cast<std::uint16_t>(m + j),
                        static_cast<std::uint16_t>(m + (j + 1) % n)});
  return result;
}

/// A torus of dimension 3: n^3 cubes with six tetrahedra each, n >= 3.
Tetrahedra torus(unsigned n) {
  Tetrahedra result;
  for (unsigned cube = 0; cube < n * n * n; ++cube) {
    std::array<unsigned, 3> order = {0, 1, 2};
    do {
      std::array<unsigned, 3> at = {cube % n, cube / n % n, cube / (n * n)};
      const auto number = [&] { return static_cast<std::uint16_t>(at[0] + n * (at[1] + n * at[2])); };
      ThreeSphereTest::Tetrahedron t{number(), 0, 0, 0};
      for (unsigned step = 0; step < 3; ++step) {
        at[order[step]] = (at[order[step]] + 1) % n;
        t[step + 1] = number();
      }
      result.push_back(t);
    } while (std::next_permutation(order.begin(), order.end()));
  }
  return result;
}

/// The product of a circle of n edges and the boundary of a tetrahedron.
Tetrahedra circle_times_sphere(std::uint16_t n) {
  Tetrahedra result;
  for (std::uint16_t i = 0; i < n; ++i)
    for (std::uint16_t omitted = 0; omitted < 4; ++omitted) {
      std::array<std::uint16_t, 3> low{}, high{};
      for (std::uint16_t v = 0, k = 0; v < 4; ++v)
        if (v != omitted) {
          low[k] = static_cast<std::uint16_t>(4 * i + v);
          high[k++] = static_cast<std::uint16_t>(4 * ((i + 1) % n) + v);
        }
      result.push_back({low[0], low[1], low[2], high[2]});
      result.push_back({low[0], low[1], high[1], high[2]});
      result.push_back({low[0], high[0], high[1], high[2]});
    }
  return result;
}

TEST(ThreeSphereTest, KnowsSpheres) {
  ThreeSphereTest is_sphere;
  EXPECT_TRUE(is_sphere(Tetrahedra{{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 3, 4}, {0, 2, 3, 4}, {1, 2, 3, 4}}));
  for (std::uint16_t m = 3; m < 9; ++m)
    for (std::uint16_t n = 3; n < 9; ++n) EXPECT_TRUE(is_sphere(join_of_circles(m, n))) << m << ", " << n;
}

TEST(ThreeSphereTest, KnowsManifoldsWithHomology) {
  ThreeSphereTest is_sphere;
  for (std::uint16_t n = 3; n < 6; ++n) {
    EXPECT_FALSE(is_sphere(torus(n))) << n;
    EXPECT_FALSE(is_sphere(circle_times_sphere(n))) << n;
  }
  EXPECT_TRUE(is_sphere(join_of_circles(3, 3))) << "after others";
}

TEST(ThreeSphereTest, RefusesWhatIsNoClosedManifold) {
  ThreeSphereTest is_sphere;
  Tetrahedra open = join_of_circles(4, 4);
  open.pop_back();
  EXPECT_THROW(static_cast<void>(is_sphere(open)), std::invalid_argument);
  Tetrahedra branching = join_of_circles(4, 4);
  branching.push_back({0, 1, 4, 9});
  EXPECT_THROW(static_cast<void>(is_sphere(branching)), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(is_sphere(join_of_circles(130, 130))), std::length_error);
}

/// Components of Sigma in 5-cubes, spheres and others, against the slower test of complexes of any dimension. A share
/// of the 5-cubes by default, all with TEGL_FULL_TOPOLOGY=1 in the environment.
TEST(ThreeSphereTest, AgreesWithShapesOfAnyDimensionOnContoursOf5Cubes) {
  std::mt19937_64 random(5);
  FacetBuilder builder(FaceLattice::cube(5));
  ThreeSphereTest is_sphere;
  std::array<std::size_t, 2> found{};
  const std::size_t tested = test::cases_to_test(3'000, 60);
  for (std::size_t i = 0; i < tested; ++i) {
    const Simplices& sigma = builder.build(random() & 0xffffffffu, {}, Geometry::without).sigma;
    tegl::detail::BasicDisjointSets<VertexId> sets;
    sets.reset(std::size_t{kNoVertex});
    for (const Simplex& s : sigma)
      for (std::size_t j = 1; j < 4; ++j) sets.join(s[0], s[j]);
    std::map<VertexId, Simplices> components;
    for (const Simplex& s : sigma) components[sets.find(s[0])].push_back(s);
    for (const auto& [root, component] : components) {
      Tetrahedra tetrahedra;
      for (const Simplex& s : component) tetrahedra.push_back({s[0], s[1], s[2], s[3]});
      const bool expected = shape_of(component) == Shape::sphere;
      EXPECT_EQ(is_sphere(tetrahedra), expected);
      ++found[expected ? 1 : 0];
    }
  }
  EXPECT_GT(found[0], 5u);
  EXPECT_GT(found[1], 30u);
}

}  // namespace
}  // namespace tegl::tile
