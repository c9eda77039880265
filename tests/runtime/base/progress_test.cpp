// SPDX-License-Identifier: BSD-3-Clause
//
// Progress is reported for every slab, on the calling thread, with non-decreasing fractions. Cancelling ends the
// extraction at any time, for every entry point and number of threads.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include "base/task_aside.hpp"
#include "fields.hpp"
#include "tegl/extract.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/project.hpp"
#include "tegl/slice.hpp"
#include "tegl/stream.hpp"

namespace tegl::test {
namespace {

template <int N>
struct NoSink final : ContourSink<N, float> {
  using typename ContourSink<N, float>::Vertex;
  using typename ContourSink<N, float>::Simplex;
  void add_vertices(std::span<const Vertex> /*vertices*/) override {}
  void add_simplices(std::span<const Simplex> /*simplices*/) override {}
  void replace_corner(std::uint64_t /*simplex*/, int /*corner*/, std::uint64_t /*vertex*/) override {}
};

/// A way to make a contour, with its number of slabs.
struct Way {
  std::string name;
  std::size_t slabs;
  std::function<void(const ExtractOptions&)> make;
};

template <int N>
std::vector<Way> ways(const OwnedImage<float, N>& image) {
  const std::size_t slabs = image.grid.axes[N - 1].size() - 1;
  std::vector<Way> result;
  result.push_back(
      {"extract", slabs, [&](const ExtractOptions& options) { extract<float>(image.view(), 0.5, options); }});
  result.push_back({"count", slabs, [&](const ExtractOptions& options) { count(image.view(), 0.5, options); }});
  result.push_back({"extract_into", slabs, [&](const ExtractOptions& options) {
                      ExtractOptions silent = options;
                      silent.work.progress = {};
                      const ContourSize size = count(image.view(), 0.5, silent);
                      std::vector<std::array<float, N>> vertices(size.vertices);
                      std::vector<std::array<Index, N>> simplices(size.simplices);
                      extract_into(image.view(), 0.5, ContourRoom<N, float>{vertices, simplices}, options);
                    }});
  result.push_back({"extract_streamed", slabs, [&](const ExtractOptions& options) {
                      std::size_t layer = 1;
                      for (int a = 0; a < N - 1; ++a) layer *= image.grid.axes[a].size();
                      FunctionLayers<float, N> layers(image.grid, [&](std::size_t k, float* to) {
                        std::copy_n(image.values.data() + k * layer, layer, to);
                      });
                      NoSink<N> sink;
                      extract_streamed<float>(layers, 0.5, sink, options);
                    }});
  if constexpr (N > 2)
    result.push_back({"slice_image", 2, [&](const ExtractOptions& options) {
                        slice_image(image.view(), 0.5, Hyperplane<N>::across(N - 1, 2.0), options);
                      }});
  return result;
}

/// The fractions that a way reports.
std::vector<double> told(const Way& way, ExtractOptions options) {
  std::vector<double> fractions;
  const auto caller = std::this_thread::get_id();
  options.work.progress = [&](double fraction) {
    EXPECT_EQ(std::this_thread::get_id(), caller);
    fractions.push_back(fraction);
    return true;
  };
  way.make(options);
  return fractions;
}

template <int N>
void expect_told_of_every_slab(const std::array<std::size_t, N>& sizes) {
  const auto image = noise<float, N>(sizes, 1);
  for (const Way& way : ways(image))
    for (const unsigned threads : {1u, 4u}) {
      SCOPED_TRACE(testing::Message() << way.name << ", " << threads << " threads");
      ExtractOptions options;
      options.work.threads = threads;
      const std::vector<double> fractions = told(way, options);
      EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
      EXPECT_GE(fractions.front(), 0.0);
      EXPECT_EQ(fractions.back(), 1.0);
      EXPECT_GE(fractions.size(), way.slabs);
    }
}

TEST(Progress, IsToldOfEverySlabByTheThreadThatAsked) {
  expect_told_of_every_slab<2>({300, 40});
  expect_told_of_every_slab<3>({70, 30, 25});
  expect_told_of_every_slab<4>({12, 9, 8, 11});
}

/// A slab of a million samples or more also reports progress before it is finished.
TEST(Progress, IsToldWithinLargeSlabs) {
  const auto image = noise_with_missing<float, 3>(Grid<3>::unit({1500, 1500, 2}), 3, 0.0);
  ExtractOptions options;
  options.work.threads = 1;
  const std::vector<double> fractions = told(ways(image)[0], options);
  const auto within = std::count_if(fractions.begin(), fractions.end(), [](double f) { return f > 0.0 && f < 1.0; });
  EXPECT_GE(within, 6);
}

template <int N>
void expect_stopped_whenever(const std::array<std::size_t, N>& sizes) {
  const auto image = noise<float, N>(sizes, 5);
  for (const Way& way : ways(image))
    for (const unsigned threads : {1u, 3u}) {
      SCOPED_TRACE(testing::Message() << way.name << ", " << threads << " threads");
      ExtractOptions options;
      options.work.threads = threads;
      // With several threads the number of calls varies.
      const std::size_t calls = threads == 1 ? told(way, options).size() : way.slabs;
      for (std::size_t last = 1; last <= calls; last += 1 + calls / 40) {
        std::size_t seen = 0;
        options.work.progress = [&](double) { return ++seen < last; };
        try {
          way.make(options);
          ADD_FAILURE() << "not cancelled by call " << last << " of " << calls;
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::Cancelled) << error.what();
        }
        EXPECT_EQ(seen, last) << "nobody asks again";
      }
    }
}

TEST(Progress, StopsTheWorkAtAnyCall) {
  expect_stopped_whenever<2>({200, 30});
  expect_stopped_whenever<3>({40, 30, 12});
  expect_stopped_whenever<4>({9, 8, 7, 6});
}

TEST(Progress, WhatItThrowsReachesTheCaller) {
  const auto image = noise<float, 3>(40, 7);
  for (const unsigned threads : {1u, 4u})
    for (const Way& way : ways(image)) {
      ExtractOptions options;
      options.work.threads = threads;
      int seen = 0;
      options.work.progress = [&](double) -> bool {
        if (++seen < 3) return true;
        throw std::pair(seen, 'x');
      };
      using Thrown = std::pair<int, char>;
      EXPECT_THROW(way.make(options), Thrown) << way.name;
      EXPECT_EQ(seen, 3);
    }
}

#ifndef __SANITIZE_THREAD__  // it does not see the synchronisation of TBB, which is not built for it

/// Work for several threads, for which the calling thread waits.
void wait_for_others() {
  std::atomic<std::uint64_t> sum = 0;
  tbb::parallel_for(0, 8, [&](int i) {
    std::uint64_t own = 1;
    for (int k = 0; k < 20000; ++k) own = own * 6364136223846793005u + static_cast<std::uint64_t>(i);
    sum += own;
  });
}

/// While a caller's function waits, its thread may execute other tasks, but none that calls the function again.
TEST(Progress, IsNotAskedForWhileItWaitsForTasksOfItsOwn) {
  const auto image = noise<float, 3>({60, 50, 40}, 11);
  for (const Way& way : ways(image)) {
    int depth = 0, deepest = 0;
    ExtractOptions options;
    options.work.threads = 4;
    options.work.progress = [&](double) {
      deepest = std::max(deepest, ++depth);
      wait_for_others();
      --depth;
      return true;
    };
    way.make(options);
    EXPECT_EQ(deepest, 1) << way.name;
  }
}

TEST(Progress, NorAreEstimators) {
  const auto image = noise<float, 3>({40, 12, 12}, 13);
  for (const Way& way : ways(image)) {
    std::atomic<int> deepest = 0;
    ExtractOptions options;
    options.work.threads = 4;
    options.ambiguity = Ambiguity::custom;
    options.estimator.choose = [&](const AmbiguousFace&) {
      static thread_local int depth = 0;
      if (++depth > deepest) deepest = depth;
      tbb::parallel_for(0, 4, [](int) {});
      --depth;
      return tile::Choice::high;
    };
    way.make(options);
    EXPECT_EQ(deepest, 1) << way.name;
  }
}

#endif

/// Operations on contours and facets that run on one thread: progress begins at 0, ascends to 1 and can cancel at each
/// call.
void expect_progress(const std::function<void(const WorkOptions&)>& operation) {
  std::vector<double> fractions;
  operation({.progress = [&](double fraction) {
    fractions.push_back(fraction);
    return true;
  }});
  ASSERT_GE(fractions.size(), 4u);
  EXPECT_EQ(fractions.front(), 0.0);
  EXPECT_EQ(fractions.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  for (std::size_t last = 1; last <= fractions.size(); ++last) {
    std::size_t seen = 0;
    try {
      operation({.progress = [&](double) { return ++seen < last; }});
      ADD_FAILURE() << "not cancelled by call " << last;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::Cancelled) << error.what();
    }
    EXPECT_EQ(seen, last);
  }
}

TEST(Progress, OfOperationsOnOneThread) {
  const auto image = noise<float, 4>(6, 3);
  const auto contour = extract<float>(image.view(), 0.5);
  expect_progress([&](const WorkOptions& work) { slice(contour, Hyperplane<4>::across(3, 2.5), work); });
  expect_progress([&](const WorkOptions& work) { project(contour, {}, work); });
  auto facets = extract_facets<float>(image.view(), 0.5);
  expect_progress([&](const WorkOptions& work) { facets.connect_up(work); });
  expect_progress([&](const WorkOptions& work) { check(facets, work); });
}

TEST(TaskAside, RunsOnceOnAnotherThreadOrWhereItIsFinished) {
  for (const bool begun : {false, true}) {
    std::atomic<int> runs = 0;
    detail::TaskAside task([&] { ++runs; });
    if (begun) task.begin();
    task.finish();
    EXPECT_EQ(runs, 1);
    task.finish();
    EXPECT_EQ(runs, 1);
  }
}

TEST(TaskAside, ThrowsWhatTheTaskThrows) {
  for (const bool begun : {false, true}) {
    detail::TaskAside task([] { throw Error(ErrorCode::Cancelled, "of the task"); });
    if (begun) task.begin();
    EXPECT_THROW(task.finish(), Error);
    EXPECT_THROW(task.finish(), Error);
  }
}

/// Tasks that nobody waits for: none runs after the end of its object.
TEST(TaskAside, DoesNotOutliveItsObject) {
  for (int trial = 0; trial < 200; ++trial) {
    auto alive = std::make_unique<std::atomic<bool>>(true);
    std::atomic<int> late = 0;
    {
      detail::TaskAside task([&, flag = alive.get()] { late += !flag->load(); });
      if (trial % 4 != 0) task.begin();
      if (trial % 2 != 0) std::this_thread::yield();
    }
    alive->store(false);
    EXPECT_EQ(late, 0);
  }
}

}  // namespace
}  // namespace tegl::test
