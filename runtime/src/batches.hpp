// SPDX-License-Identifier: BSD-3-Clause
//
// Loops over many small equal items: side by side, in batches between which the thread that asked tells its progress.
#pragma once

#include <algorithm>
#include <cstddef>

#include "tegl/error.hpp"
#include "workers.hpp"

namespace tegl::detail {

/// Calls work(i) for 0 ... count - 1, on `threads` threads (0: all that the machine has). Throws Cancelled where
/// `progress` says stop. `work` must not throw.
template <class Work>
void for_each_item(std::size_t count, unsigned threads, const Progress& progress, const Work& work) {
  constexpr std::size_t kBatch = std::size_t{1} << 20;
  constexpr std::size_t kGrain = std::size_t{1} << 12;
  struct Nothing {};
  Workers<Nothing> workers(threads, [] { return Nothing{}; });
  const auto tell = [&](std::size_t done) {
    const double fraction = count == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(count);
    if (progress && !progress(fraction)) throw Error(ErrorCode::Cancelled, "cancelled by the progress callback");
  };
  for (std::size_t first = 0; first < count; first += kBatch) {
    tell(first);
    workers.for_range(std::min(kBatch, count - first), kGrain, [&](std::size_t from, std::size_t to, Nothing&) {
      for (std::size_t i = from; i < to; ++i) work(first + i);
    });
  }
  tell(count);
}

}  // namespace tegl::detail
