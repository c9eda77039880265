// SPDX-License-Identifier: BSD-3-Clause
//
// FoundPairs keeps the first pairs of any order of additions and of any division among threads; SimplexSet.
#include "intersect/found_pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <latch>
#include <limits>
#include <random>
#include <span>
#include <thread>
#include <tuple>
#include <vector>

namespace tegl::test {
namespace {

using detail::FoundPairs;
using detail::SimplexSet;
using Pair = IntersectingPair<3>;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

Pair pair_of(Index first, Index second, double depth) {
  Pair pair;
  pair.first = first;
  pair.second = second;
  pair.depth = depth;
  pair.place = {static_cast<double>(first), static_cast<double>(second), depth};
  return pair;
}

/// Different pairs in random order. Many depths are equal, among them 0.
std::vector<Pair> random_pairs(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 bits(seed);
  std::vector<Pair> pairs;
  for (Index first = 0; pairs.size() < count; ++first)
    for (Index step = 1; step <= 3 && pairs.size() < count; ++step)
      pairs.push_back(pair_of(first, first + step, static_cast<double>(bits() % 8) / 4.0));
  std::shuffle(pairs.begin(), pairs.end(), bits);
  return pairs;
}

/// The first pairs of all, by a sort of the whole list.
std::vector<Pair> first_of(std::vector<Pair> pairs, std::size_t most, bool deepest_first) {
  std::sort(pairs.begin(), pairs.end(), [&](const Pair& p, const Pair& q) {
    const auto key = [&](const Pair& pair) {
      return std::tuple(deepest_first ? -pair.depth : 0.0, pair.first, pair.second);
    };
    return key(p) < key(q);
  });
  pairs.resize(std::min(most, pairs.size()));
  return pairs;
}

void expect_same(const std::vector<Pair>& found, const std::vector<Pair>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].first, expected[i].first) << i;
    EXPECT_EQ(found[i].second, expected[i].second) << i;
    EXPECT_EQ(found[i].depth, expected[i].depth) << i;
    EXPECT_EQ(found[i].place, expected[i].place) << i;
  }
}

void add_all(FoundPairs<3>& found, std::span<const Pair> pairs) {
  for (const Pair& pair : pairs) found.add(pair);
}

TEST(FoundPairs, StartsEmpty) {
  FoundPairs<3> found(5, true);
  EXPECT_EQ(found.count(), 0u);
  EXPECT_EQ(found.depth(), 0.0);
  EXPECT_TRUE(found.first_pairs().empty());
}

TEST(FoundPairs, OrdersByNumbersOrByDepth) {
  const std::vector<Pair> pairs = {pair_of(2, 5, 1.0), pair_of(0, 9, 0.5), pair_of(2, 3, 2.0), pair_of(1, 2, 0.5)};
  FoundPairs<3> by_numbers(kAll, false), by_depth(kAll, true);
  add_all(by_numbers, pairs);
  add_all(by_depth, pairs);
  expect_same(by_numbers.first_pairs(), {pairs[1], pairs[3], pairs[2], pairs[0]});
  expect_same(by_depth.first_pairs(), {pairs[2], pairs[0], pairs[1], pairs[3]});
}

TEST(FoundPairs, PairsOfEqualDepthAreInTheOrderOfTheirNumbers) {
  FoundPairs<3> found(3, true);
  for (Index i = 20; i > 0; --i) found.add(pair_of(i / 2, 40 - i, 0.25));
  expect_same(found.first_pairs(), {pair_of(0, 39, 0.25), pair_of(1, 37, 0.25), pair_of(1, 38, 0.25)});
}

TEST(FoundPairs, CountAndDepthAreThoseOfAllPairsAlsoOfPairsThatAreNotKept) {
  FoundPairs<3> found(2, false);
  for (Index i = 0; i < 50; ++i) found.add(pair_of(i, i + 1, i == 37 ? 3.5 : 0.125));
  EXPECT_EQ(found.count(), 50u);
  EXPECT_EQ(found.depth(), 3.5);
  expect_same(found.first_pairs(), {pair_of(0, 1, 0.125), pair_of(1, 2, 0.125)});
}

TEST(FoundPairs, ALaterPairThatComesBeforeKeptOnesReplacesTheLast) {
  FoundPairs<3> found(2, true);
  for (Index i = 0; i < 9; ++i) found.add(pair_of(i, i + 1, 1.0));
  found.add(pair_of(90, 91, 1.5));
  found.add(pair_of(80, 81, 0.5));
  expect_same(found.first_pairs(), {pair_of(90, 91, 1.5), pair_of(0, 1, 1.0)});
}

