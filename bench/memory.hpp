// SPDX-License-Identifier: BSD-3-Clause
//
// Current and peak memory of this process (Linux).
#pragma once

#include <malloc.h>
#include <sys/resource.h>

#include <cstdint>
#include <fstream>
#include <string>

namespace tegl::bench {

/// A value of /proc/self/status in bytes, such as VmHWM (peak resident memory) or VmRSS; 0 if there is none.
inline std::uint64_t memory_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(key + ":", 0) == 0) return 1024 * std::stoull(line.substr(key.size() + 1));
  return 0;
}

/// Returns freed memory to the system; otherwise it would count as memory in use before a measurement.
inline void give_back_memory() { malloc_trim(0); }

/// Resets VmHWM to the current resident memory.
inline void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }

/// Number of page faults of this process so far that needed no disk access.
inline std::uint64_t page_faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_minflt);
}

}  // namespace tegl::bench
