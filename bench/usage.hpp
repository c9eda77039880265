// SPDX-License-Identifier: BSD-3-Clause
//
// The --help option of all benchmark programs.
#pragma once

#include <cstdio>
#include <string_view>

namespace tegl::bench {

/// True if --help or -h is among the arguments: the usage has been printed, and the program should end.
inline bool tells_usage(int argc, char** argv, const char* usage) {
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]) == "--help" || std::string_view(argv[i]) == "-h") {
      std::printf("usage: %s\n", usage);
      return true;
    }
  return false;
}

}  // namespace tegl::bench