TEST(FoundPairs, KeepsTheFirstForEveryLimit) {
  for (const std::size_t count : {1u, 2u, 7u, 200u}) {
    const std::vector<Pair> pairs = random_pairs(count, count);
    for (const bool deepest_first : {false, true})
      for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{64},
                                     count - 1, count, count + 1, kAll}) {
        SCOPED_TRACE(testing::Message() << count << " pairs, at most " << most << (deepest_first ? " by depth" : ""));
        FoundPairs<3> found(most, deepest_first);
        add_all(found, pairs);
        EXPECT_EQ(found.count(), count);
        expect_same(found.first_pairs(), first_of(pairs, most, deepest_first));
      }
  }
}

// Blocks of any size that are added to a few objects, one for each thread, which are taken in any order.
TEST(FoundPairs, DivisionIntoBlocksAndTheirOrderDoNotMatter) {
  constexpr std::size_t kCount = 500;
  std::mt19937_64 bits(11);
  for (int run = 0; run < 200; ++run) {
    const std::vector<Pair> pairs = random_pairs(kCount, 1000 + static_cast<std::uint64_t>(run));
    const bool deepest_first = run % 2 != 0;
    const std::size_t most = run % 5 == 0 ? kAll : bits() % 40;
    FoundPairs<3> all(most, deepest_first);
    std::vector<FoundPairs<3>> threads(1 + bits() % 4, all);
    for (std::size_t from = 0; from < kCount;) {
      const std::size_t to = std::min(kCount, from + 1 + bits() % 90);
      FoundPairs<3>& thread = threads[bits() % threads.size()];
      add_all(thread, std::span(pairs).subspan(from, to - from));
      if (bits() % 3 != 0) all.take(thread);
      from = to;
    }
    for (FoundPairs<3>& thread : threads) all.take(thread);
    SCOPED_TRACE(testing::Message() << "run " << run << ", at most " << most << (deepest_first ? " by depth" : ""));
    EXPECT_EQ(all.count(), kCount);
    EXPECT_EQ(all.depth(), first_of(pairs, 1, true)[0].depth);
    expect_same(all.first_pairs(), first_of(pairs, most, deepest_first));
  }
}

TEST(FoundPairs, AnObjectWhosePairsWereTakenIsEmptyAndKeepsAllPairsAgain) {
  FoundPairs<3> all(2, true), thread(2, true);
  for (Index i = 0; i < 9; ++i) thread.add(pair_of(i, i + 1, 4.0));
  all.take(thread);
  EXPECT_EQ(thread.count(), 0u);
  EXPECT_EQ(thread.depth(), 0.0);
  all.take(thread);  // adds nothing
  EXPECT_EQ(all.count(), 9u);
  EXPECT_EQ(all.depth(), 4.0);
  for (Index i = 0; i < 9; ++i) thread.add(pair_of(i, i + 2, 1.0));  // after those that were taken
  EXPECT_EQ(thread.count(), 9u);
  EXPECT_EQ(thread.depth(), 1.0);
  expect_same(thread.first_pairs(), {pair_of(0, 2, 1.0), pair_of(1, 3, 1.0)});
  expect_same(all.first_pairs(), {pair_of(0, 1, 4.0), pair_of(1, 2, 4.0)});
}

// The threads add neighbouring simplices, whose bits are in one word, at the same time.
TEST(SimplexSet, ContainsTheSimplicesThatWereAddedByAnyNumberOfThreads) {
  constexpr std::size_t kSimplices = 4'000'003;
  const auto is_added = [](std::size_t s) { return s % 3 != 0; };
  for (const std::size_t threads : {1u, 2u, 5u}) {
    SimplexSet set(kSimplices);
    EXPECT_EQ(set.size(), 0u);
    std::latch start(static_cast<std::ptrdiff_t>(threads));
    {
      std::vector<std::jthread> running;
      for (std::size_t t = 0; t < threads; ++t)
        running.emplace_back([&, t] {
          start.arrive_and_wait();
          for (std::size_t s = 0; s < kSimplices; ++s)  // some by one thread, some by all
            if (is_added(s) && (s % threads == t || s % 4 == 0)) set.add(static_cast<Index>(s));
        });
    }
    std::uint64_t expected = 0, wrong = 0;
    for (std::size_t s = 0; s < kSimplices; ++s) {
      wrong += set.contains(static_cast<Index>(s)) != is_added(s) ? 1 : 0;
      expected += is_added(s) ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0u) << threads;
    EXPECT_EQ(set.size(), expected) << threads;
  }
}

}  // namespace
}  // namespace tegl::test
