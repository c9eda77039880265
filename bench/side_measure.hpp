// SPDX-License-Identifier: BSD-3-Clause
//
// How side_by_side.cpp and side_by_side_vtk.cpp measure: the same clock and the same count of memory for both.
// C++17, as the headers of VTK 9.1 are not valid C++20.
#pragma once

#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <exception>
#include <initializer_list>
#include <string>

#include "memory.hpp"
#include "side_by_side.hpp"

namespace tegl::bench {

/// The text that side_error() gives.
std::string& last_error();

/// Runs f; an exception becomes 1 and its text.
template <class F>
int guarded(F&& f) {
  try {
    f();
    return 0;
  } catch (const std::exception& error) {
    last_error() = error.what();
    return 1;
  }
}

/// Measures make(): seconds, and the most memory on the way beside what was there before.
template <class Make>
auto measured(SideResult& result, Make&& make) {
  malloc_trim(0);  // what earlier runs left would be used again, and not be seen
  const std::uint64_t before = memory_bytes("VmRSS");
  reset_peak_memory();
  const std::uint64_t faults = page_faults();
  const auto start = std::chrono::steady_clock::now();
  auto made = make();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.page_faults = page_faults() - faults;
  const std::uint64_t peak = memory_bytes("VmHWM");
  result.extra_bytes = peak > before ? peak - before : 0;
  return made;
}

/// What an array takes of the process's memory: all of its large pages, where it has some.
inline std::uint64_t in_pages(std::uint64_t bytes) {
  constexpr std::uint64_t kPage = std::uint64_t{1} << 21U;
  return bytes < kPage ? bytes : (bytes + kPage - 1) / kPage * kPage;
}

/// What remains of the measured memory beside the output, which is of the given arrays.
inline void set_output_bytes(SideResult& result, std::initializer_list<std::uint64_t> arrays) {
  std::uint64_t occupied = 0;
  for (const std::uint64_t bytes : arrays) {
    result.output_bytes += bytes;
    occupied += in_pages(bytes);
  }
  result.extra_bytes -= std::min(result.extra_bytes, occupied);
}

}  // namespace tegl::bench
