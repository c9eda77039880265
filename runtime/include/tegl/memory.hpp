// SPDX-License-Identifier: BSD-3-Clause
//
// Memory of large arrays: allocators that leave new elements uninitialised.
#pragma once

#include <cstddef>
#include <new>
#include <utility>

namespace tegl::detail {

/// Blocks of at least this many bytes (2 MiB) are allocated as huge pages, if the system has them.
inline constexpr std::size_t kLargeBlock = std::size_t{1} << 21;
/// Allocates memory without touching it: pages that are never written cost address space only. Throws std::bad_alloc.
void* allocate_large_block(std::size_t bytes);
void free_large_block(void* block, std::size_t bytes) noexcept;

/// Allocates memory for samples; blocks of 2 MiB or more are aligned to 64 bytes. Throws std::bad_alloc.
void* allocate_values(std::size_t bytes);
void free_values(void* block, std::size_t bytes) noexcept;

/// Memory of contours and of other results.
struct BufferMemory {
  static void* allocate(std::size_t bytes, std::align_val_t alignment) {
    return bytes < kLargeBlock ? ::operator new(bytes, alignment) : allocate_large_block(bytes);
  }
  static void free(void* block, std::size_t bytes, std::align_val_t alignment) noexcept {
    if (bytes < kLargeBlock)
      ::operator delete(block, alignment);
    else
      free_large_block(block, bytes);
  }
};

/// Memory of samples.
struct ValueMemory {
  static void* allocate(std::size_t bytes, std::align_val_t /*alignment*/) { return allocate_values(bytes); }
  static void free(void* block, std::size_t bytes, std::align_val_t /*alignment*/) noexcept {
    free_values(block, bytes);
  }
};

/// Leaves trivial elements uninitialised on resize, so outputs are written once and not twice. Memory: one of the
/// above.
template <class T, class Memory>
struct UninitialisedAllocator {
  using value_type = T;
  UninitialisedAllocator() = default;
  template <class U>
  UninitialisedAllocator(const UninitialisedAllocator<U, Memory>&) noexcept {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t n) {
    if (n > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(Memory::allocate(n * sizeof(T), std::align_val_t(alignof(T))));
  }
  void deallocate(T* block, std::size_t n) noexcept {
    Memory::free(block, n * sizeof(T), std::align_val_t(alignof(T)));
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    if constexpr (sizeof...(Args) == 0)
      ::new (static_cast<void*>(p)) U;
    else
      ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
  friend bool operator==(const UninitialisedAllocator&, const UninitialisedAllocator&) noexcept { return true; }
};

}  // namespace tegl::detail
