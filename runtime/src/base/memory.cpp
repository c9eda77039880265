// SPDX-License-Identifier: BSD-3-Clause
//
// Memory for outputs. Fresh memory costs a page fault per page at the first access. With pages of 2 MiB instead of 4
// KiB this is seven times faster, and several threads can access different parts concurrently.
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <memory>
#include <mutex>
#include <new>
#include <utility>

#include "base/block_source.hpp"
#include "base/kept_pages.hpp"
#include "tegl/memory.hpp"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace tegl::detail {

namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;

std::size_t rounded(std::size_t bytes) { return (bytes + kHugePage - 1) / kHugePage * kHugePage; }

/// Per thread: a child process that reads a file has one thread, and a thread that receives a block from it allocates
/// nothing else meanwhile.
thread_local BlockSource* block_source = nullptr;

/// Stored before the samples of a large block.
struct ValuesHeader {
  void* block;        ///< from the block source, or null
  std::size_t bytes;  ///< size of the block
  void* heap;         ///< from operator new; null if from the block source
};
static_assert(sizeof(ValuesHeader) <= kValuesOffset);

/// Asks for huge pages for a block from the heap that is certainly a mapping of its own: such pages are never returned
/// to other users of the heap.
void prefer_huge_pages(void* begin, std::size_t bytes) noexcept {
#ifdef __linux__
  constexpr std::size_t kOwnMapping = std::size_t{1} << 25;  // the largest threshold of glibc's allocator
  if (bytes <= kOwnMapping) return;
  const std::size_t before = (kHugePage - reinterpret_cast<std::uintptr_t>(begin) % kHugePage) % kHugePage;
  // Whole pages only: the memory after them may never be used.
  madvise(static_cast<unsigned char*>(begin) + before, (bytes - before) / kHugePage * kHugePage, MADV_HUGEPAGE);
#else
  static_cast<void>(begin);
  static_cast<void>(bytes);
#endif
}

#ifdef __linux__

/// See KeptPages. Blocks of this process, in multiples of 2 MiB; rarely, arrays of the reading process, whose pages are
/// copied when they are written.
class PagePool {
 public:
  void open(std::size_t most) {
    const std::lock_guard lock(mutex_);
    most_ = std::max(most_, most);
    users_.fetch_add(1, std::memory_order_relaxed);
  }
  void close() {
    const std::lock_guard lock(mutex_);
    if (users_.fetch_sub(1, std::memory_order_relaxed) > 1) return;
    free_all();
    most_ = 0;
  }
  /// Frees the blocks; returns whether there were any.
  bool release() noexcept {
    if (!is_open()) return false;
    const std::lock_guard lock(mutex_);
    const bool had_any = count_ > 0;
    free_all();
    return had_any;
  }

  /// Keeps a block; returns false if it does not.
  bool keep(void* block, std::size_t bytes) noexcept {
    if (!is_open()) return false;
    const std::lock_guard lock(mutex_);
    if (!is_open() || count_ == blocks_.size() || kept_ + bytes > most_) return false;
    blocks_[count_++] = {static_cast<unsigned char*>(block), bytes};
    kept_ += bytes;
    return true;
  }

  /// Replaces the first pages of a fresh block by those that are kept, one by one: a block may consist of parts that
  /// the system moves only by themselves. In ascending order, so that the system can join them. Returns false if a part
  /// of the block has no memory.
  [[nodiscard]] bool move_to(unsigned char* block, std::size_t bytes) noexcept {
    if (!is_open()) return true;
    const std::lock_guard lock(mutex_);
    for (std::size_t moved = 0; moved < bytes && count_ > 0; moved += kHugePage) {
      Block& from = blocks_[count_ - 1];
      unsigned char* const page = from.begin;
      from.begin += kHugePage;
      from.bytes -= kHugePage;
      kept_ -= kHugePage;
      if (from.bytes == 0) --count_;
      if (mremap(page, kHugePage, kHugePage, MREMAP_MAYMOVE | MREMAP_FIXED, block + moved) != MAP_FAILED) continue;
      munmap(page, kHugePage);
      return has_fresh_page(block + moved);
    }
    return true;
  }

 private:
  struct Block {
    unsigned char* begin;
    std::size_t bytes;
  };
  [[nodiscard]] bool is_open() const { return users_.load(std::memory_order_relaxed) != 0; }
  void free_all() noexcept {
    while (count_ > 0) {
      --count_;
      munmap(blocks_[count_].begin, blocks_[count_].bytes);
    }
    kept_ = 0;
  }
  /// After a page could not be moved there: the system may have removed the fresh page first.
  [[nodiscard]] static bool has_fresh_page(unsigned char* page) noexcept {
    constexpr int kFresh = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED_NOREPLACE;
    if (mmap(page, kHugePage, PROT_READ | PROT_WRITE, kFresh, -1, 0) == MAP_FAILED) return errno == EEXIST;
    madvise(page, kHugePage, MADV_HUGEPAGE);
    return true;
  }

