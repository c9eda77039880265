// SPDX-License-Identifier: BSD-3-Clause
//
// Calls of user functions from within parallel work.
#pragma once

#include "base/workers.hpp"

namespace tegl::detail {

/// Calls a user function from within parallel work. If the function waits for tasks of its own, the thread does not
/// take up other parts of the work meanwhile: these would call the function again before it returns, while the thread's
/// scratch is in use.
template <class Call>
auto call_apart(const Call& call) {
#ifdef TEGL_PLAIN_THREADS
  return call();
#else
  return tbb::this_task_arena::isolate(call);
#endif
}

}  // namespace tegl::detail
