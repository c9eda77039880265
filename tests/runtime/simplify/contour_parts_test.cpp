// SPDX-License-Identifier: BSD-3-Clause
//
// Parts of contours whose edges are contracted at the same time.
#include "simplify/contour_parts.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

#include "fields.hpp"
#include "simplified.hpp"
#include "simplify/edge_collapse.hpp"
#include "simplify/simplify_orders.hpp"
#include "tegl/check.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {
namespace {

using detail::ContourParts;
using detail::EdgeCollapse;
using detail::PointN;

template <class Dimension>
class Parts : public testing::Test {};
using PartDimensions =
    testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>, std::integral_constant<int, 4>>;
TYPED_TEST_SUITE(Parts, PartDimensions);

template <int N>
Contour<N, double> contour_of_parts() {
  const auto image = noise<float, N>(N == 4 ? 9 : N == 3 ? 28 : 200, 3);
  return extract<double>(image.view(), 0.5);
}

template <int N>
EdgeCollapse<N> collapse_of(const Contour<N, double>& contour,
                            double tolerance = std::numeric_limits<double>::infinity()) {
  detail::CollapseInput<N> input;
  input.simplices = contour.simplices;
  input.points.assign(contour.vertices.begin(), contour.vertices.end());
  input.tolerance.assign(contour.vertices.size(), tolerance);
  input.scale.fill(1.0);
  return EdgeCollapse<N>(std::move(input));
}

template <int N>
ContourParts<N> parts_of(EdgeCollapse<N>& collapse) {
  return ContourParts<N>(collapse.scaled(), [&](const auto& visit) {
    for (Index s = 0; s < collapse.complex().simplex_count(); ++s) visit(collapse.complex().simplex(s));
  });
}

/// Expects that no simplex has vertices of two parts. Returns how many have a vertex of each part, and of none only.
template <int N>
std::vector<std::size_t> expect_apart(EdgeCollapse<N>& collapse, const ContourParts<N>& parts) {
  std::vector<std::size_t> counts(ContourParts<N>::kCount + 1, 0);
  for (Index s = 0; s < collapse.complex().simplex_count(); ++s) {
    if (!collapse.complex().is_alive(s)) continue;
    std::size_t found = ContourParts<N>::kNone;
    for (const Index v : collapse.complex().simplex(s)) {
      const std::size_t part = parts.of(v, v);
      if (part == ContourParts<N>::kNone) continue;
      EXPECT_TRUE(found == ContourParts<N>::kNone || found == part) << s;
      found = part;
    }
    ++counts[found];
  }
  return counts;
}

TYPED_TEST(Parts, NoSimplexHasVerticesOfTwo) {
  constexpr int N = TypeParam::value;
  const Contour<N, double> contour = contour_of_parts<N>();
  EdgeCollapse<N> collapse = collapse_of(contour);
  ContourParts<N> parts = parts_of(collapse);
  const std::vector<std::size_t> counts = expect_apart(collapse, parts);
  for (std::size_t part = 0; part < ContourParts<N>::kCount; ++part)
    EXPECT_GT(counts[part], contour.simplices.size() / 40) << part;
  EXPECT_GT(counts[ContourParts<N>::kNone], 0u);
  // contractions anywhere
  detail::LoadedEdge<N> loaded;
  std::mt19937 random(5);
  std::size_t contracted = 0;
  for (std::size_t trial = 0; trial < contour.simplices.size(); ++trial) {
    const auto s = static_cast<Index>(random() % contour.simplices.size());
    if (!collapse.complex().is_alive(s)) continue;
    const std::array<Index, N> simplex = collapse.complex().simplex(s);
    const auto target = collapse.best_target(simplex[0], simplex[1]);
    if (!target || !collapse.try_contract(simplex[0], simplex[1], *target, loaded)) continue;
    parts.merge(simplex[0], simplex[1]);
    ++contracted;
  }
  EXPECT_GT(contracted, contour.vertices.size() / 20);
  expect_apart(collapse, parts);
}

TYPED_TEST(Parts, OfPointsAtOnePlaceAreOne) {
  constexpr int N = TypeParam::value;
  const std::vector<PointN<N>> points(100, PointN<N>{});
  const ContourParts<N> parts(points, [](const auto&) {});
  for (Index v = 1; v < points.size(); ++v) EXPECT_NE(parts.of(0, v), ContourParts<N>::kNone);
}

/// Contracts to a third. `least_in_parts`: simplices of contours with parts.
template <int N>
Contour<N, double> collapsed(const Contour<N, double>& contour, unsigned threads, std::size_t least_in_parts) {
  EdgeCollapse<N> collapse = collapse_of(contour);
  detail::CollapseGoal goal;
  goal.count = contour.simplices.size() / 3;
  goal.by_mean = true;
  goal.threads = threads;
  goal.least_in_parts = least_in_parts;
  detail::collapse_by_quadrics(collapse, goal);
  EXPECT_LE(collapse.complex().alive(), goal.count);
  EXPECT_GT(collapse.complex().alive(), goal.count - goal.count / 20);
  Contour<N, double> result;
  constexpr Index kUnused = std::numeric_limits<Index>::max();
  std::vector<Index> number(collapse.points().size(), kUnused);
  for (Index s = 0; s < collapse.complex().simplex_count(); ++s) {
    if (!collapse.complex().is_alive(s)) continue;
    for (const Index v : result.simplices.emplace_back(collapse.complex().simplex(s))) {
      if (number[v] != kUnused) continue;
      number[v] = static_cast<Index>(result.vertices.size());
      result.vertices.push_back(collapse.points()[v]);
    }
    for (Index& v : result.simplices.back()) v = number[v];
  }
  EXPECT_EQ(result.simplices.size(), collapse.complex().alive());
  return result;
}

TYPED_TEST(Parts, ContractTheSameEdgesOnAnyNumberOfThreads) {
  constexpr int N = TypeParam::value;
  // smooth: rough contours cannot be reduced to a third
  std::array<std::size_t, N> sizes;
  sizes.fill(N == 4 ? 14 : N == 3 ? 44 : 700);
  const auto image = sample_field<float, N>(Grid<N>::unit(sizes), [](const auto& x) {
    double sum = 0.0;
    for (int a = 0; a < N; ++a) sum += std::sin((N == 2 ? 0.25 : 0.55) * x[a] + a);
    return sum;
  });
  const Contour<N, double> contour = extract<double>(image.view(), 0.3);
  ASSERT_GT(contour.simplices.size(), 30'000u);
  const Contour<N, double> in_parts = collapsed<N>(contour, 1, 0);
  ASSERT_FALSE(in_parts.simplices.empty());
  EXPECT_NE(in_parts.vertices, collapsed<N>(contour, 1, contour.simplices.size() + 1).vertices);  // another order
  for (const unsigned threads : {2u, 3u}) {
    const Contour<N, double> other = collapsed<N>(contour, threads, 0);
    EXPECT_EQ(other.simplices, in_parts.simplices);
    EXPECT_EQ(other.vertices, in_parts.vertices);
  }
  expect_same_topology(check(contour), check(in_parts));
}

/// A tolerance stops contractions before the goal. Whether it did does not depend on the number of threads either.
TYPED_TEST(Parts, RespectTolerances) {
  constexpr int N = TypeParam::value;
  const Contour<N, double> contour = contour_of_parts<N>();
  const auto removed = [&](double tolerance, unsigned threads) {
    EdgeCollapse<N> collapse = collapse_of(contour, tolerance);
    detail::CollapseGoal goal;
    goal.threads = threads;
    goal.least_in_parts = 0;
    detail::collapse_by_quadrics(collapse, goal);
    return std::pair(contour.simplices.size() - collapse.complex().alive(), collapse.is_limited());
  };
  const auto [narrow, is_limited] = removed(0.05, 1);
  EXPECT_TRUE(is_limited);
  EXPECT_GT(narrow, 0u);
  EXPECT_GT(removed(0.5, 1).first, narrow);
  for (const unsigned threads : {2u, 3u}) EXPECT_EQ(removed(0.05, threads), std::pair(narrow, is_limited));
  EXPECT_FALSE(removed(std::numeric_limits<double>::infinity(), 2).second);
}

}  // namespace
}  // namespace tegl::test
