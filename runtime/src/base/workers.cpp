// SPDX-License-Identifier: BSD-3-Clause
//
// Parallel loops with TBB: the part that does not depend on the work.
#include "base/workers.hpp"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/cache_aligned_allocator.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include "base/plain_threads.hpp"

#ifdef TEGL_PLAIN_THREADS
#include <exception>
#endif

namespace tegl::detail {

void isolate(FunctionRef<void()> call) {
#ifdef TEGL_PLAIN_THREADS
  call();
#else
  tbb::this_task_arena::isolate(call);
#endif
}

struct LoopThreads::Threads {
  Threads(unsigned threads, MakeOwn make_own)
      : arena(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(std::min(threads, most()))),
        own(std::move(make_own)) {}

  /// Limits the thread count to the machine's: TBB does not use more, and prints a warning, which a library should not.
  static unsigned most() { return static_cast<unsigned>(std::max(1, tbb::info::default_concurrency())); }

  tbb::task_arena arena;
  tbb::affinity_partitioner affinity;  ///< a thread gets the same parts as last time, which are in its caches
#ifdef TEGL_PLAIN_THREADS
  /// The thread sanitizer does not see that memory of TBB's allocator passes from one thread to another.
  using Allocator = std::allocator<std::shared_ptr<void>>;
#else
  using Allocator = tbb::cache_aligned_allocator<std::shared_ptr<void>>;
#endif
  tbb::enumerable_thread_specific<std::shared_ptr<void>, Allocator> own;
};

LoopThreads::LoopThreads(unsigned threads, MakeOwn make_own)
    : threads_(std::make_unique<Threads>(threads, std::move(make_own))),
      is_one_(threads == 1 || (threads == 0 && threads_->arena.max_concurrency() == 1)) {}

LoopThreads::~LoopThreads() = default;

std::size_t LoopThreads::count() const noexcept { return static_cast<std::size_t>(threads_->arena.max_concurrency()); }

void* LoopThreads::own() { return threads_->own.local().get(); }

void LoopThreads::run(std::size_t count, std::size_t grain, Part work) {
#ifdef TEGL_PLAIN_THREADS
  // The first exception stops all threads.
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> errors(this->count());
  const auto take_parts = [&](std::size_t thread) {
    try {
      for (std::size_t from; (from = next.fetch_add(grain)) < count;) work(from, std::min(count, from + grain), own());
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
  threads_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const tbb::blocked_range<std::size_t>& part) { work(part.begin(), part.end(), own()); },
        threads_->affinity);
  });
#endif
}

void LoopProgress::add(std::size_t items) {
  if (!progress_) return;
  const std::size_t done = done_.fetch_add(items, std::memory_order_relaxed) + items;
  if (std::this_thread::get_id() == caller_ && done < count_) tell_of(done);
}

void LoopProgress::tell_of(std::size_t done) {
  if (!progress_) return;
  try {
    call_apart(
        [&] { tell(progress_, done == count_ ? 1.0 : static_cast<double>(done) / static_cast<double>(count_)); });
  } catch (...) {
    stopped_.store(true, std::memory_order_relaxed);
    throw;
  }
}

namespace {

/// Runs a loop: alone if there is one thread or one part.
void run_loop(LoopThreads& threads, std::size_t count, std::size_t grain, LoopThreads::Part work) {
  if (count == 0) return;
  if (threads.is_one() || count <= grain) return work(0, count, threads.own());
  threads.run(count, grain, work);
}

/// Objects of threads that need none.
std::shared_ptr<void> make_nothing() { return nullptr; }

}  // namespace

void run_blocks(std::size_t count, std::size_t size, LoopThreads& threads, const Progress& progress,
                FunctionRef<void(std::size_t block, std::size_t from, std::size_t to, void* own)> work) {
  const std::size_t blocks = block_count(count, size);
  LoopProgress done(progress, blocks);
  run_loop(threads, blocks, 1, [&](std::size_t from, std::size_t to, void* own) {
    for (std::size_t b = from; b < to && !done.stopped(); ++b) {
      work(b, b * size, std::min(count, (b + 1) * size), own);
      done.add(1);
    }
  });
  done.finish();
}

void for_each_block(std::size_t count, std::size_t size, unsigned threads, const Progress& progress,
                    FunctionRef<void(std::size_t block, std::size_t from, std::size_t to)> work) {
  LoopThreads workers(threads, make_nothing);
  run_blocks(count, size, workers, progress,
             [&](std::size_t block, std::size_t from, std::size_t to, void*) { work(block, from, to); });
}

void for_each_part(std::size_t count, unsigned threads, const Progress& progress,
                   FunctionRef<void(std::size_t from, std::size_t to)> work) {
  constexpr std::size_t kGrain = std::size_t{1} << 12;
  LoopThreads workers(threads, make_nothing);
  LoopProgress done(progress, count);
  run_loop(workers, count, kGrain, [&](std::size_t from, std::size_t to, void*) {
    for (std::size_t first = from; first < to && !done.stopped(); first += kGrain) {
      const std::size_t end = std::min(to, first + kGrain);
      work(first, end);
      done.add(end - first);
    }
  });
  done.finish();
}

}  // namespace tegl::detail
