// SPDX-License-Identifier: BSD-3-Clause
//
// The task is claimed by the first thread that begins it.
#include "base/task_aside.hpp"

#include <atomic>
#include <exception>
#include <future>
#include <thread>
#include <utility>

#include <tbb/task_arena.h>

#include "base/plain_threads.hpp"

namespace tegl::detail {

struct TaskAside::State {
  explicit State(std::function<void()> call) : task(std::move(call)), done(promise.get_future()) {}

  /// Whether this thread is the first one.
  bool claim() { return !claimed.exchange(true); }
  void run() {
    try {
      task();
      promise.set_value();
    } catch (...) {
      promise.set_exception(std::current_exception());
    }
  }

  std::function<void()> task;
  std::atomic<bool> claimed = false;
  std::promise<void> promise;
  std::shared_future<void> done;
  tbb::task_arena arena{1, 0};  ///< without a place for the thread that waits
};

TaskAside::TaskAside(std::function<void()> task) : state_(std::make_shared<State>(std::move(task))) {}

TaskAside::~TaskAside() {
  if (!state_->claim()) state_->done.wait();
}

void TaskAside::begin() {
  state_->claimed = false;  // what this thread wrote before is seen by the one that claims the task
  // The state is shared: the other thread may come when this object is gone, and then finds the task claimed.
  const auto take = [state = state_] {
    if (state->claim()) state->run();
  };
#ifdef TEGL_PLAIN_THREADS
  std::thread(take).detach();
#else
  state_->arena.enqueue(take);
#endif
}

void TaskAside::finish() {
  if (state_->claim()) state_->run();
  state_->done.get();
}

}  // namespace tegl::detail
