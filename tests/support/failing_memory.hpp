// SPDX-License-Identifier: BSD-3-Clause
//
// Out-of-memory on demand: replaces the program's operators new and delete and (on Linux) mmap, from which the library
// takes large blocks. Include it in one source of a program only.
//
// Counts blocks that are not released, so leaks are found without a sanitizer too.
#pragma once

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <mutex>
#include <new>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "tegl/error.hpp"

#ifdef __linux__
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace tegl::test {

/// State of the replaced functions. Global, as they take no other argument.
struct MemoryState {
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  std::atomic<std::int64_t> asked = 0;  ///< number of allocations while armed
  std::atomic<std::int64_t> first_failure = kNever;
  std::atomic<bool> once = true;
  std::atomic<bool> armed = false;
  std::atomic<std::int64_t> failures = 0;
  std::atomic<std::int64_t> blocks = 0;        ///< from operator new, not released
  std::atomic<std::int64_t> mapped_bytes = 0;  ///< of large blocks, not released

  bool fails_now() noexcept {
    if (!armed) return false;
    const std::int64_t number = asked.fetch_add(1);
    if (once ? number != first_failure : number < first_failure) return false;
    ++failures;
    return true;
  }
};
inline MemoryState memory;

/// During its lifetime, the allocation of the given number fails, and all after it unless `once`.
class RunOut {
 public:
  RunOut(std::int64_t first_failure, bool once) {
    memory.asked = 0;
    memory.failures = 0;
    memory.first_failure = first_failure;
    memory.once = once;
    memory.armed = true;
  }
  ~RunOut() { memory.armed = false; }
  RunOut(const RunOut&) = delete;
  RunOut& operator=(const RunOut&) = delete;
};

inline void* allocate(std::size_t bytes, std::size_t alignment) noexcept {
  if (memory.fails_now()) return nullptr;
  if (bytes == 0) bytes = 1;
  void* const block = alignment <= alignof(std::max_align_t)
                          ? std::malloc(bytes)
                          : std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (block != nullptr) ++memory.blocks;
  return block;
}
inline void* allocate_or_throw(std::size_t bytes, std::size_t alignment) {
  void* const block = allocate(bytes, alignment);
  if (block == nullptr) throw std::bad_alloc();
  return block;
}
inline void release(void* block) noexcept {
  if (block != nullptr) --memory.blocks;
  std::free(block);
}

#ifdef __linux__
/// Address ranges reserved with MAP_NORESERVE, which the library uses for large blocks.
class LargeBlocks {
 public:
  void add(void* block, std::size_t bytes) noexcept {
    const std::lock_guard lock(mutex_);
    for (Range& range : ranges_)
      if (range.bytes == 0) {
        range = {static_cast<char*>(block), bytes};
        memory.mapped_bytes += static_cast<std::int64_t>(bytes);
        return;
      }
  }
  void remove(void* block, std::size_t bytes) noexcept {
    const std::lock_guard lock(mutex_);
    auto* const begin = static_cast<char*>(block);
    for (Range& range : ranges_) {
      if (range.bytes == 0 || begin < range.begin || begin >= range.begin + range.bytes) continue;
      memory.mapped_bytes -= static_cast<std::int64_t>(bytes);
      if (begin == range.begin) range.begin += bytes;  // only the ends of a range are unmapped
      range.bytes -= bytes;
      return;
    }
  }

 private:
  struct Range {
    char* begin;
    std::size_t bytes;
  };
  std::mutex mutex_;
  std::array<Range, 256> ranges_{};
};
inline LargeBlocks large_blocks;
#endif

/// Runs `work` repeatedly with a different failing allocation each time, until none fails. Expects bad_alloc, an Error
/// about memory, or the usual result, and no leak. Returns the number of the last allocation tried.
inline std::int64_t expect_survives(
    const std::string& name, const std::function<std::uint64_t()>& work, bool counts_blocks,
    const std::function<void()>& expect_nothing_left = [] {}) {
  const std::uint64_t expected = work();  // also creates what the library keeps
  std::int64_t allocations = 0;
  for (const bool once : {true, false}) {
    bool done = false;
    for (std::int64_t failing = 0; !done; failing += 1 + failing / 30) {  // later ones are sampled
      const std::int64_t blocks = memory.blocks;
      const std::int64_t mapped = memory.mapped_bytes;
      std::optional<std::uint64_t> result;
      bool out_of_memory = false;
      std::int64_t failures = 0;
      try {
        const RunOut run_out(failing, once);
        result = work();
      } catch (const std::bad_alloc&) {
        out_of_memory = true;
      } catch (const Error& error) {
        out_of_memory = std::string(error.what()).find("memory") != std::string::npos;
        EXPECT_TRUE(out_of_memory) << error.what();
      }
      failures = memory.failures;
      done = failures == 0;
      allocations = std::max(allocations, failing);
      EXPECT_NE(result.has_value(), out_of_memory);
      EXPECT_EQ(result.value_or(expected), expected) << name << ": another result without allocation " << failing;
      EXPECT_EQ(memory.mapped_bytes, mapped) << name << ": a large block is lost without allocation " << failing;
      EXPECT_TRUE(memory.blocks == blocks || !counts_blocks)
          << name << ": " << memory.blocks - blocks << " blocks are lost without allocation " << failing;
      if (out_of_memory) expect_nothing_left();
      if (testing::Test::HasFailure()) return allocations;
    }
  }
  return allocations;
}

}  // namespace tegl::test

