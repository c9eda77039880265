// SPDX-License-Identifier: BSD-3-Clause
//
// Loops in blocks that do not depend on the number of threads, so that what is summed up by blocks does not either.
#pragma once

#include <algorithm>
#include <cstddef>

#include "loop_progress.hpp"
#include "workers.hpp"

namespace tegl::detail {

/// How many blocks of `size` there are in `count`; the last one may be smaller.
constexpr std::size_t block_count(std::size_t count, std::size_t size) noexcept { return (count + size - 1) / size; }

/// Calls work(block, from, to, scratch) for all blocks of 0 … count - 1, side by side on `threads` threads (0: all that
/// the machine has), each with its own scratch, made by `make_scratch`. `progress` is told by the caller's thread,
/// after each block that it has done itself.
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

/// Without scratch: work(block, from, to).
template <class Work>
void for_each_block(std::size_t count, std::size_t size, unsigned threads, const Progress& progress, const Work& work) {
  struct Nothing {};
  for_each_block(
      count, size, threads, progress, [] { return Nothing{}; },
      [&](std::size_t block, std::size_t from, std::size_t to, Nothing&) { work(block, from, to); });
}

}  // namespace tegl::detail
