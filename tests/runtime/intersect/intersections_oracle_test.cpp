// SPDX-License-Identifier: BSD-3-Clause
//
// Intersections found by the library, compared with rational arithmetic.
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "intersection_oracle.hpp"
#include "random_fields.hpp"
#include "share.hpp"
#include "tegl/extract.hpp"
#include "tegl/intersections.hpp"

namespace tegl::test {
namespace {

template <int N>
std::set<std::pair<Index, Index>> numbers_of(const Intersections<N>& found) {
  std::set<std::pair<Index, Index>> result;
  for (const auto& pair : found.pairs) result.insert({pair.first, pair.second});
  return result;
}

/// Compares with the oracle; returns the number of pairs.
template <int N, class Real>
std::size_t expect_as_rational(const Contour<N, Real>& contour) {
  const Intersections<N> found = find_intersections(contour);
  const RationalSimplices<N> expected(contour);
  EXPECT_EQ(found.flat, expected.flat().size());
  EXPECT_EQ(found.pair_count, found.pairs.size());
  const auto pairs = numbers_of(found);
  EXPECT_EQ(pairs, expected.pairs());
  return pairs.size();
}

/// Random simplices over few vertices with integer coordinates from 0 to `most`: many common vertices and degeneracies.
template <int N, class Real>
Contour<N, Real> random_simplices(std::mt19937_64& bits, std::size_t vertices, std::size_t simplices,
                                  std::uint64_t most) {
  Contour<N, Real> contour;
  contour.vertices.resize(vertices);
  for (auto& vertex : contour.vertices)
    for (Real& x : vertex) x = static_cast<Real>(random_below(bits, most + 1));
  contour.simplices.resize(simplices);
  for (auto& simplex : contour.simplices)
    for (Index& v : simplex) v = static_cast<Index>(random_below(bits, vertices));
  return contour;
}

template <class T>
class IntersectionsByOracle : public ::testing::Test {};
template <int kDimension, class R>
struct Kind {
  static constexpr int N = kDimension;
  using Real = R;
};
using Kinds =
    ::testing::Types<Kind<2, double>, Kind<2, float>, Kind<3, double>, Kind<3, float>, Kind<4, double>, Kind<4, float>>;
TYPED_TEST_SUITE(IntersectionsByOracle, Kinds);

TYPED_TEST(IntersectionsByOracle, SmallIntegersWithManyDegeneracies) {
  constexpr int N = TypeParam::N;
  std::mt19937_64 bits(22);
  std::size_t pairs = 0;
  for (const std::uint64_t most : {1, 2, 3, 9})
    for (const std::size_t vertices : {N + 2, 3 * N, 12 * N})
      for (int run = 0; run < (N == 4 ? 2 : 5); ++run)
        pairs += expect_as_rational(random_simplices<N, typename TypeParam::Real>(bits, vertices, 16, most));
  EXPECT_GT(pairs, 300u);
}

// Signs that rounding errors change: the same degenerate configurations after a sheared and scaled map with rounding,
// with offsets, and with vertices moved by the last bit.
TYPED_TEST(IntersectionsByOracle, NearlyDegenerate) {
  constexpr int N = TypeParam::N;
  using Real = typename TypeParam::Real;
  std::mt19937_64 bits(23);
  std::size_t pairs = 0;
  for (const double offset : {0.0, 1000.0, 1e6})
    for (int run = 0; run < (N == 4 ? 3 : 8); ++run) {
      auto contour = random_simplices<N, Real>(bits, 4 * N, 16, 2);
      for (auto& vertex : contour.vertices) {
        auto moved = vertex;
        for (int a = 0; a < N; ++a) {
          moved[a] = static_cast<Real>(offset + 0.1 * vertex[a] + 0.3 * vertex[(a + 1) % N]);
          if (random_below(bits, 4) == 0) moved[a] = std::nextafter(moved[a], Real(0));
        }
        vertex = moved;
      }
      pairs += expect_as_rational(contour);
    }
  EXPECT_GT(pairs, 100u);
}

// Too large or too small for floating-point determinants, and with exponents far apart.
TYPED_TEST(IntersectionsByOracle, ExtremeExponents) {
  constexpr int N = TypeParam::N;
  using Real = typename TypeParam::Real;
  constexpr int kMost = std::numeric_limits<Real>::max_exponent - 4, kLeast = std::numeric_limits<Real>::min_exponent;
  std::mt19937_64 bits(24);
  std::size_t pairs = 0;
  for (int run = 0; run < 6; ++run) {
    auto contour = random_simplices<N, Real>(bits, 4 * N, 12, 3);
    for (auto& vertex : contour.vertices)
      for (int a = 0; a < N; ++a) {
        const bool is_large = run % 3 == 0 || (run % 3 == 2 && random_below(bits, 2) == 0);
        vertex[a] = std::ldexp(vertex[a] - Real(1), is_large ? kMost : kLeast);
      }
    pairs += expect_as_rational(contour);
  }
  EXPECT_GT(pairs, 20u);
}

// Contours with moved vertices: closed stars, most of them embedded, some not.
TYPED_TEST(IntersectionsByOracle, ContoursOfNoiseWithMovedVertices) {
  constexpr int N = TypeParam::N;
  using Real = typename TypeParam::Real;
  std::mt19937_64 bits(25);
  for (const double moved : {0.0, 0.1, 0.4}) {
    std::size_t pairs = 0;
    for (int run = 0; run < (N == 4 ? 1 : 3); ++run) {
      const auto field = random_field<N>(bits, N == 2 ? 8 : N == 3 ? 3 : 1, 1 << 20, true);
      const auto image = image_of<float>(field);
      ExtractOptions options;
      options.ambiguity = Ambiguity::mean;
      auto contour = extract<Real>(image.view(), 0.0, options);
      for (auto& vertex : contour.vertices)
        for (Real& x : vertex)
          x += static_cast<Real>(moved * (static_cast<double>(random_below(bits, 2001)) / 1000 - 1));
      pairs += expect_as_rational(contour);
    }
    if (moved == 0.0) {
      EXPECT_EQ(pairs, 0u) << "a contour of which nothing was moved";
    }
    if (moved > 0.3) {
      EXPECT_GE(pairs, 1u);
    }
  }
}

}  // namespace
}  // namespace tegl::test
