// SPDX-License-Identifier: BSD-3-Clause
//
// Implements ChildMemory. Each block is a memory file: freed blocks return to the system, and others are passed to the
// parent as descriptors. The kernel limits private memory.
#include "process/child_memory.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace tegl::io_detail {

namespace {

/// Numbers of /proc/self/statm, in pages: all mapped memory, and private writable memory.
struct MappedPages {
  std::uint64_t all = 0;
  std::uint64_t data = 0;
};

MappedPages mapped_pages() {
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return {};
  std::array<char, 256> text{};
  const ssize_t size = read(file, text.data(), text.size() - 1);
  close(file);
  if (size <= 0) return {};
  MappedPages pages;
  char* at = text.data();
  for (int i = 0; i < 6; ++i) {
    const std::uint64_t value = std::strtoull(at, &at, 10);
    if (i == 0) pages.all = value;
    if (i == 5) pages.data = value;
  }
  return pages;
}

std::uint64_t page_bytes() { return static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)); }

std::uint64_t soft_limit(__rlimit_resource resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return std::numeric_limits<std::uint64_t>::max();
  return limit.rlim_cur;
}

}  // namespace

int create_memory_file(std::size_t bytes, void*& begin) noexcept {
  const int file = memfd_create("tegl", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  if (file < 0) return -1;
  if (ftruncate(file, static_cast<off_t>(bytes)) == 0 && fcntl(file, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) == 0) {
    begin = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (begin != MAP_FAILED) {
      madvise(begin, bytes, MADV_HUGEPAGE);  // if the system supports huge pages for memory files
      return file;
    }
  }
  const int reason = errno;
  close(file);
  errno = reason;
  return -1;
}

ChildMemory::ChildMemory(std::uint64_t bytes) : at_start_(mapped_pages().data * page_bytes()), allowed_(bytes) {
  blocks_.reserve(64);
  set_limit();
}

void ChildMemory::allow(std::uint64_t bytes) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 60;
  allowed_ = std::min(kMost, allowed_ + std::min(kMost, bytes));
  set_limit();
}

/// Sets only the soft limit, so that it can be raised again.
void ChildMemory::set_limit() {
  rlimit limit{};
  if (at_start_ == 0 || getrlimit(RLIMIT_DATA, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, at_start_ + allowed_);
  setrlimit(RLIMIT_DATA, &limit);
}

bool ChildMemory::is_limiting() const {
  const auto machine = static_cast<std::uint64_t>(std::max(0L, sysconf(_SC_PHYS_PAGES))) * page_bytes();
  if (at_start_ == 0 || allowed_ > machine) return false;
  const MappedPages now = mapped_pages();
  const auto left = [](std::uint64_t limit, std::uint64_t used) { return limit - std::min(limit, used); };
  const std::uint64_t own = left(at_start_ + allowed_, now.data * page_bytes());
  return own <= left(soft_limit(RLIMIT_AS), now.all * page_bytes());
}

void* ChildMemory::allocate(std::size_t bytes) noexcept {
  const auto kept = std::find_if(blocks_.begin(), blocks_.end(),
                                 [&](const Block& block) { return !block.used && block.bytes == bytes; });
  if (kept != blocks_.end()) {
    kept->used = true;
    return kept->begin;
  }
  if (in_blocks_ + bytes > allowed_) free_unused(0);
  // Without a block the caller allocates private memory, which the kernel's limit refuses.
  if (in_blocks_ + bytes > allowed_) return nullptr;
  void* begin = nullptr;
  const int file = create_memory_file(bytes, begin);
  if (file < 0) return nullptr;
  try {
    blocks_.push_back({begin, bytes, file, true});
  } catch (...) {
    munmap(begin, bytes);
    close(file);
    return nullptr;
  }
  in_blocks_ += bytes;
  return begin;
}

bool ChildMemory::release(void* block, std::size_t) noexcept {
  const auto found =
      std::find_if(blocks_.begin(), blocks_.end(), [&](const Block& known) { return known.begin == block; });
  if (found == blocks_.end()) return false;
  found->used = false;
  constexpr std::size_t kMostKept = 2;
  free_unused(kMostKept);
  return true;
}

/// Returns unused blocks to the system, oldest first, until `most` are left.
void ChildMemory::free_unused(std::size_t most) noexcept {
  auto unused = static_cast<std::size_t>(
      std::count_if(blocks_.begin(), blocks_.end(), [](const Block& block) { return !block.used; }));
  for (auto at = blocks_.begin(); unused > most && at != blocks_.end();) {
    if (at->used) {
      ++at;
      continue;
    }
    munmap(at->begin, at->bytes);
    close(at->descriptor);
    in_blocks_ -= at->bytes;
    at = blocks_.erase(at);
    --unused;
  }
}

int ChildMemory::descriptor(const void* block) const noexcept {
  const auto found =
      std::find_if(blocks_.begin(), blocks_.end(), [&](const Block& known) { return known.begin == block; });
  return found == blocks_.end() ? -1 : found->descriptor;
}

}  // namespace tegl::io_detail
