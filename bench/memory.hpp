// SPDX-License-Identifier: BSD-3-Clause
//
// How much memory this process has, and had at most (Linux).
#pragma once

#include <malloc.h>
#include <sys/resource.h>

#include <cstdint>
#include <fstream>
#include <string>

namespace tegl::bench {

/// A value of /proc/self/status, such as VmHWM (the most memory that was resident) or VmRSS, in bytes; 0 if it has
/// none.
inline std::uint64_t memory_bytes(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(key + ":", 0) == 0) return 1024 * std::stoull(line.substr(key.size() + 1));
  return 0;
}

/// Gives the system what is freed but kept: else it would count as memory that was there before.
inline void give_back_memory() { malloc_trim(0); }

/// Starts VmHWM anew from what is resident now.
inline void reset_peak_memory() { std::ofstream("/proc/self/clear_refs") << "5"; }

/// Page faults of this process so far that needed no disk.
inline std::uint64_t page_faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_minflt);
}

}  // namespace tegl::bench
