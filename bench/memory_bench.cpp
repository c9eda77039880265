// SPDX-License-Identifier: BSD-3-Clause
//
// Memory bandwidth by number of threads, as a reference for other figures: reading 512 MiB, and first writes with small
// and huge pages. Prints gigabytes (1e9) per second.
#include <cstdio>
#include <exception>

#include "bandwidth.hpp"
#include "usage.hpp"

int main(int argc, char** argv) {
  if (tegl::bench::tells_usage(argc, argv, "memory_bench: how fast memory is read and written, by number of threads"))
    return 0;
  constexpr std::size_t kBytes = std::size_t{512} << 20U;
  constexpr double kGiga = 1e-9;
  try {
    std::printf("threads  read  first write, 4 KiB pages  first write, huge pages  (GB/s)\n");
    for (int threads = 1; threads <= 4; ++threads)
      std::printf("%7d  %4.1f  %24.1f  %23.1f\n", threads, kGiga * tegl::bench::read_rate(kBytes, threads),
                  kGiga * tegl::bench::fresh_write_rate(kBytes, threads, false),
                  kGiga * tegl::bench::fresh_write_rate(kBytes, threads, true));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "memory_bench: %s\n", error.what());
    return 1;
  }
}
