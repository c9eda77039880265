// SPDX-License-Identifier: BSD-3-Clause
//
// Long tests run a share of their cases, and all with TEGL_FULL_TOPOLOGY=1 in the environment.
#pragma once

#include <cstddef>
#include <cstdio>
#include <cstdlib>

namespace tegl::test {

/// `count`, or `fewer` under a sanitizer, which makes tests ten times as slow and finds its faults in a few cases.
constexpr std::size_t unless_sanitized(std::size_t count, [[maybe_unused]] std::size_t fewer) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return fewer;
#else
  return count;
#endif
}

/// How many of `count` cases to test: all if the environment has TEGL_FULL_TOPOLOGY, else `share`. Prints it.
inline std::size_t cases_to_test(std::size_t count, std::size_t share) {
  const std::size_t tested = std::getenv("TEGL_FULL_TOPOLOGY") != nullptr ? count : share;
  std::printf("  %zu of %zu cases (all of them: TEGL_FULL_TOPOLOGY=1)\n", tested, count);
  return tested;
}

}  // namespace tegl::test
