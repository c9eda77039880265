// SPDX-License-Identifier: BSD-3-Clause
//
// With Ambiguity::saddle the contour has the topology of the bilinear or trilinear interpolant's, in random cells and
// fields, as in Etiene et al., Topology verification for isosurface extraction, 2012. A share of the fields by default;
// all with TEGL_FULL_TOPOLOGY=1 in the environment.
#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <type_traits>
#include <utility>

#include <gtest/gtest.h>

#include "fields.hpp"
#include "multilinear.hpp"
#include "random_fields.hpp"
#include "same_topology.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

ExtractOptions by_saddle(Triangulation triangulation) {
  ExtractOptions options;
  options.ambiguity = Ambiguity::saddle;
  options.triangulation = triangulation;
  options.work.threads = 1;
  return options;
}

/// The isovalue that is subtracted in a field: images of types with enough range are raised by it.
template <Value T>
constexpr std::int32_t kShift = sizeof(T) >= 4 && !std::is_same_v<T, float> ? 123'456'789 : 0;

/// Compares the contour of a regular field, as an image of type T, with the oracle. Returns true if the field is
/// regular. Images of doubles have fractional values.
template <Value T, int N>
bool is_regular_and_exact(const SampledField<N>& field, Triangulation triangulation) {
  const InterpolantTopology expected = interpolant_topology(field);
  if (!expected.regular) return false;
  constexpr double kUnit = std::is_same_v<T, double> ? 0x1p-40 : 1.0;
  auto image = image_of<T>(field);
  for (T& value : image.values) value = static_cast<T>((value + static_cast<T>(kShift<T>)) * static_cast<T>(kUnit));
  const auto contour = extract<double>(image.view(), kShift<T> * kUnit, by_saddle(triangulation));
  EXPECT_TRUE(has_topology_of(contour, field, expected));
  return true;
}

constexpr Triangulation in_turn(std::size_t i) {
  return i % 2 == 0 ? Triangulation::compact : Triangulation::barycentric;
}

/// Random fields as images of type T, alternating between the triangulations.
template <Value T, int N>
void expect_exact(std::uint64_t seed, std::size_t count, std::size_t samples, std::int64_t bound, bool padded) {
  std::mt19937_64 bits(seed);
  std::size_t regular = 0;
  for (std::size_t i = 0; i < count && !::testing::Test::HasFailure(); ++i) {
    SCOPED_TRACE("seed " + std::to_string(seed) + ", field " + std::to_string(i));
    regular += is_regular_and_exact<T>(random_field<N>(bits, samples, bound, padded), in_turn(i));
  }
  EXPECT_GT(regular, count / 2);
}

TEST(Saddle, HasTheTrilinearTopologyInRandomCells) {
  expect_exact<std::int32_t, 3>(1, cases_to_test(100'000, 10'000), 2, 1 << 28, false);
  expect_exact<double, 3>(2, cases_to_test(100'000, 10'000), 2, 1 << 28, false);
  expect_exact<float, 3>(3, cases_to_test(100'000, 10'000), 2, 1 << 23, false);
}

/// Small integers are often nearly degenerate; degenerate ones are skipped.
TEST(Saddle, HasTheTrilinearTopologyInCellsOfSmallIntegers) {
  expect_exact<std::int8_t, 3>(4, cases_to_test(100'000, 10'000), 2, 60, false);
  expect_exact<std::int16_t, 3>(5, cases_to_test(100'000, 10'000), 2, 300, false);
}

/// Positive integers a, b, c, d with a d - b c = 1; a and b have 28 bits.
std::array<std::int64_t, 4> nearly_equal_products(std::mt19937_64& bits) {
  for (;;) {
    const auto a = static_cast<std::int64_t>((1u << 27) + random_below(bits, 1 << 27));
    const auto b = static_cast<std::int64_t>((1u << 27) + random_below(bits, 1 << 27));
    // Euclid's algorithm preserves r = a s modulo b.
    std::int64_t r0 = b, r1 = a % b, s0 = 0, s1 = 1;
    while (r1 > 1) {
      const std::int64_t quotient = r0 / r1;
      r0 = std::exchange(r1, r0 - quotient * r1);
      s0 = std::exchange(s1, s0 - quotient * s1);
    }
    if (r1 != 1) continue;  // not coprime
    const std::int64_t d = s1 > 0 ? s1 : s1 + b;
    return {a, b, (a * d - 1) / b, d};
  }
}

/// Squares whose saddles differ from the isovalue by less than the rounding errors of doubles.
TEST(Saddle, IsExactWhereRoundingWouldDecide) {
  std::mt19937_64 bits(11);
  const std::size_t tested = cases_to_test(100'000, 10'000);
  for (std::size_t i = 0; i < tested && !HasFailure(); ++i) {
    const auto [a, b, c, d] = nearly_equal_products(bits);
    const bool joined = bits() % 2 == 0;
    const auto square = joined ? std::array{a, -b, -c, d} : std::array{-a, b, c, -d};
    EXPECT_TRUE((is_regular_and_exact<std::int32_t, 2>({{2, 2}, {square.begin(), square.end()}}, in_turn(i))));
    SampledField<3> cube = random_field<3>(bits, 2, 1 << 28);
    std::copy(square.begin(), square.end(), cube.values.begin() + (bits() % 2 == 0 ? 4 : 0));
    EXPECT_TRUE((is_regular_and_exact<double, 3>(cube, in_turn(i))));
  }
}

TEST(Saddle, HasTheTrilinearTopologyInRandomFields) {
  expect_exact<float, 3>(6, cases_to_test(10'000, 500), 5, 1 << 23, true);
  expect_exact<double, 3>(7, cases_to_test(10'000, 500), 5, 1 << 28, false);
  expect_exact<std::int16_t, 3>(8, cases_to_test(10'000, 500), 5, 32000, true);
}

TEST(Saddle, HasTheBilinearTopologyInRandomFields) {
  expect_exact<float, 2>(9, cases_to_test(10'000, 2000), 7, 1 << 23, true);
  expect_exact<std::int32_t, 2>(10, cases_to_test(10'000, 2000), 7, 1 << 28, false);
}

}  // namespace
}  // namespace tegl::test
