// SPDX-License-Identifier: BSD-3-Clause
//
// Memory bandwidth: one part of the memory per thread.
#include "bandwidth.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <thread>
#include <vector>

namespace tegl::bench {
namespace {

constexpr int kRepetitions = 6;
constexpr std::size_t kHugePage = std::size_t{2} << 20U;

struct Unmap {
  std::size_t bytes;
  void operator()(std::uint64_t* p) const { munmap(p, bytes); }
};
using Mapping = std::unique_ptr<std::uint64_t, Unmap>;

/// Untouched memory of at least `bytes`, plus one huge page so that it can start at a huge page's border.
Mapping map(std::size_t bytes, bool huge) {
  bytes += kHugePage;
  void* p = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (p == MAP_FAILED) throw std::bad_alloc();
  madvise(p, bytes, huge ? MADV_HUGEPAGE : MADV_NOHUGEPAGE);
  return Mapping(static_cast<std::uint64_t*>(p), Unmap{bytes});
}

/// Wall time in seconds of work(i) for i = 0 to threads - 1, each in a thread of its own.
template <class Work>
double time_of(int threads, const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<std::thread> pool;
  for (int i = 1; i < threads; ++i) pool.emplace_back([&work, i] { work(i); });
  work(0);
  for (std::thread& thread : pool) thread.join();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The sum of words in eight chains, so that additions do not wait for one another.
std::uint64_t sum(const std::uint64_t* words, std::size_t count) {
  std::uint64_t chains[8] = {};
  for (std::size_t i = 0; i + 8 <= count; i += 8)
    for (std::size_t c = 0; c < 8; ++c) chains[c] += words[i + c];
  std::uint64_t total = 0;
  for (const std::uint64_t chain : chains) total += chain;
  return total;
}

}  // namespace

double read_rate(std::size_t bytes, int threads) {
  const Mapping memory = map(bytes, true);
  std::memset(memory.get(), 1, bytes);
  const std::size_t part = bytes / 8 / static_cast<std::size_t>(threads);
  double best = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    std::vector<std::uint64_t> sums(static_cast<std::size_t>(threads));
    const double seconds = time_of(threads, [&](int i) {
      const auto at = static_cast<std::size_t>(i);
      sums[at] = sum(memory.get() + at * part, part);
    });
    asm volatile("" : : "g"(sums.data()) : "memory");
    best = std::max(best, static_cast<double>(bytes) / seconds);
  }
  return best;
}

double fresh_write_rate(std::size_t bytes, int threads, bool huge) {
  const std::size_t part = bytes / static_cast<std::size_t>(threads);
  double best = 0;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    const Mapping memory = map(bytes, huge);
    auto* first = reinterpret_cast<unsigned char*>(memory.get());
    const double seconds =
        time_of(threads, [&](int i) { std::memset(first + static_cast<std::size_t>(i) * part, 1, part); });
    best = std::max(best, static_cast<double>(bytes) / seconds);
  }
  return best;
}

}  // namespace tegl::bench
