// SPDX-License-Identifier: BSD-3-Clause
//
// Implements ThreadLimit: starts threads to find how many the system allows.
#include "base/thread_limit.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <vector>

namespace tegl::cli {

namespace {

/// Threads that wait until all have started.
class Gate {
 public:
  /// Starts up to `most` threads, waits for their end, and returns their number.
  static std::size_t try_threads(std::size_t most) {
    Gate gate;
    pthread_attr_t small;
    pthread_attr_init(&small);
    constexpr std::size_t kStack = std::size_t{1} << 17;
    pthread_attr_setstacksize(&small, kStack);
    pthread_mutex_lock(&gate.mutex_);
    std::vector<pthread_t> threads;
    for (pthread_t thread{}; threads.size() < most && pthread_create(&thread, &small, &Gate::pass, &gate) == 0;)
      threads.push_back(thread);
    pthread_mutex_unlock(&gate.mutex_);
    for (const pthread_t thread : threads) pthread_join(thread, nullptr);
    pthread_attr_destroy(&small);
    return threads.size();
  }

 private:
  static void* pass(void* gate) {
    pthread_mutex_lock(&static_cast<Gate*>(gate)->mutex_);
    pthread_mutex_unlock(&static_cast<Gate*>(gate)->mutex_);
    return nullptr;
  }
  pthread_mutex_t mutex_ = PTHREAD_MUTEX_INITIALIZER;
};

}  // namespace

struct ThreadLimit::Limit {
  explicit Limit(std::size_t threads) : control(tbb::global_control::max_allowed_parallelism, threads) {}
  tbb::global_control control;
};

ThreadLimit::ThreadLimit(unsigned threads) {
  const auto all = static_cast<std::size_t>(std::max(1, tbb::info::default_concurrency()));
  const std::size_t wanted = threads == 0 ? all : std::min<std::size_t>(all, threads);
  const std::size_t found = 1 + Gate::try_threads(wanted - 1);
  if (found >= wanted) return;
  limit_ = std::make_unique<Limit>(found);
  remark_ = fmt::format(
      "the system lets {} of {} threads start (ulimit -u, or a control group); expected more, or --threads {}", found,
      wanted, found);
}

ThreadLimit::~ThreadLimit() = default;

bool is_of_threads(const std::exception& error) {
  // TBB and the standard library report the reason only in the text.
  const std::string_view text = error.what();
  return text.find("pthread_create") != std::string_view::npos || text == std::strerror(EAGAIN);
}

std::string thread_message() {
  return "threads could not be started: the system allows no more (ulimit -u, or a control group); expected a higher "
         "limit, or --threads 1";
}

}  // namespace tegl::cli
