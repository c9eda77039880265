// SPDX-License-Identifier: BSD-3-Clause
//
// Threads: loops over ranges, and what each thread keeps between them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

// The thread sanitizer does not see how the installed TBB, which is not built for it, orders things: there, plain
// threads do the same work in the same parts.
#ifdef __SANITIZE_THREAD__
#define TEGL_PLAIN_THREADS
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define TEGL_PLAIN_THREADS
#endif
#endif
#ifdef TEGL_PLAIN_THREADS
#include <atomic>
#include <exception>
#include <thread>
#endif

namespace tegl::detail {

/// `Scratch`: what a thread keeps between parts of the work.
template <class Scratch>
class Workers {
 public:
  /// `threads`: 0 for all that the machine has. `make_scratch()` is called once for each.
  template <class MakeScratch>
  Workers(unsigned threads, const MakeScratch& make_scratch)
      : arena_(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(std::min(threads, most()))),
        alone_(threads == 1 || (threads == 0 && arena_.max_concurrency() == 1)),
        own_(make_scratch) {}

  [[nodiscard]] std::size_t count() const noexcept { return static_cast<std::size_t>(arena_.max_concurrency()); }

  /// Calls work(from, to, scratch) for parts of 0 ... count - 1 that make up the whole, of at least `grain` (but the
  /// last), with the thread's own scratch.
  template <class Work>
  void for_range(std::size_t count, std::size_t grain, const Work& work) {
    if (count == 0) return;
    if (alone_ || count <= grain) return work(std::size_t{0}, count, own_.local());
#ifdef TEGL_PLAIN_THREADS
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
  /// More than the machine has are as many: TBB has room for no others, and says so where libraries are silent.
  static unsigned most() { return static_cast<unsigned>(std::max(1, tbb::info::default_concurrency())); }

  tbb::task_arena arena_;
  bool alone_;
  tbb::affinity_partitioner affinity_;  ///< a thread gets the parts that it got the last time: they are in its caches
  tbb::enumerable_thread_specific<Scratch> own_;
};

}  // namespace tegl::detail
