// SPDX-License-Identifier: BSD-3-Clause
//
// Intersecting pairs of 5D contours as found by the benchmarks, compared with rational arithmetic.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "five_intersections.hpp"
#include "intersection_oracle.hpp"
#include "random_fields.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

using Five = Contour<5, double>;

/// Compares with the oracle; returns the pairs found and the number of pairs that were decided by integers.
bench::FiveIntersections expect_as_rational(const Five& contour) {
  const bench::FiveIntersections found = bench::FivePairs(contour).intersections();
  const RationalSimplices<5> expected(contour);
  EXPECT_EQ(found.flat, expected.flat().size());
  EXPECT_EQ(std::set(found.pairs.begin(), found.pairs.end()), expected.pairs());
  return found;
}

// Few vertices on a coarse lattice: simplices with any number of common vertices, that touch, lie in one hyperplane or
// are flat.
TEST(FivePairs, OfRandomSimplicesAreAsByRationalNumbers) {
  std::mt19937_64 bits(5);
  std::size_t pairs = 0, flat = 0;
  for (int run = 0; run < 12; ++run) {
    Five contour;
    contour.vertices.resize(7 + run % 4);
    const std::uint64_t steps = run % 3 == 0 ? 2 : 1000;
    for (auto& vertex : contour.vertices)
      for (double& x : vertex) x = static_cast<double>(random_below(bits, steps + 1)) / static_cast<double>(steps);
    contour.simplices.resize(7);
    std::vector<Index> numbers(contour.vertices.size());
    std::iota(numbers.begin(), numbers.end(), Index{0});
    for (auto& simplex : contour.simplices) {
      std::shuffle(numbers.begin(), numbers.end(), bits);
      std::copy_n(numbers.begin(), 5, simplex.begin());
    }
    contour.simplices[0][4] = contour.simplices[0][1];
    const bench::FiveIntersections found = expect_as_rational(contour);
    pairs += found.pairs.size();
    flat += found.flat;
  }
  EXPECT_GT(pairs, 20u);
  EXPECT_GE(flat, 12u);
}

// Simplices of one cell, whose vertices are moved.
TEST(FivePairs, OfMovedContoursAreAsByRationalNumbers) {
  std::mt19937_64 bits(55);
  std::size_t pairs = 0;
  for (const double by : {0.02, 1.0}) {
    std::array<double, 32> values;
    for (double& value : values) value = static_cast<double>(random_below(bits, 2001)) / 1000 - 0.9995;
    std::array<std::size_t, 5> sizes;
    sizes.fill(2);
    Five contour = extract<double>(Image<double, 5>(values.data(), Grid<5>::unit(sizes)), 0.0, {});
    for (auto& vertex : contour.vertices)
      for (double& x : vertex) {
        x += by * (static_cast<double>(random_below(bits, 2001)) / 1000 - 1);
        x = std::clamp(x, 0.0, 1.0);
      }
    ASSERT_GT(contour.simplices.size(), 20u);
    std::shuffle(contour.simplices.begin(), contour.simplices.end(), bits);
    contour.simplices.resize(14);
    pairs += expect_as_rational(contour).pairs.size();
  }
  EXPECT_GT(pairs, 10u);
}

}  // namespace
}  // namespace tegl::test
