// SPDX-License-Identifier: BSD-3-Clause
//
// Measuring for side_by_side.cpp and side_by_side_vtk.cpp: the same clock and the same memory count for both. C++17, as
// the headers of VTK 9.1 are not valid C++20.
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

/// The text returned by side_error().
std::string& last_error();

/// Calls f; returns 0, or 1 after an exception, whose text goes to last_error().
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

/// Measures make(): seconds, page faults, and peak memory in addition to memory in use before.
template <class Make>
auto measured(SideResult& result, Make&& make) {
  malloc_trim(0);  // freed memory of earlier runs would be reused and not counted
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

/// The resident memory of an array: whole huge pages if it has any.
inline std::uint64_t in_pages(std::uint64_t bytes) {
  constexpr std::uint64_t kPage = std::uint64_t{1} << 21U;
  return bytes < kPage ? bytes : (bytes + kPage - 1) / kPage * kPage;
}

/// Subtracts the output, consisting of the given arrays, from the measured memory.
inline void set_output_bytes(SideResult& result, std::initializer_list<std::uint64_t> arrays) {
  std::uint64_t occupied = 0;
  for (const std::uint64_t bytes : arrays) {
    result.output_bytes += bytes;
    occupied += in_pages(bytes);
  }
  result.extra_bytes -= std::min(result.extra_bytes, occupied);
}

}  // namespace tegl::bench
