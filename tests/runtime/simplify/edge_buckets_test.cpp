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
#include <span>
#include <vector>

namespace tegl::detail {
namespace {

using Entry = EdgeBuckets::Entry;

/// Loads the entries list by list, and takes each list entry by entry.
class Taker {
 public:
  explicit Taker(EdgeBuckets& queue) : queue_(queue) {}
  /// The next entry; null if there is none.
  template <class IsCurrent>
  const Entry* next(const IsCurrent& is_current) {
    if (position_ == loaded_.size()) {
      loaded_ = queue_.load(is_current);
      position_ = 0;
    }
    return loaded_.empty() ? nullptr : &loaded_[position_++];
  }
  const Entry* next() {
    return next([](const Entry&) { return true; });
  }

 private:
  EdgeBuckets& queue_;
  std::span<const Entry> loaded_;
  std::size_t position_ = 0;
};

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
    Taker taker(queue);
    std::set<Index> found;
    double largest = 0.0;
    while (const Entry* entry = taker.next()) {
      EXPECT_TRUE(found.insert(entry->a).second);
      EXPECT_GE((1.0 + 1.0 / 16.0) * keys[entry->a], largest);
      largest = std::max(largest, keys[entry->a]);
    }
    EXPECT_EQ(found.size(), keys.size());
  }
}

TEST(EdgeBuckets, LoadsSimilarKeysSortedByVertex) {
  EdgeBuckets queue;
  for (const Index a : {7u, 3u, 5u}) queue.push(1.0 + 0.005 * a, {a, 9, 0});
  const auto all = [](const Entry&) { return true; };
  std::vector<Index> order;
  for (const Entry& entry : queue.load(all)) order.push_back(entry.a);
  EXPECT_EQ(order, (std::vector<Index>{3, 5, 7}));
  EXPECT_TRUE(queue.load(all).empty());
}

TEST(EdgeBuckets, GivesSmallerKeysPushedLaterNext) {
  EdgeBuckets queue;
  Taker taker(queue);
  queue.push(4.0, {1, 2, 0});
  queue.push(64.0, {3, 4, 0});
  EXPECT_EQ(taker.next()->a, 1u);
  queue.push(1.0, {5, 6, 0});
  EXPECT_EQ(taker.next()->a, 5u);
  EXPECT_EQ(taker.next()->a, 3u);
  EXPECT_EQ(taker.next(), nullptr);
  // again from the start
  queue.push(2.0, {7, 8, 0});
  EXPECT_EQ(taker.next()->a, 7u);
}

TEST(EdgeBuckets, KeepsLoadedEntriesWhileOthersArePushed) {
  EdgeBuckets queue;
  const auto all = [](const Entry&) { return true; };
  for (Index a = 0; a < 3; ++a) queue.push(4.0, {a, 9, 0});
  const std::span<const Entry> loaded = queue.load(all);
  for (Index a = 3; a < 1000; ++a) queue.push(a % 2 == 0 ? 4.0 : 8.0, {a, 9, 0});
  ASSERT_EQ(loaded.size(), 3u);
  for (Index a = 0; a < 3; ++a) EXPECT_EQ(loaded[a].a, a);
  for (const Entry& entry : queue.load(all)) EXPECT_EQ(entry.a % 2, 0u);  // those of the same bucket
  EXPECT_EQ(queue.load(all).size(), 499u);
}

TEST(EdgeBuckets, GivesKeysThatAreNoNumbersLast) {
  EdgeBuckets queue;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::array<double, 7> keys = {nan, 3.0, -nan, std::numeric_limits<double>::infinity(), 0.0, -0.0, -1.0};
  for (Index a = 0; a < keys.size(); ++a) queue.push(keys[a], {a, a + 1, 0});
  Taker taker(queue);
  std::vector<Index> order;
  while (const Entry* const entry = taker.next()) order.push_back(entry->a);
  ASSERT_EQ(order.size(), keys.size());
  EXPECT_EQ(std::vector<Index>(order.begin(), order.begin() + 4), (std::vector<Index>{4, 5, 1, 3}));
}

TEST(EdgesAhead, RequestsEachEntryOnceAheadOfItsTurn) {
  std::vector<Entry> entries;
  for (Index a = 0; a < 20; ++a) entries.push_back({a, 20, 0});
  std::array<std::vector<Index>, 2> requested;
  EdgesAhead<2> ahead(entries, {5, 2});
  for (Index turn = 0; turn < entries.size(); ++turn) {
    if (turn == 7) continue;  // not used
    ahead.request(turn, [&](std::size_t step, const Entry& later) { requested[step].push_back(later.a); });
    EXPECT_EQ(requested[0].size(), std::min<std::size_t>(turn + 6, 20));
    EXPECT_EQ(requested[1].size(), std::min<std::size_t>(turn + 3, 20));
  }
  for (const auto& step : requested)
    for (Index a = 0; a < 20; ++a) EXPECT_EQ(step[a], a);
}

TEST(EdgeBuckets, OmitsOutdatedEntries) {
  EdgeBuckets queue;
  for (Index a = 0; a < 10; ++a) queue.push(a < 8 ? 1.0 : 3.0, {a, a + 1, a % 2});
  for (Index a = 10; a < 20; a += 2) queue.push(2.0, {a, a + 1, 0});
  const auto is_current = [](const Entry& entry) { return entry.stamp == 1; };
  Taker taker(queue);
  for (const Index a : {1u, 3u, 5u, 7u, 9u}) EXPECT_EQ(taker.next(is_current)->a, a);
  EXPECT_EQ(taker.next(is_current), nullptr);
}

}  // namespace
}  // namespace tegl::detail
