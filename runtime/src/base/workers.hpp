// SPDX-License-Identifier: BSD-3-Clause
//
// Parallel loops over ranges, with working storage per thread and progress reports. The loops themselves are compiled
// once, in workers.cpp; templates here only call the work.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <thread>
#include <type_traits>

#include "base/function_ref.hpp"
#include "base/progress.hpp"

namespace tegl::detail {

/// Calls `call` on this thread, which takes up no other tasks if the call waits for tasks of its own.
void isolate(FunctionRef<void()> call);

/// Calls a user function from within parallel work. If the function waits for tasks of its own, the thread does not
/// take up other parts of the work meanwhile: these would call the function again before it returns, while the thread's
/// scratch is in use.
template <class Call>
auto call_apart(const Call& call) {
  if constexpr (std::is_void_v<decltype(call())>) {
    isolate(call);
  } else {
    std::optional<decltype(call())> result;
    isolate([&] { result.emplace(call()); });
    return *std::move(result);
  }
}

/// Threads for parallel loops, with an object for each thread.
class LoopThreads {
 public:
  using MakeOwn = std::function<std::shared_ptr<void>()>;
  using Part = FunctionRef<void(std::size_t from, std::size_t to, void* own)>;

  /// `threads`: 0 for all of the machine. `make_own()` is called once per thread.
  LoopThreads(unsigned threads, MakeOwn make_own);
  ~LoopThreads();

  [[nodiscard]] std::size_t count() const noexcept;
  /// Whether one thread does all work.
  [[nodiscard]] bool is_one() const noexcept { return is_one_; }
  /// The object of the calling thread.
  [[nodiscard]] void* own();
  /// Calls work(from, to, own()) concurrently for disjoint parts that cover 0 ... count - 1, each of at least `grain`
  /// items (except the last).
  void run(std::size_t count, std::size_t grain, Part work);

 private:
  struct Threads;
  std::unique_ptr<Threads> threads_;
  bool is_one_;
};

/// Threads for parallel loops. `Scratch`: working storage of a thread, kept between parts of the work.
template <class Scratch>
class Workers {
 public:
  /// `threads`: 0 for all of the machine. `make_scratch()` is called once per thread.
  template <class MakeScratch>
  Workers(unsigned threads, const MakeScratch& make_scratch)
      : threads_(threads, [make_scratch] { return std::shared_ptr<void>(new Own{make_scratch()}, &remove); }) {}

  [[nodiscard]] std::size_t count() const noexcept { return threads_.count(); }

  /// Calls work(from, to, scratch) concurrently for disjoint parts that cover 0 ... count - 1, each of at least `grain`
  /// items (except the last), with the thread's own scratch.
  template <class Work>
  void for_range(std::size_t count, std::size_t grain, const Work& work) {
    if (count == 0) return;
    if (threads_.is_one() || count <= grain) return work(std::size_t{0}, count, scratch_of(threads_.own()));
    threads_.run(count, grain,
                 [&work](std::size_t from, std::size_t to, void* own) { work(from, to, scratch_of(own)); });
  }

 private:
  /// Aligned, so that no cache line holds the scratch of two threads.
  struct alignas(64) Own {
    Scratch scratch;
  };
  static Scratch& scratch_of(void* own) { return static_cast<Own*>(own)->scratch; }
  static void remove(void* own) { delete static_cast<Own*>(own); }

  LoopThreads threads_;
};

/// Counts the work of all threads. The thread that constructed it reports progress whenever it finishes a part.
class LoopProgress {
 public:
  /// `progress` may be empty, and must outlive this object.
  LoopProgress(const Progress& progress, std::size_t count) : progress_(progress), count_(count) { tell_of(0); }

  /// Adds finished items; any thread. On the constructing thread also reports; then throws Cancelled if requested.
  void add(std::size_t items);
  /// Reports 1. Call on the constructing thread after all work is done.
  void finish() { tell_of(count_); }
  /// Whether threads should skip the rest of their work.
  [[nodiscard]] bool stopped() const noexcept { return stopped_.load(std::memory_order_relaxed); }

 private:
  void tell_of(std::size_t done);

  const Progress& progress_;
  std::size_t count_;
  std::thread::id caller_ = std::this_thread::get_id();
  std::atomic<std::size_t> done_ = 0;
  std::atomic<bool> stopped_ = false;
};

/// Number of blocks of `size` in `count`; the last may be smaller.
constexpr std::size_t block_count(std::size_t count, std::size_t size) noexcept { return (count + size - 1) / size; }

/// Calls work(block, from, to, own) for all blocks of 0 … count - 1, in parallel on these threads, each with its own
/// object. The calling thread reports progress after each block that it has processed.
void run_blocks(std::size_t count, std::size_t size, LoopThreads& threads, const Progress& progress,
                FunctionRef<void(std::size_t block, std::size_t from, std::size_t to, void* own)> work);

/// Calls work(block, from, to, scratch) for all blocks of 0 … count - 1, in parallel on `threads` threads (0: all of
/// the machine), each with its own scratch from `make_scratch`. The calling thread reports progress after each block
/// that it has processed.
template <class MakeScratch, class Work>
void for_each_block(std::size_t count, std::size_t size, unsigned threads, const Progress& progress,
                    const MakeScratch& make_scratch, const Work& work) {
  using Scratch = decltype(make_scratch());
  struct alignas(64) Own {
    Scratch scratch;
  };
  LoopThreads workers(threads, [&make_scratch] {
    return std::shared_ptr<void>(new Own{make_scratch()}, [](void* own) { delete static_cast<Own*>(own); });
  });
  run_blocks(count, size, workers, progress, [&work](std::size_t block, std::size_t from, std::size_t to, void* own) {
    work(block, from, to, static_cast<Own*>(own)->scratch);
  });
}

/// Version without scratch: work(block, from, to).
void for_each_block(std::size_t count, std::size_t size, unsigned threads, const Progress& progress,
                    FunctionRef<void(std::size_t block, std::size_t from, std::size_t to)> work);

/// Calls work(from, to) for disjoint parts that cover 0 ... count - 1, in parallel on `threads` threads (0: all of the
/// machine). Throws Cancelled if `progress` returns false. `work` must not throw.
void for_each_part(std::size_t count, unsigned threads, const Progress& progress,
                   FunctionRef<void(std::size_t from, std::size_t to)> work);

/// Calls work(i) for 0 ... count - 1 in parallel on `threads` threads (0: all of the machine). Throws Cancelled if
/// `progress` returns false. `work` must not throw.
template <class Work>
void for_each_item(std::size_t count, unsigned threads, const Progress& progress, const Work& work) {
  for_each_part(count, threads, progress, [&work](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) work(i);
  });
}

}  // namespace tegl::detail
