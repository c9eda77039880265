// SPDX-License-Identifier: BSD-3-Clause
//
// Progress of an extraction: updated by all threads, reported by the calling thread.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <thread>

#include <fmt/format.h>

#include "base/workers.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Reports progress by non-decreasing fractions. All functions except `add` and `stopped` must be called by the thread
/// that constructed the reporter.
class ProgressReporter {
 public:
  /// `progress` may be empty and must outlive the reporter. `unit`: noun for the slabs in messages.
  ProgressReporter(const Progress& progress, std::size_t slabs, const char* unit = "slabs")
      : progress_(progress), slabs_(slabs), unit_(unit), caller_(std::this_thread::get_id()) {}

  /// Begins a batch of slabs, whose work consists of `passes` passes.
  void begin_batch(std::size_t first, std::size_t end, unsigned passes) noexcept {
    first_ = static_cast<double>(first);
    share_ = static_cast<double>(end - first) / passes;
    pass_ = -1;
    items_ = 0;
  }
  /// Begins the next pass, over `items` items.
  void begin_pass(std::size_t items) noexcept {
    ++pass_;
    items_ = items;
    done_.store(0, std::memory_order_relaxed);
  }

  /// Adds finished items of the current pass; any thread. On the constructing thread also reports; then throws
  /// Cancelled if requested.
  void add(std::size_t items) {
    if (!progress_) return;
    const std::size_t done = done_.fetch_add(items, std::memory_order_relaxed) + items;
    if (std::this_thread::get_id() != caller_) return;
    tell(first_ + share_ * (pass_ + std::min(1.0, static_cast<double>(done) / static_cast<double>(items_))));
  }
  /// Reports that `slabs` slabs are finished. Throws Cancelled if requested.
  void tell(double slabs) {
    if (!progress_) return;
    last_ = std::max(last_, std::min(1.0, slabs / static_cast<double>(slabs_)));
    bool goes_on = false;
    try {
      goes_on = call_apart([&] { return progress_(last_); });
    } catch (...) {
      stopped_.store(true, std::memory_order_relaxed);
      throw;
    }
    if (goes_on) return;
    stopped_.store(true, std::memory_order_relaxed);
    throw Error(ErrorCode::Cancelled, fmt::format("extraction cancelled after {:.0f} of {} {}",
                                                  std::floor(last_ * static_cast<double>(slabs_)), slabs_, unit_));
  }
  /// Whether threads should skip the rest of their work.
  [[nodiscard]] bool stopped() const noexcept { return stopped_.load(std::memory_order_relaxed); }

 private:
  const Progress& progress_;
  std::size_t slabs_;
  const char* unit_;
  std::thread::id caller_;
  double first_ = 0.0, share_ = 0.0, last_ = 0.0;
  int pass_ = 0;
  std::size_t items_ = 0;
  std::atomic<std::size_t> done_ = 0;
  std::atomic<bool> stopped_ = false;
};

}  // namespace tegl::detail
