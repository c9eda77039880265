// SPDX-License-Identifier: BSD-3-Clause
//
// Calls of the caller's own functions from within work that threads share.
#pragma once

#include "base/workers.hpp"

namespace tegl::detail {

/// Calls a function of the caller's from within the work. If it waits for tasks of its own, the thread does not take up
/// other parts of the work meanwhile: these would call it anew before it is done, and find in use what the thread keeps
/// for its work.
template <class Call>
auto call_apart(const Call& call) {
#ifdef TEGL_PLAIN_THREADS
  return call();
#else
  return tbb::this_task_arena::isolate(call);
#endif
}

}  // namespace tegl::detail
