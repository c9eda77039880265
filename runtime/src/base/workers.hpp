// SPDX-License-Identifier: BSD-3-Clause
//
// Parallel loops over ranges, with working storage per thread and progress reports.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include "base/progress.hpp"

// The thread sanitizer does not see the synchronisation of the installed TBB, which is not built for it. With the
// sanitizer, plain threads do the same work in the same parts.
#ifdef __SANITIZE_THREAD__
#define TEGL_PLAIN_THREADS
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define TEGL_PLAIN_THREADS
#endif
#endif
#ifdef TEGL_PLAIN_THREADS
#include <exception>
#endif

namespace tegl::detail {

/// Calls a user function from within parallel work. If the function waits for tasks of its own, the thread does not
/// take up other parts of the work meanwhile: these would call the function again before it returns, while the thread's
/// scratch is in use.
template <class Call>
auto call_apart(const Call& call) {
#ifdef TEGL_PLAIN_THREADS
  return call();
#else
  return tbb::this_task_arena::isolate(call);
#endif
}

/// Threads for parallel loops. `Scratch`: working storage of a thread, kept between parts of the work.
template <class Scratch>
class Workers {
 public:
  /// `threads`: 0 for all of the machine. `make_scratch()` is called once per thread.
  template <class MakeScratch>
  Workers(unsigned threads, const MakeScratch& make_scratch)
      : arena_(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(std::min(threads, most()))),
        alone_(threads == 1 || (threads == 0 && arena_.max_concurrency() == 1)),
        own_(make_scratch) {}

  [[nodiscard]] std::size_t count() const noexcept { return static_cast<std::size_t>(arena_.max_concurrency()); }

  /// Calls work(from, to, scratch) concurrently for disjoint parts that cover 0 ... count - 1, each of at least `grain`
  /// items (except the last), with the thread's own scratch.
  template <class Work>
  void for_range(std::size_t count, std::size_t grain, const Work& work) {
    if (count == 0) return;
    if (alone_ || count <= grain) return work(std::size_t{0}, count, own_.local());
#ifdef TEGL_PLAIN_THREADS
    // The first exception stops all threads.
    std::atomic<std::size_t> next = 0;
    std::vector<std::exception_ptr> errors(this->count());
    const auto take_parts = [&](std::size_t thread) {
      try {
        for (std::size_t from; (from = next.fetch_add(grain)) < count;)
          work(from, std::min(count, from + grain), own_.local());
      } catch (...) {
        errors[thread] = std::current_exception();
        next = count;
      }
    };
    std::vector<std::thread> others(this->count() - 1);
    for (std::size_t i = 0; i < others.size(); ++i) others[i] = std::thread(take_parts, i + 1);
    take_parts(0);
    for (std::thread& other : others) other.join();
    for (const std::exception_ptr& error : errors)
      if (error) std::rethrow_exception(error);
#else
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, count, grain),
          [&](const tbb::blocked_range<std::size_t>& part) { work(part.begin(), part.end(), own_.local()); },
          affinity_);
    });
#endif
  }

 private:
  /// Limits the thread count to the machine's: TBB does not use more, and prints a warning, which a library should not.
  static unsigned most() { return static_cast<unsigned>(std::max(1, tbb::info::default_concurrency())); }

  tbb::task_arena arena_;
  bool alone_;
  tbb::affinity_partitioner affinity_;  ///< a thread gets the same parts as last time, which are in its caches
  tbb::enumerable_thread_specific<Scratch> own_;
};

/// Counts the work of all threads. The thread that constructed it reports progress whenever it finishes a part.
class LoopProgress {
 public:
  /// `progress` may be empty, and must outlive this object.
  LoopProgress(const Progress& progress, std::size_t count) : progress_(progress), count_(count) { tell_of(0); }

  /// Adds finished items; any thread. On the constructing thread also reports; then throws Cancelled if requested.
  void add(std::size_t items) {
    if (!progress_) return;
    const std::size_t done = done_.fetch_add(items, std::memory_order_relaxed) + items;
    if (std::this_thread::get_id() == caller_ && done < count_) tell_of(done);
  }
  /// Reports 1. Call on the constructing thread after all work is done.
  void finish() { tell_of(count_); }
  /// Whether threads should skip the rest of their work.
  [[nodiscard]] bool stopped() const noexcept { return stopped_.load(std::memory_order_relaxed); }

 private:
  void tell_of(std::size_t done) {
    if (!progress_) return;
    try {
      call_apart(
          [&] { tell(progress_, done == count_ ? 1.0 : static_cast<double>(done) / static_cast<double>(count_)); });
    } catch (...) {
      stopped_.store(true, std::memory_order_relaxed);
      throw;
    }
  }

  const Progress& progress_;
  std::size_t count_;
  std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<std::size_t> done_ = 0;
  std::atomic<bool> stopped_ = false;
};

/// Number of blocks of `size` in `count`; the last may be smaller.
constexpr std::size_t block_count(std::size_t count, std::size_t size) noexcept { return (count + size - 1) / size; }

/// Calls work(block, from, to, scratch) for all blocks of 0 … count - 1, in parallel on `threads` threads (0: all of
/// the machine), each with its own scratch from `make_scratch`. The calling thread reports progress after each block
/// that it has processed.
template <class MakeScratch, class Work>
void for_each_block(std::size_t count, std::size_t size, unsigned threads, const Progress& progress,
                    const MakeScratch& make_scratch, const Work& work) {
  using Scratch = decltype(make_scratch());
  Workers<Scratch> workers(threads, make_scratch);
  const std::size_t blocks = block_count(count, size);
  LoopProgress done(progress, blocks);
  workers.for_range(blocks, 1, [&](std::size_t from, std::size_t to, Scratch& scratch) {
    for (std::size_t b = from; b < to && !done.stopped(); ++b) {
      work(b, b * size, std::min(count, (b + 1) * size), scratch);
      done.add(1);
    }
  });
  done.finish();
}

/// Version without scratch: work(block, from, to).
template <class Work>
void for_each_block(std::size_t count, std::size_t size, unsigned threads, const Progress& progress, const Work& work) {
  struct Nothing {};
  for_each_block(
      count, size, threads, progress, [] { return Nothing{}; },
      [&](std::size_t block, std::size_t from, std::size_t to, Nothing&) { work(block, from, to); });
}

/// Calls work(i) for 0 ... count - 1 in parallel on `threads` threads (0: all of the machine). Throws Cancelled if
/// `progress` returns false. `work` must not throw.
template <class Work>
void for_each_item(std::size_t count, unsigned threads, const Progress& progress, const Work& work) {
  constexpr std::size_t kGrain = std::size_t{1} << 12;
  struct Nothing {};
  Workers<Nothing> workers(threads, [] { return Nothing{}; });
  LoopProgress done(progress, count);
  workers.for_range(count, kGrain, [&](std::size_t from, std::size_t to, Nothing&) {
    for (std::size_t first = from; first < to && !done.stopped(); first += kGrain) {
      const std::size_t end = std::min(to, first + kGrain);
      for (std::size_t i = first; i < end; ++i) work(i);
      done.add(end - first);
    }
  });
  done.finish();
}

}  // namespace tegl::detail
