// SPDX-License-Identifier: BSD-3-Clause
//
// Pages of freed blocks come again in other blocks, and never in two at a time.
#include "base/kept_pages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include "tegl/memory.hpp"
// Sanitizers use memory of their own for each page.
#if defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TEGL_TEST_FAULTS
#include <sys/resource.h>
#endif

namespace tegl::detail {
namespace {

class Block {
 public:
  Block(std::size_t bytes, std::uint64_t value)
      : bytes_(bytes), value_(value), begin_(static_cast<std::uint64_t*>(allocate_large_block(bytes))) {
    std::fill(begin_, begin_ + count(), value);
  }
  ~Block() { free_large_block(begin_, bytes_); }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;

  [[nodiscard]] bool is_intact() const {
    return std::all_of(begin_, begin_ + count(), [&](std::uint64_t x) { return x == value_; });
  }

 private:
  [[nodiscard]] std::size_t count() const { return bytes_ / sizeof(std::uint64_t); }
  std::size_t bytes_;
  std::uint64_t value_;
  std::uint64_t* begin_;
};

/// Allocates and frees blocks of random sizes, more and less than what is kept.
void use_blocks(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::unique_ptr<Block>> blocks;
  for (std::uint64_t step = 0; step < 60; ++step) {
    if (blocks.size() > 4 || (random() % 3 == 0 && !blocks.empty())) {
      std::swap(blocks[random() % blocks.size()], blocks.back());
      ASSERT_TRUE(blocks.back()->is_intact());
      blocks.pop_back();
      continue;
    }
    const std::size_t bytes = kLargeBlock + random() % (4 * kLargeBlock);
    blocks.push_back(std::make_unique<Block>(bytes, std::uint64_t{seed} << 32 | step));
  }
  for (const auto& block : blocks) ASSERT_TRUE(block->is_intact());
}

TEST(KeptPages, AreInOneBlockAtATime) {
  const KeptPages pages(std::size_t{1} << 25);
  use_blocks(1);
  std::vector<std::thread> threads;
  for (unsigned seed = 2; seed < 5; ++seed)
    threads.emplace_back([seed] {
      const KeptPages more(std::size_t{1} << 23);
      use_blocks(seed);
    });
  for (std::thread& thread : threads) thread.join();
  use_blocks(5);
}

#ifdef TEGL_TEST_FAULTS
/// Page faults of this thread for the first use of a block.
std::ptrdiff_t faults_of(std::size_t bytes) {
  const auto faults = [] {
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    return usage.ru_minflt;
  };
  const auto before = faults();
  const Block block(bytes, 7);
  return static_cast<std::ptrdiff_t>(faults() - before);
}

TEST(KeptPages, NeedNoFurtherFirstUse) {
  constexpr std::size_t kBytes = std::size_t{1} << 26;
  const KeptPages pages(2 * kBytes);
  const std::ptrdiff_t first = faults_of(kBytes);
  EXPECT_GE(first, 16);
  EXPECT_LT(faults_of(kBytes), first / 4);
  EXPECT_LT(faults_of(kBytes / 2), first / 4);
  EXPECT_LT(faults_of(kBytes), first / 4);  // whether or not its pages were in two blocks
}

TEST(KeptPages, AreFreedWithTheLastObject) {
  constexpr std::size_t kBytes = std::size_t{1} << 26;
  std::ptrdiff_t first = 0;
  {
    const KeptPages pages(2 * kBytes);
    {
      const KeptPages others(kBytes);
      first = faults_of(kBytes);
    }
    EXPECT_LT(faults_of(kBytes), first / 4);
  }
  EXPECT_GE(2 * faults_of(kBytes), first);
}

TEST(KeptPages, AreNoMoreThanRequested) {
  constexpr std::size_t kBytes = std::size_t{1} << 26;
  const KeptPages pages(kBytes / 2);
  const std::ptrdiff_t first = faults_of(kBytes);
  EXPECT_GE(2 * faults_of(kBytes), first);
}
#endif

}  // namespace
}  // namespace tegl::detail
