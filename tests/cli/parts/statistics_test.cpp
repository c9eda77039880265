// SPDX-License-Identifier: BSD-3-Clause
//
// Statistics and suggested isovalues, against direct computation.
#include "base/statistics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

namespace tegl::cli {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class T>
ValueStatistics of_row(const std::vector<T>& values) {
  const std::array<std::size_t, 1> sizes = {values.size()};
  return value_statistics(std::span<const T>(values), sizes);
}

const Suggestion* find(const ValueStatistics& statistics, const std::string& method) {
  const auto found = std::find_if(statistics.suggestions.begin(), statistics.suggestions.end(),
                                  [&](const Suggestion& suggestion) { return suggestion.method == method; });
  return found == statistics.suggestions.end() ? nullptr : &*found;
}

TEST(Statistics, AgreeWithDirectComputationForEveryType) {
  const auto compare = [](auto zero) {
    using T = decltype(zero);
    std::mt19937_64 bits(11);
    std::vector<T> values(3000);
    for (T& value : values) value = static_cast<T>(static_cast<double>(bits() % 100) + 0.25);
    const ValueStatistics statistics = of_row(values);
    std::sort(values.begin(), values.end());
    const double n = static_cast<double>(values.size());
    double sum = 0;
    for (const T value : values) sum += static_cast<double>(value);
    double squares = 0;
    for (const T value : values) squares += std::pow(static_cast<double>(value) - sum / n, 2);
    EXPECT_EQ(statistics.samples, values.size());
    EXPECT_EQ(statistics.min, static_cast<double>(values.front()));
    EXPECT_EQ(statistics.max, static_cast<double>(values.back()));
    EXPECT_NEAR(statistics.mean, sum / n, 1e-9);
    EXPECT_NEAR(statistics.deviation, std::sqrt(squares / n), 1e-9);
    ASSERT_EQ(statistics.percentiles.size(), 8u);
    for (const auto& [percent, value] : statistics.percentiles) {
      const auto rank = static_cast<std::size_t>(std::ceil(percent / 100 * n)) - 1;
      EXPECT_EQ(value, static_cast<double>(values[rank])) << percent;
    }
    const auto& counts = statistics.histogram.counts;
    EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}), values.size());
  };
  compare(std::uint8_t{});
  compare(std::int8_t{});
  compare(std::uint16_t{});
  compare(std::int16_t{});
  compare(std::int32_t{});
  compare(0.0f);
  compare(0.0);
}

TEST(Statistics, PercentilesAreExactWhereOneValueLiesFarOut) {
  std::vector<double> values(1001);
  std::iota(values.begin(), values.end(), 0.0);
  std::shuffle(values.begin(), values.end(), std::mt19937_64(5));
  values.push_back(1e20);  // all others fall into one bin
  const ValueStatistics statistics = of_row(values);
  EXPECT_EQ(statistics.percentiles[3], std::pair(50.0, 500.0));
  EXPECT_EQ(statistics.percentiles[5], std::pair(90.0, 901.0));
}

TEST(Statistics, MissingAndInfiniteSamplesAreCountedAndLeftOut) {
  const ValueStatistics statistics = of_row<double>({1, kNan, 3, kInfinity, kNan, -kInfinity, 2});
  EXPECT_EQ(statistics.samples, 7u);
  EXPECT_EQ(statistics.missing, 2u);
  EXPECT_EQ(statistics.infinite, 2u);
  EXPECT_EQ(statistics.min, 1.0);
  EXPECT_EQ(statistics.max, 3.0);
  EXPECT_EQ(statistics.mean, 2.0);
}

TEST(Statistics, NothingFiniteGivesNoNumbers) {
  const ValueStatistics statistics = of_row<float>({NAN, NAN});
  EXPECT_EQ(statistics.finite(), 0u);
  EXPECT_TRUE(std::isnan(statistics.min));
  EXPECT_TRUE(std::isnan(statistics.mean));
  EXPECT_TRUE(statistics.suggestions.empty());
}

