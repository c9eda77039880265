// SPDX-License-Identifier: BSD-3-Clause
//
// bench/embedded/tile_pairs.hpp, by which bench/tile_intersections tests cells, finds the contours that
// find_intersections finds.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>

#include "tegl/extract.hpp"
#include "tegl/intersections.hpp"
#include "tile_pairs.hpp"

namespace tegl {
namespace {

double share(std::mt19937_64& bits) { return static_cast<double>(bits() >> 11) * 0x1p-53; }

/// Compares both tests; true if there is an intersection.
template <int N>
bool is_hit(const Contour<N, double>& contour, bench::TilePairs<N>& pairs) {
  const Intersections<N> found = find_intersections(contour);
  EXPECT_EQ(pairs.is_embedded(contour), found.is_embedded());
  return !found.is_embedded();
}

/// Two to four simplices on a few points: with coordinates 0 to 3, which often touch or lie in one hyperplane, or any.
template <int N>
Contour<N, double> random_simplices(std::mt19937_64& bits) {
  Contour<N, double> contour;
  const bool is_lattice = bits() % 2 == 0;
  contour.vertices.resize(N + 1 + bits() % N);
  for (auto& vertex : contour.vertices)
    for (double& x : vertex) x = is_lattice ? static_cast<double>(bits() % 4) : share(bits);
  contour.simplices.resize(2 + bits() % 3);
  for (auto& simplex : contour.simplices)
    for (auto& v : simplex) v = static_cast<Index>(bits() % contour.vertices.size());
  return contour;
}

/// The contour of a cell by mean, of which one vertex is moved.
template <int N>
Contour<N, double> moved_cell(std::mt19937_64& bits) {
  std::array<double, std::size_t{1} << N> values;
  for (double& value : values) value = share(bits) - 0.5;
  std::array<std::size_t, N> sizes;
  sizes.fill(2);
  ExtractOptions options;
  options.ambiguity = Ambiguity::mean;
  auto contour = extract<double>(Image<double, N>(values.data(), Grid<N>::unit(sizes)), 0.0, options);
  if (!contour.vertices.empty())
    for (double& x : contour.vertices[bits() % contour.vertices.size()]) x += 2.0 * (share(bits) - 0.5);
  return contour;
}

template <int N, class Make>
void compare(int count, int least_hit, int least_not_hit, const Make& make) {
  std::mt19937_64 bits(20261128);
  bench::TilePairs<N> pairs;
  int hit = 0;
  for (int i = 0; i < count; ++i) hit += is_hit(make(bits), pairs) ? 1 : 0;
  EXPECT_GE(hit, least_hit) << count;
  EXPECT_GE(count - hit, least_not_hit) << count;
}

TEST(TilePairs, FindWhatFindIntersectionsFinds) {
  compare<3>(4000, 400, 200, random_simplices<3>);
  compare<4>(4000, 400, 100, random_simplices<4>);
  compare<3>(1000, 20, 100, moved_cell<3>);
  compare<4>(600, 100, 50, moved_cell<4>);
}

}  // namespace
}  // namespace tegl
