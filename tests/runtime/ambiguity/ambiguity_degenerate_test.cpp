// SPDX-License-Identifier: BSD-3-Clause
//
// Samples and saddles equal to the isovalue: for every way to resolve ambiguities the contour is a closed manifold, and
// with `epsilon` no simplex has size zero. Saddle treats values at the isovalue as high: the topology is that just
// below the isovalue. A share of the fields by default, all with TEGL_FULL_TOPOLOGY=1 in the environment.
#include <random>

#include <gtest/gtest.h>

#include "estimators.hpp"
#include "fields.hpp"
#include "invariants.hpp"
#include "multilinear.hpp"
#include "random_fields.hpp"
#include "same_topology.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

/// Integers from -2 to 2; if `mask`, values -1 and 1, whose edge points are midpoints.
template <int N>
SampledField<N> degenerate_field(std::mt19937_64& bits, std::size_t samples, bool mask, bool padded) {
  SampledField<N> field = random_field<N>(bits, samples, mask ? 1 : 2, padded);
  if (mask)
    for (std::int64_t& value : field.values) value = value < 0 || (value == 0 && bits() % 2 == 0) ? -1 : 1;
  return field;
}

/// Closed alternately by padding and by options.close.
template <int N>
void expect_closed_manifolds(std::uint64_t seed, std::size_t count, std::size_t samples, bool mask) {
  std::mt19937_64 bits(seed);
  const auto ways = all_ways();
  for (std::size_t i = 0; i < count; ++i) {
    const auto field = degenerate_field<N>(bits, samples, mask, i % 2 == 0);
    const auto image = image_of<std::int8_t>(field);
    for (auto [name, options] : ways) {
      SCOPED_TRACE(name + ", seed " + std::to_string(seed) + ", field " + std::to_string(i) + ", " + describe(field));
      options.close = i % 2 != 0;
      ASSERT_TRUE(is_closed_oriented_manifold(check(extract<float>(image.view(), 0.0, options))));
      const bool by_table = options.ambiguity == Ambiguity::low || options.ambiguity == Ambiguity::high;
      // See docs/limits.md.
      if (N == 4 && (options.triangulation == Triangulation::compact || (!by_table && options.close))) continue;
      options.epsilon = 0.05;
      const auto apart = check(extract<float>(image.view(), 0.0, options));
      ASSERT_TRUE(is_closed_oriented_manifold(apart));
      ASSERT_EQ(apart.degenerate_simplices, 0u);
    }
  }
}

TEST(Degenerate, IntegersIn2dHaveClosedCurves) { expect_closed_manifolds<2>(1, cases_to_test(10'000, 300), 6, false); }
TEST(Degenerate, IntegersIn3dHaveClosedManifolds) {
  expect_closed_manifolds<3>(2, cases_to_test(10'000, 100), 5, false);
}
TEST(Degenerate, MasksIn2dHaveClosedCurves) { expect_closed_manifolds<2>(3, cases_to_test(10'000, 300), 6, true); }
TEST(Degenerate, MasksIn3dHaveClosedManifolds) { expect_closed_manifolds<3>(4, cases_to_test(10'000, 100), 5, true); }
TEST(Degenerate, IntegersIn4dHaveClosedManifolds) { expect_closed_manifolds<4>(5, cases_to_test(100, 2), 3, false); }
TEST(Degenerate, MasksIn4dHaveClosedManifolds) { expect_closed_manifolds<4>(6, cases_to_test(100, 2), 3, true); }

/// Tiles of full words are decided many at a time, the tiles after them one by one.
TEST(Degenerate, RoundOffBesideWholeNumbersIsDecidedAlikeInAllTiles) {
  OwnedImage<double, 3> image{Grid<3>::unit({70, 4, 4}), {}};
  for (std::size_t s = 0; s < 70 * 4 * 4; ++s) {
    const std::size_t sum = s % 70 + s / 70 % 4 + s / 280;
    image.values.push_back(sum % 2 != 0 ? 1.0 : sum % 4 == 0 ? -1e-60 : -1.0);
  }
  for (auto [name, options] : all_ways()) {
    options.close = true;
    EXPECT_TRUE(is_closed_oriented_manifold(check(extract<double>(image.view(), 0.0, options)))) << name;
  }
}

/// `expected` is the topology of the field just below the isovalue; epsilon keeps the vertices inside their edges.
template <int N>
void expect_high_at_ties(std::uint64_t seed, std::size_t count, std::size_t samples, bool mask, bool padded) {
  std::mt19937_64 bits(seed);
  for (std::size_t i = 0; i < count; ++i) {
    const auto field = degenerate_field<N>(bits, samples, mask, padded);
    const auto below = just_below(field);
    const InterpolantTopology expected = interpolant_topology(below);
    ASSERT_TRUE(expected.regular);
    ExtractOptions options = by_ambiguity(Ambiguity::saddle);
    options.epsilon = 0.05;
    options.work.threads = 1;
    options.triangulation = i % 2 == 0 ? Triangulation::compact : Triangulation::barycentric;
    const auto contour = extract<double>(view_of(image_of<std::int16_t>(field)), 0.0, options);
    ASSERT_TRUE(has_topology_of(contour, below, expected)) << "seed " << seed << ", field " << i;
  }
}

TEST(Degenerate, SaddlesAtTheIsovalueAreHigh) {
  expect_high_at_ties<3>(7, cases_to_test(100'000, 3000), 2, false, false);
  expect_high_at_ties<3>(8, cases_to_test(10'000, 200), 5, false, true);
  expect_high_at_ties<3>(9, cases_to_test(10'000, 200), 5, false, false);
  expect_high_at_ties<3>(10, cases_to_test(10'000, 200), 5, true, true);
  expect_high_at_ties<2>(11, cases_to_test(10'000, 300), 6, false, true);
  expect_high_at_ties<2>(12, cases_to_test(10'000, 300), 6, true, true);
}

}  // namespace
}  // namespace tegl::test
