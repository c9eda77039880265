// SPDX-License-Identifier: BSD-3-Clause
//
// What all measuring programs answer to --help.
#pragma once

#include <cstdio>
#include <string_view>

namespace tegl::bench {

/// Whether --help (or -h) is among the arguments: then the usage has been printed, and nothing else is to be done.
inline bool tells_usage(int argc, char** argv, const char* usage) {
  for (int i = 1; i < argc; ++i)
    if (std::string_view(argv[i]) == "--help" || std::string_view(argv[i]) == "-h") {
      std::printf("usage: %s\n", usage);
      return true;
    }
  return false;
}

}  // namespace tegl::bench
