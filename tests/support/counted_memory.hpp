// SPDX-License-Identifier: BSD-3-Clause
//
// Counts every allocation of the program: replaces operators new and delete. Include it in one source of a program
// only. (The library allocates blocks of 2 MiB and more from the system; these are not counted.)
#pragma once

#include <malloc.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

#include "tegl/extract.hpp"

namespace tegl::test::counted_memory {

inline std::atomic<std::size_t> live_bytes = 0;
inline std::atomic<std::size_t> peak_bytes = 0;

[[gnu::noinline]] inline void* counted(void* block) {
  if (block == nullptr) throw std::bad_alloc();
  const std::size_t bytes = malloc_usable_size(block);
  const std::size_t live = live_bytes.fetch_add(bytes) + bytes;
  std::size_t peak = peak_bytes.load();
  while (peak < live && !peak_bytes.compare_exchange_weak(peak, live)) {
  }
  return block;
}

// Not inlined: the compiler would warn about mismatched malloc and free.
[[gnu::noinline]] inline void free_counted(void* block) noexcept {
  if (block == nullptr) return;
  live_bytes.fetch_sub(malloc_usable_size(block));
  std::free(block);
}

}  // namespace tegl::test::counted_memory

void* operator new(std::size_t bytes) {
  return tegl::test::counted_memory::counted(std::malloc(std::max<std::size_t>(bytes, 1)));
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  const auto align = static_cast<std::size_t>(alignment);
  return tegl::test::counted_memory::counted(std::aligned_alloc(align, (bytes + align - 1) / align * align));
}
void operator delete(void* block) noexcept { tegl::test::counted_memory::free_counted(block); }
void operator delete(void* block, std::size_t) noexcept { tegl::test::counted_memory::free_counted(block); }
void operator delete(void* block, std::align_val_t) noexcept { tegl::test::counted_memory::free_counted(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept {
  tegl::test::counted_memory::free_counted(block);
}

namespace tegl::test {

/// Peak of allocated bytes while the contour is written to memory allocated beforehand.
template <Value T, int N>
std::size_t bytes_beside(const OwnedImage<T, N>& image, double isovalue, const ExtractOptions& options) {
  const ContourSize size = count(image.view(), isovalue, options);
  std::vector<std::array<float, N>> vertices(size.vertices);
  std::vector<std::array<Index, N>> simplices(size.simplices);
  std::vector<std::array<float, N>> normals(options.normals != Normals::none ? size.vertices : 0);
  const ContourRoom<N, float> room{vertices, simplices, normals};
  extract_into(image.view(), isovalue, room, options);  // creates threads and tables
  const std::size_t before = counted_memory::live_bytes;
  counted_memory::peak_bytes = before;
  extract_into(image.view(), isovalue, room, options);
  return counted_memory::peak_bytes - before;
}

}  // namespace tegl::test
