// SPDX-License-Identifier: BSD-3-Clause
//
// Work on all processors, in units of whole numbers.
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

/// Calls `work(state, unit)` for units 0 ... count - 1, `chunk` of them at a time by one thread, each thread with a
/// state of its own from `make_state()`; at the end `finish(state)`, one at a time. `threads`: 0 = one per processor.
/// Of what `work` throws, that of the smallest unit is rethrown: chunks are taken in ascending order, and those that
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
    } catch (const std::system_error&) {  // no more threads to be had: those that there are do the work
    }
    run();
  }
  if (!failures.empty()) std::rethrow_exception(failures.begin()->second);
}

}  // namespace tegl::gen
