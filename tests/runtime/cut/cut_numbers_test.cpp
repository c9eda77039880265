// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers of the points of a cut, and ranges of vertex numbers, compared with maps and the standard library.
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <random>
#include <set>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "cut/point_numbers.hpp"
#include "cut/vertex_range.hpp"
#include "errors.hpp"
#include "only_targets.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace {

using detail::PointKey;

/// Keys of random edges: lower ends below `lower`, upper ends below `upper`.
std::vector<PointKey> random_keys(std::size_t count, Index lower, Index upper, std::mt19937_64& bits) {
  std::vector<PointKey> keys(count);
  for (PointKey& key : keys)
    key = detail::edge_point(static_cast<Index>(bits() % lower), static_cast<Index>(bits() % upper));
  return keys;
}

TEST(PointNumbers, OfAPartAreInTheOrderOfAppearance) {
  std::mt19937_64 bits(1);
  detail::PartPoints points;
  for (const std::size_t count : {0, 1, 40, 3000, 20000, 7}) {  // parts one after the other, with the same table
    const std::vector<PointKey> keys = random_keys(count, 300, 20, bits);
    std::vector<PointKey> expected;
    for (const PointKey key : keys) {
      const auto at = std::find(expected.begin(), expected.end(), key);
      ASSERT_EQ(points.number_of(key), at - expected.begin());
      if (at == expected.end()) expected.push_back(key);
    }
    EXPECT_EQ(points.take_keys(), expected);
  }
}

TEST(PointNumbers, OfAllPartsAreInTheOrderOfTheKeys) {
  constexpr Index kMost = std::numeric_limits<Index>::max();
  std::mt19937_64 bits(2);
  for (const auto& [lower, upper] : {std::array<Index, 2>{5000, 10}, {kMost, kMost}, {3, 5000}, {1, 1}}) {
    std::vector<std::vector<PointKey>> parts;
    std::vector<PointKey> all;
    std::set<PointKey> different;
    for (const std::size_t count : {900, 0, 1, 2500}) {
      parts.push_back(random_keys(count, lower, upper, bits));
      all.insert(all.end(), parts.back().begin(), parts.back().end());
    }
    different.insert(all.begin(), all.end());
    std::vector<Index> numbers;
    const std::vector<PointKey> keys =
        detail::number_points_of_parts(std::vector<std::span<const PointKey>>(parts.begin(), parts.end()), numbers);
    EXPECT_EQ(keys, std::vector<PointKey>(different.begin(), different.end()));
    ASSERT_EQ(numbers.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) ASSERT_EQ(keys[numbers[i]], all[i]);
  }
}

TEST(VertexRange, HasTheLeastAndTheLargestNumberOnAllInstructionSets) {
  std::mt19937_64 bits(3);
  test::with_all_targets([&] {
    for (std::size_t count = 1; count < 100; ++count) {
      std::vector<Index> numbers(count);
      for (Index& number : numbers) number = static_cast<Index>(bits());
      const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
      const detail::VertexRange range = detail::vertex_range(numbers);
      ASSERT_EQ(range.least, *least) << count;
      ASSERT_EQ(range.most, *most) << count;
    }
  });
}

/// A row of tetrahedra over time, whose vertices are numbered in the order of time.
Contour<4, double> row_over_time(std::size_t count) {
  Contour<4, double> row;
  for (std::size_t i = 0; i < count + 3; ++i) {
    const auto t = static_cast<double>(i);
    row.vertices.push_back({i % 2 == 0 ? t : 0.0, i % 3 == 0 ? t : 0.0, i % 5 == 0 ? t : 1.0, t});
  }
  for (Index i = 0; i < count; ++i) row.simplices.push_back({i, i + 1, i + 2, i + 3});
  return row;
}

TEST(Slice, FindsTheSimplicesAtTheEndsOfSkippedBlocks) {
  const Contour<4, double> row = row_over_time(2000);
  for (std::size_t i = 0; i < 2002; ++i) {  // a time between vertices i and i + 1 is in up to three tetrahedra
    const std::size_t expected = std::min<std::size_t>({i + 1, 3, 2002 - i});
    const auto cut = slice(row, Hyperplane<4>::across(3, static_cast<double>(i) + 0.5));
    const std::size_t halves = i == 0 || i == 2001 ? 0 : std::min<std::size_t>({i, 1, 2001 - i});
    ASSERT_EQ(cut.simplices.size(), expected + halves) << i;  // the tetrahedron in the middle gives two triangles
  }
}

TEST(Slice, RefusesOneCoordinateThatIsNotFinite) {
  constexpr double kLargest = std::numeric_limits<double>::max(), kInfinity = std::numeric_limits<double>::infinity();
  Contour<4, double> row = row_over_time(2000);
  for (const std::size_t v : {0, 1, 777, 2002}) {
    double& x = row.vertices[v][v % 3];
    const double before = x;
    for (const double odd : {kLargest, -kLargest, -0.0, std::numeric_limits<double>::denorm_min()}) {
      x = odd;
      EXPECT_NO_THROW(static_cast<void>(slice(row, Hyperplane<4>::across(3, 10.5))));
    }
    for (const double odd : {kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
      x = odd;
      test::expect_error(ErrorCode::InvalidArgument, fmt::format("a coordinate of vertex {} is", v),
                         [&] { static_cast<void>(slice(row, Hyperplane<4>::across(3, 10.5))); });
    }
    x = before;
  }
}

}  // namespace
}  // namespace tegl
