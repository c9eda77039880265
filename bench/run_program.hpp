// SPDX-License-Identifier: BSD-3-Clause
//
// The main function of programs that measure: errors and the exit status.
#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <exception>

namespace tegl::bench {

/// Returns the program's exit status: run(argc, argv), or 1 after printing an error.
template <class Run>
int run_program(const char* program, int argc, char** argv, const Run& run) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", program, error.what());
    return 1;
  }
}

}  // namespace tegl::bench
