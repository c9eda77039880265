// SPDX-License-Identifier: BSD-3-Clause
//
// The queue of edges by buckets: against a sorted list, on random keys.
#include "simplify/edge_buckets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <set>
#include <vector>

namespace tegl::detail {
namespace {

using Entry = EdgeBuckets::Entry;

TEST(EdgeBuckets, GivesKeysInOrderUpToASixteenth) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> exponent(-30.0, 30.0);
    EdgeBuckets queue;
    std::vector<double> keys;
    for (Index i = 0; i < 1000; ++i) {
      keys.push_back(i % 10 == 0 ? 0.0 : std::exp(exponent(random)));
      queue.push(keys[i], {i, i + 1, 0});
    }
    const auto all = [](const Entry&) { return true; };
    std::set<Index> found;
    double largest = 0.0;
    while (const Entry* entry = queue.next(all)) {
      EXPECT_TRUE(found.insert(entry->a).second);
      EXPECT_GE((1.0 + 1.0 / 16.0) * keys[entry->a], largest);
      largest = std::max(largest, keys[entry->a]);
    }
    EXPECT_EQ(found.size(), keys.size());
  }
}

TEST(EdgeBuckets, OrdersSimilarKeysByVertex) {
  EdgeBuckets queue;
  for (const Index a : {7u, 3u, 5u}) queue.push(1.0 + 0.005 * a, {a, 9, 0});
  const auto all = [](const Entry&) { return true; };
  for (const Index a : {3u, 5u, 7u}) EXPECT_EQ(queue.next(all)->a, a);
  EXPECT_EQ(queue.next(all), nullptr);
}

TEST(EdgeBuckets, GivesSmallerKeysPushedLaterNext) {
  EdgeBuckets queue;
  const auto all = [](const Entry&) { return true; };
  queue.push(4.0, {1, 2, 0});
  queue.push(64.0, {3, 4, 0});
  EXPECT_EQ(queue.next(all)->a, 1u);
  queue.push(1.0, {5, 6, 0});
  EXPECT_EQ(queue.next(all)->a, 5u);
  EXPECT_EQ(queue.next(all)->a, 3u);
  EXPECT_EQ(queue.next(all), nullptr);
  // again from the start
  queue.push(2.0, {7, 8, 0});
  EXPECT_EQ(queue.next(all)->a, 7u);
}

TEST(EdgeBuckets, GivesKeysThatAreNoNumbersLast) {
  EdgeBuckets queue;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::array<double, 7> keys = {nan, 3.0, -nan, std::numeric_limits<double>::infinity(), 0.0, -0.0, -1.0};
  for (Index a = 0; a < keys.size(); ++a) queue.push(keys[a], {a, a + 1, 0});
  std::vector<Index> order;
  while (const Entry* const entry = queue.next([](const Entry&) { return true; })) order.push_back(entry->a);
  ASSERT_EQ(order.size(), keys.size());
  EXPECT_EQ(std::vector<Index>(order.begin(), order.begin() + 4), (std::vector<Index>{4, 5, 1, 3}));
}

TEST(EdgeBuckets, CallsForLateEntriesWhenTheLoadedOnesAreTaken) {
  EdgeBuckets queue;
  const auto all = [](const Entry&) { return true; };
  std::vector<double> late = {64.0, 1.0, 32.0};
  const auto push_late = [&] {
    if (late.empty()) return;
    queue.push(late.back(), {static_cast<Index>(10 + late.size()), 20, 0});
    late.pop_back();
  };
  queue.push(4.0, {1, 2, 0});
  queue.push(4.0, {2, 3, 0});
  std::vector<Index> order;
  while (const Entry* const entry = queue.next(all, push_late)) order.push_back(entry->a);
  EXPECT_EQ(order, (std::vector<Index>{1, 2, 12, 13, 11}));
}

TEST(EdgeBuckets, RequestsEachEntryOnceAheadOfItsTurn) {
  EdgeBuckets queue;
  const auto all = [](const Entry&) { return true; };
  for (Index a = 0; a < 20; ++a) queue.push(a < 9 ? 1.0 : 8.0, {a, 20, 0});
  std::array<std::vector<Index>, 2> requested;
  for (Index turn = 0; const Entry* const entry = queue.next(all); ++turn) {
    EXPECT_EQ(entry->a, turn);
    queue.request_ahead<2>({5, 2}, [&](std::size_t step, const Entry& later) { requested[step].push_back(later.a); });
    const Index loaded = turn < 9 ? 9 : 20;
    EXPECT_EQ(requested[0].size(), std::min<std::size_t>(turn + 6, loaded));
    EXPECT_EQ(requested[1].size(), std::min<std::size_t>(turn + 3, loaded));
  }
  for (const auto& step : requested)
    for (Index a = 0; a < 20; ++a) EXPECT_EQ(step[a], a);
}

TEST(EdgeBuckets, SkipsOutdatedEntries) {
  EdgeBuckets queue;
  for (Index a = 0; a < 10; ++a) queue.push(1.0, {a, a + 1, a % 2});
  const auto is_current = [](const Entry& entry) { return entry.stamp == 1; };
  for (const Index a : {1u, 3u, 5u, 7u, 9u}) EXPECT_EQ(queue.next(is_current)->a, a);
  EXPECT_EQ(queue.next(is_current), nullptr);
}

}  // namespace
}  // namespace tegl::detail
