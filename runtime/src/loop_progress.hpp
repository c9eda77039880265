// SPDX-License-Identifier: BSD-3-Clause
//
// How far a loop is that several threads work on.
#pragma once

#include <atomic>
#include <cstddef>
#include <thread>

#include "call_apart.hpp"
#include "progress.hpp"

namespace tegl::detail {

/// Counts what the threads have done; the one that made this tells `progress` of it, whenever it is done with a part.
class LoopProgress {
 public:
  /// `progress` may hold nothing, and must outlive this.
  LoopProgress(const Progress& progress, std::size_t count) : progress_(progress), count_(count) { tell_of(0); }

  /// By any thread: so many more items are done. On the thread that made this, tells so; throws Cancelled.
  void add(std::size_t items) {
    if (!progress_) return;
    const std::size_t done = done_.fetch_add(items, std::memory_order_relaxed) + items;
    if (std::this_thread::get_id() == caller_ && done < count_) tell_of(done);
  }
  /// By the thread that made this, when all is done: tells 1.
  void finish() { tell_of(count_); }
  /// Whether threads may as well leave the rest of their work.
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

}  // namespace tegl::detail
