// SPDX-License-Identifier: BSD-3-Clause
//
// A task on another thread, while this one goes on.
#pragma once

#include <functional>
#include <memory>

namespace tegl::detail {

/// The task runs once, on a thread of TBB if one is free, or else on the thread that calls `finish`. So it never waits
/// for a thread. Objects that the task refers to must outlive this one.
class TaskAside {
 public:
  explicit TaskAside(std::function<void()> task);
  /// Waits for a task that has begun; others do not run any more.
  ~TaskAside();
  TaskAside(const TaskAside&) = delete;
  TaskAside& operator=(const TaskAside&) = delete;

  /// Offers the task to another thread. Call it once at most.
  void begin();
  /// Waits for the end of the task, or runs it. Throws the task's exception, every time.
  void finish();

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace tegl::detail
