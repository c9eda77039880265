// SPDX-License-Identifier: BSD-3-Clause
//
// Runs numbered tasks in child processes and monitors each: the signal that ends it, its time, its memory beyond what
// was resident before, and its output. A faulty task is reported by its number, and another child continues with the
// rest.
#pragma once

#include <fcntl.h>
#include <malloc.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <new>
#include <string>
#include <thread>
#include <vector>

namespace tegl::test {

/// Result of a task. The task itself sets `failure` if its result is wrong.
struct WatchedResult {
  bool refused = false;      ///< ended with the expected kind of error
  std::string failure = {};  ///< not empty: a fault
};

struct WatchedLimits {
  std::chrono::milliseconds time = std::chrono::seconds(10);
  std::size_t memory = 64u << 20;  ///< bytes beyond those resident before the task
};

struct WatchedSummary {
  std::size_t runs = 0;
  std::size_t refused = 0;
  double slowest_seconds = 0;
  std::size_t most_memory = 0;                  ///< bytes beyond those resident before the task
  std::vector<std::string> failures = {};       ///< "number: what happened", the first ones
  std::vector<std::uint64_t> failed_runs = {};  ///< the numbers of the first failing tasks
};

namespace watched_detail {

/// Memory shared between child and parent.
struct Shared {
  std::atomic<std::uint64_t> current;  ///< number of the running task
  std::atomic<std::int64_t> begun;     ///< nanoseconds of the steady clock; 0: none runs
  std::atomic<std::uint64_t> refused;
  std::atomic<std::int64_t> slowest;  ///< nanoseconds
  std::atomic<std::uint64_t> most_memory;
  std::atomic<std::uint32_t> failures;  ///< entries of `texts`
  struct Failure {
    std::uint64_t number;
    std::array<char, 500> text;
  };
  std::array<Failure, 32> texts;

  void fail(std::uint64_t number, const std::string& text) {
    if (failures >= texts.size()) return;
    Failure& failure = texts[failures];
    failure.number = number;
    std::snprintf(failure.text.data(), failure.text.size(), "%s", text.c_str());
    ++failures;
  }
};

inline std::int64_t now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// The value in bytes of a line such as "VmHWM: 1234 kB" in /proc/self/status.
inline std::size_t status_bytes(const char* key) {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);)
    if (line.rfind(key, 0) == 0) return std::stoull(line.substr(std::strlen(key) + 1)) * 1024;
  return 0;
}

/// Resets the peak of resident memory to the current value.
inline void reset_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }

inline std::size_t peak_of_children() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

/// Runs the tasks [first, last) in the child, one after the other.
inline void run_pieces(Shared& shared, std::uint64_t first, std::uint64_t last, const WatchedLimits& limits,
                       const std::function<WatchedResult(std::uint64_t)>& work, int output) {
  mallopt(M_MMAP_THRESHOLD, 1 << 17);  // large blocks are returned to the system when freed
  dup2(output, 1);
  dup2(output, 2);
  for (std::uint64_t number = first; number < last; ++number) {
    const std::size_t before = status_bytes("VmRSS:");
    reset_peak();
    shared.current = number;
    const std::int64_t begun = now();
    shared.begun = begun;
    const WatchedResult result = work(number);
    shared.slowest = std::max<std::int64_t>(shared.slowest, now() - begun);
    shared.begun = 0;
    if (result.refused) ++shared.refused;
    if (!result.failure.empty()) shared.fail(number, result.failure);
    const std::size_t peak = status_bytes("VmHWM:");
    const std::size_t used = std::max(peak > before ? peak - before : 0, peak_of_children());
    shared.most_memory = std::max<std::uint64_t>(shared.most_memory, used);
    if (used > limits.memory) {
      shared.fail(number, std::to_string(used >> 20) + " MiB of memory, with a limit of " +
                              std::to_string(limits.memory >> 20));
      _exit(1);  // the peak of children cannot be reset; continue in another child
    }
    if (lseek(output, 0, SEEK_END) > 0) {
      std::array<char, 300> text{};
      if (pread(output, text.data(), text.size() - 1, 0) > 0)
        shared.fail(number, std::string("printed: ") + text.data());
      _exit(1);
    }
  }
  _exit(0);
}

/// Waits for the child; kills it if a task takes too long. Returns a description of the fault, or "".
inline std::string wait_for(pid_t child, Shared& shared, const WatchedLimits& limits) {
  for (;;) {
    int status = 0;
    const pid_t ended = waitpid(child, &status, WNOHANG);
    if (ended == child) {
      if (WIFSIGNALED(status)) return std::string("signal ") + std::to_string(WTERMSIG(status));
      return WEXITSTATUS(status) > 1 ? "exit status " + std::to_string(WEXITSTATUS(status)) : "";
    }
    const std::int64_t begun = shared.begun;
    if (begun != 0 && now() - begun > std::chrono::nanoseconds(limits.time).count()) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return "more than " + std::to_string(limits.time.count()) + " ms";
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

}  // namespace watched_detail

/// Runs work(0) to work(count - 1) in children; stops after 20 failures.
inline WatchedSummary run_watched(std::uint64_t count, const WatchedLimits& limits,
                                  const std::function<WatchedResult(std::uint64_t)>& work) {
  using watched_detail::Shared;
  void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  Shared& shared = *new (memory) Shared{};
  WatchedSummary summary;
  std::uint64_t next = 0;
  while (next < count && shared.failures < 20) {
    constexpr std::uint64_t kBatch = 1000;
    const std::uint64_t last = std::min(count, next + kBatch);
    const int output = memfd_create("output", 0);
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) watched_detail::run_pieces(shared, next, last, limits, work, output);
    const std::string failure = watched_detail::wait_for(child, shared, limits);
    if (!failure.empty()) {
      std::array<char, 400> text{};
      const ssize_t length = pread(output, text.data(), text.size() - 1, 0);
      shared.fail(shared.current, failure + (length > 0 ? std::string("; printed: ") + text.data() : std::string()));
    }
    close(output);
    const bool to_end = failure.empty() && shared.current + 1 == last;
    next = to_end ? last : shared.current + 1;
    shared.begun = 0;
  }
  summary.runs = next;
  summary.refused = shared.refused;
  summary.slowest_seconds = static_cast<double>(shared.slowest.load()) * 1e-9;
  summary.most_memory = shared.most_memory;
  for (std::uint32_t i = 0; i < shared.failures; ++i) {
    summary.failures.push_back(std::to_string(shared.texts[i].number) + ": " + shared.texts[i].text.data());
    summary.failed_runs.push_back(shared.texts[i].number);
  }
  munmap(memory, sizeof(Shared));
  return summary;
}

}  // namespace tegl::test
