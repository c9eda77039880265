// SPDX-License-Identifier: BSD-3-Clause
//
// Options that all long operations share: number of threads and progress.
#pragma once

#include <functional>

namespace tegl {

/// Called by long operations from time to time with a fraction in [0, 1]. Returning false stops the operation, which
/// throws `Error{Cancelled}`.
using Progress = std::function<bool(double fraction)>;

/// Options of every long operation: a member `work` of its options, or its last argument.
struct WorkOptions {
  unsigned threads = 0;    ///< number of threads; 0: all of the machine. The result is the same, byte by byte.
  Progress progress = {};  ///< called from time to time
};

}  // namespace tegl
