// SPDX-License-Identifier: BSD-3-Clause
//
// A parallel loop over whole numbers on all processors.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace tegl::gen {

/// Calls `work(state, unit)` for the units 0 to count - 1. A thread takes `chunk` units at a time and has its own state
/// from `make_state()`. At the end each thread calls `finish(state)`, one thread at a time. `threads`: 0 = one per
/// processor. If several calls of `work` throw, the exception of the smallest unit is rethrown: chunks are taken in
/// ascending order, and chunks already taken are finished.
/// were taken are worked off.
template <class MakeState, class Work, class Finish>
void in_parallel(std::uint64_t count, std::uint64_t chunk, unsigned threads, const MakeState& make_state,
                 const Work& work, const Finish& finish) {
  if (threads == 0) threads = std::max(1u, std::thread::hardware_concurrency());
  std::atomic<std::uint64_t> next{0};
  std::mutex guard;
  std::map<std::uint64_t, std::exception_ptr> failures;
  std::atomic<bool> failed{false};
  const auto run = [&] {
    std::uint64_t unit = 0;
    try {
      auto state = make_state();
      while (!failed) {
        const std::uint64_t first = next.fetch_add(chunk);
        if (first >= count) break;
        for (unit = first; unit < std::min(count, first + chunk); ++unit) work(state, unit);
      }
      const std::lock_guard lock(guard);
      finish(state);
    } catch (...) {
      failed = true;
      const std::lock_guard lock(guard);
      failures.emplace(unit, std::current_exception());
    }
  };
  {
    std::vector<std::jthread> pool;
    try {
      for (unsigned t = 1; t < threads && t * chunk < count; ++t) pool.emplace_back(run);
    } catch (const std::system_error&) {  // no further threads available: the existing ones do the work
    }
    run();
  }
  if (!failures.empty()) std::rethrow_exception(failures.begin()->second);
}

}  // namespace tegl::gen