TEST(Statistics, RangesAtTheEndsOfTheTypesAreNoTrouble) {
  const double most = std::numeric_limits<double>::max();
  EXPECT_EQ(of_row<double>({-most, most, 0}).max, most);
  EXPECT_EQ(of_row<double>({0, 5e-324}).max, 5e-324);
  EXPECT_EQ(
      of_row<std::int32_t>({std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()}).min,
      -2147483648.0);
  EXPECT_TRUE(of_row<float>({7, 7, 7}).suggestions.empty());
  EXPECT_TRUE(of_row<std::uint8_t>({7, 7, 7}).suggestions.empty());
}

TEST(Statistics, CoarserHistogramsKeepTheCounts) {
  const Histogram fine{.low = 10, .width = 2, .counts = {1, 2, 3, 4, 5}};
  const Histogram coarse = fine.coarser(3);
  EXPECT_EQ(coarse.low, 10);
  EXPECT_EQ(coarse.width, 4);
  EXPECT_THAT(coarse.counts, testing::ElementsAre(3, 7, 5));
  EXPECT_EQ(fine.coarser(100).counts, fine.counts);
}

TEST(Suggestions, OtsuLiesBetweenTwoClasses) {
  std::vector<std::uint8_t> values(100, 10);
  values.resize(150, 90);
  const ValueStatistics statistics = of_row(values);
  const Suggestion* otsu = find(statistics, "otsu");
  ASSERT_NE(otsu, nullptr);
  EXPECT_NEAR(otsu->value, 50, 0.5);  // the middle of the gap
  EXPECT_EQ(otsu->critical_edges, 1u);
}

TEST(Suggestions, ContrastFindsTheSteepStep) {
  // A slow ramp from 0 to 40, a jump to 100, a slow ramp to 140.
  std::vector<float> values;
  for (int i = 0; i <= 40; ++i) values.push_back(static_cast<float>(i));
  for (int i = 100; i <= 140; ++i) values.push_back(static_cast<float>(i));
  const ValueStatistics statistics = of_row(values);
  const Suggestion* contrast = find(statistics, "contrast");
  ASSERT_NE(contrast, nullptr);
  EXPECT_GT(contrast->value, 40);
  EXPECT_LT(contrast->value, 100);
}

TEST(Suggestions, CountTheEdgesThatTheirContourCuts) {
  const std::array<std::size_t, 3> sizes = {7, 6, 5};
  std::mt19937_64 bits(3);
  std::vector<std::uint8_t> values(7 * 6 * 5);
  for (std::uint8_t& value : values) value = static_cast<std::uint8_t>(bits() >> 56);
  const ValueStatistics statistics = value_statistics(std::span<const std::uint8_t>(values), sizes);
  ASSERT_GE(statistics.suggestions.size(), 3u);
  for (const Suggestion& suggestion : statistics.suggestions) {
    std::uint64_t edges = 0;
    for (std::size_t z = 0; z < 5; ++z) {
      for (std::size_t y = 0; y < 6; ++y) {
        for (std::size_t x = 0; x < 7; ++x) {
          const auto high = [&](std::size_t i, std::size_t j, std::size_t k) {
            return values[i + 7 * (j + 6 * k)] >= suggestion.value;
          };
          if (x + 1 < 7) edges += high(x, y, z) != high(x + 1, y, z);
          if (y + 1 < 6) edges += high(x, y, z) != high(x, y + 1, z);
          if (z + 1 < 5) edges += high(x, y, z) != high(x, y, z + 1);
        }
      }
    }
    EXPECT_EQ(suggestion.critical_edges, edges) << suggestion.method;
    EXPECT_GT(suggestion.value, statistics.min);
    EXPECT_LE(suggestion.value, statistics.max);
    EXPECT_EQ(suggestion.value, std::floor(suggestion.value) + 0.5) << suggestion.method;
  }
}

TEST(Suggestions, NeighbouringWholeNumbersAreSplitBetweenThem) {
  const ValueStatistics statistics = of_row<std::uint8_t>({0, 1, 0, 1, 1});
  ASSERT_EQ(statistics.suggestions.size(), 1u);
  EXPECT_EQ(statistics.suggestions[0].value, 0.5);
  EXPECT_EQ(statistics.suggestions[0].critical_edges, 3u);
}

}  // namespace
}  // namespace tegl::cli