// NOLINTBEGIN: all forms are replaced, so that a block is allocated and released by matching functions.
void* operator new(std::size_t n) { return tegl::test::allocate_or_throw(n, 1); }
void* operator new[](std::size_t n) { return tegl::test::allocate_or_throw(n, 1); }
void* operator new(std::size_t n, std::align_val_t a) {
  return tegl::test::allocate_or_throw(n, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t n, std::align_val_t a) {
  return tegl::test::allocate_or_throw(n, static_cast<std::size_t>(a));
}
void* operator new(std::size_t n, const std::nothrow_t&) noexcept { return tegl::test::allocate(n, 1); }
void* operator new[](std::size_t n, const std::nothrow_t&) noexcept { return tegl::test::allocate(n, 1); }
void* operator new(std::size_t n, std::align_val_t a, const std::nothrow_t&) noexcept {
  return tegl::test::allocate(n, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t n, std::align_val_t a, const std::nothrow_t&) noexcept {
  return tegl::test::allocate(n, static_cast<std::size_t>(a));
}
void operator delete(void* p) noexcept { tegl::test::release(p); }
void operator delete[](void* p) noexcept { tegl::test::release(p); }
void operator delete(void* p, std::size_t) noexcept { tegl::test::release(p); }
void operator delete[](void* p, std::size_t) noexcept { tegl::test::release(p); }
void operator delete(void* p, std::align_val_t) noexcept { tegl::test::release(p); }
void operator delete[](void* p, std::align_val_t) noexcept { tegl::test::release(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { tegl::test::release(p); }
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept { tegl::test::release(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { tegl::test::release(p); }
void operator delete[](void* p, const std::nothrow_t&) noexcept { tegl::test::release(p); }
void operator delete(void* p, std::align_val_t, const std::nothrow_t&) noexcept { tegl::test::release(p); }
void operator delete[](void* p, std::align_val_t, const std::nothrow_t&) noexcept { tegl::test::release(p); }

#ifdef __linux__
extern "C" void* mmap(void* at, std::size_t bytes, int protection, int flags, int file, off_t offset) noexcept {
  const bool large_block = (flags & MAP_NORESERVE) != 0 && (flags & MAP_ANONYMOUS) != 0;
  if (large_block && tegl::test::memory.fails_now()) {
    errno = ENOMEM;
    return MAP_FAILED;
  }
  void* const block = reinterpret_cast<void*>(syscall(SYS_mmap, at, bytes, protection, flags, file, offset));
  if (large_block && block != MAP_FAILED) tegl::test::large_blocks.add(block, bytes);
  return block;
}
extern "C" int munmap(void* block, std::size_t bytes) noexcept {
  tegl::test::large_blocks.remove(block, bytes);
  return static_cast<int>(syscall(SYS_munmap, block, bytes));
}
#endif
// NOLINTEND