  std::mutex mutex_;
  std::atomic<unsigned> users_ = 0;
  std::array<Block, 64> blocks_{};
  std::size_t count_ = 0;
  std::size_t kept_ = 0;  ///< bytes in the blocks
  std::size_t most_ = 0;
};
constinit PagePool page_pool;

#endif

void free_block(void* block, std::size_t bytes) noexcept {
  if (block_source != nullptr && block_source->release(block, bytes)) return;
#ifdef __linux__
  munmap(block, bytes);
#endif
}

}  // namespace

BlockSource* exchange_block_source(BlockSource* source) noexcept { return std::exchange(block_source, source); }

std::size_t block_of_values(std::size_t bytes) noexcept {
  constexpr std::size_t kPage = 4096;
  return (bytes + kValuesOffset + kPage - 1) / kPage * kPage;
}

std::size_t block_of_buffer(std::size_t bytes) noexcept { return rounded(bytes); }

void* allocate_values(std::size_t bytes) {
  if (bytes < kLargeValues) return ::operator new(bytes);
  ValuesHeader header{nullptr, block_of_values(bytes), nullptr};
  if (block_source != nullptr) header.block = block_source->allocate(header.bytes);
  void* begin = header.block;
  if (begin == nullptr) {
    // Aligned manually: glibc's aligned allocation does not reuse the gap left by a block of the same size (until
    // 2.38), so that repeatedly allocated blocks, such as the layers of a stream, would be placed one after the other.
    std::size_t space = bytes + 2 * kValuesOffset;
    begin = header.heap = ::operator new(space);
    begin = std::align(kValuesOffset, bytes + kValuesOffset, begin, space);
    prefer_huge_pages(begin, bytes + kValuesOffset);
  }
  ::new (begin) ValuesHeader(header);
  return static_cast<unsigned char*>(begin) + kValuesOffset;
}

void free_values(void* block, std::size_t bytes) noexcept {
  if (bytes < kLargeValues) return ::operator delete(block);
  unsigned char* const begin = static_cast<unsigned char*>(block) - kValuesOffset;
  const ValuesHeader header = *reinterpret_cast<const ValuesHeader*>(begin);
  if (header.block != nullptr)
    free_block(header.block, header.bytes);
  else
    ::operator delete(header.heap);
}

#ifdef __linux__

void* allocate_large_block(std::size_t bytes) {
  if (bytes > SIZE_MAX - 2 * kHugePage) throw std::bad_alloc();
  if (block_source != nullptr)
    if (void* const block = block_source->allocate(rounded(bytes))) return block;
  // One page more than needed, so that an aligned block can be cut out.
  const std::size_t size = rounded(bytes) + kHugePage;
  const auto map = [&] {
    return mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  };
  void* mapped = map();
  if (mapped == MAP_FAILED && block_source == nullptr && page_pool.release()) mapped = map();
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  auto* const begin = static_cast<unsigned char*>(mapped);
  const std::size_t before = (kHugePage - reinterpret_cast<std::uintptr_t>(begin) % kHugePage) % kHugePage;
  if (before != 0) munmap(begin, before);
  if (before != kHugePage) munmap(begin + before + rounded(bytes), kHugePage - before);
  madvise(begin + before, rounded(bytes), MADV_HUGEPAGE);  // without huge pages, small ones are used
  if (block_source == nullptr && !page_pool.move_to(begin + before, rounded(bytes))) {
    munmap(begin + before, rounded(bytes));
    throw std::bad_alloc();
  }
  return begin + before;
}

void free_large_block(void* block, std::size_t bytes) noexcept {
  if (block_source == nullptr && page_pool.keep(block, rounded(bytes))) return;
  free_block(block, rounded(bytes));
}

KeptPages::KeptPages(std::size_t most) { page_pool.open(most); }
KeptPages::~KeptPages() { page_pool.close(); }

#else

/// At least the alignment of any element, as pages have it: elements may be aligned for registers or cache lines.
constexpr std::align_val_t kLargeAlignment{4096};

void* allocate_large_block(std::size_t bytes) { return ::operator new(bytes, kLargeAlignment); }
void free_large_block(void* block, std::size_t) noexcept { ::operator delete(block, kLargeAlignment); }

KeptPages::KeptPages(std::size_t) {}
KeptPages::~KeptPages() = default;

#endif

}  // namespace tegl::detail
