// SPDX-License-Identifier: BSD-3-Clause
//
// What this machine's memory can do, by number of threads: the floor under every time of an extraction, which reads
// each sample and writes each vertex and simplex at least once. C++17.
#pragma once

#include <cstddef>

namespace tegl::bench {

/// Bytes per second of reading `bytes` of memory that is there, the best of six.
double read_rate(std::size_t bytes, int threads);

/// Bytes per second of writing `bytes` of memory that is new, so that the kernel has to find and clear its pages: those
/// of 4 KiB, or huge ones where the kernel gives them on request. The best of six.
double fresh_write_rate(std::size_t bytes, int threads, bool huge);

}  // namespace tegl::bench
