// SPDX-License-Identifier: BSD-3-Clause
//
// Long tests run a share of their cases, and all with TEGL_FULL_TOPOLOGY=1 in the environment.
#pragma once

#include <cstddef>
#include <cstdio>
#include <cstdlib>

namespace tegl::test {

/// How many of `count` cases to test: all if the environment has TEGL_FULL_TOPOLOGY, else `share`. Prints it.
inline std::size_t cases_to_test(std::size_t count, std::size_t share) {
  const std::size_t tested = std::getenv("TEGL_FULL_TOPOLOGY") != nullptr ? count : share;
  std::printf("  %zu of %zu cases (all of them: TEGL_FULL_TOPOLOGY=1)\n", tested, count);
  return tested;
}

}  // namespace tegl::test
