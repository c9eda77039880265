// SPDX-License-Identifier: BSD-3-Clause
//
// Memory bandwidth of the machine by number of threads: a lower bound of every extraction time, as an extraction reads
// each sample and writes each vertex and simplex at least once. C++17.
#pragma once

#include <cstddef>

namespace tegl::bench {

/// Bytes per second of reading `bytes` of initialised memory, the maximum of six runs.
double read_rate(std::size_t bytes, int threads);

/// Bytes per second of the first write to `bytes` of new memory, so that the kernel must find and clear its pages: 4
/// KiB pages, or huge pages if the kernel grants them on request. The maximum of six runs.
double fresh_write_rate(std::size_t bytes, int threads, bool huge);

}  // namespace tegl::bench
