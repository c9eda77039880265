// SPDX-License-Identifier: BSD-3-Clause
//
// Loops over many small equal items: side by side, while the thread that asked tells its progress.
#pragma once

#include <algorithm>
#include <cstddef>

#include "loop_progress.hpp"
#include "workers.hpp"

namespace tegl::detail {

/// Calls work(i) for 0 ... count - 1, on `threads` threads (0: all that the machine has). Throws Cancelled where
/// `progress` says stop. `work` must not throw.
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
