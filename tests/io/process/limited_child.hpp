// SPDX-License-Identifier: BSD-3-Clause
//
// Runs work in a child process with limits of time and memory, so that a test survives any fault and can measure time
// and memory.
#pragma once

#include <signal.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "tegl/error.hpp"

namespace tegl::test {

/// Result of work in a child process, with its time and memory.
struct ChildResult {
  int signal = 0;                 ///< signal that ended it; SIGALRM: time limit exceeded
  std::optional<ErrorCode> code;  ///< of a thrown tegl::Error; none: nothing or another exception was thrown
  std::string message;            ///< of any exception
  double seconds = 0;             ///< CPU time, which does not depend on the machine's load
  std::uint64_t peak_bytes = 0;   ///< resident memory beyond that at the beginning
};

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kHasSanitizer = true;  // sanitizers reserve terabytes of addresses and slow everything down
#else
inline constexpr bool kHasSanitizer = false;
#endif

namespace limited_child_detail {

inline std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

inline void write_all(int file, const void* data, std::size_t size) {
  for (const char* at = static_cast<const char*>(data); size > 0;) {
    const ssize_t written = write(file, at, size);
    if (written <= 0) return;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
}

/// The child's report, sent before the message.
struct Report {
  int code = -1;  ///< value of the ErrorCode
  std::uint64_t peak_bytes = 0;
};

template <class Work>
[[noreturn]] void run_and_report(Work& work, int file, std::uint64_t address_space, unsigned seconds) {
  if (!kHasSanitizer) {
    const rlimit limit{address_space, address_space};
    setrlimit(RLIMIT_AS, &limit);
  }
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  alarm(seconds);
  const std::uint64_t before = peak_memory();
  Report report;
  std::string message;
  try {
    work();
  } catch (const Error& error) {
    report.code = static_cast<int>(error.code());
    message = error.what();
  } catch (const std::exception& error) {
    message = error.what();
  }
  report.peak_bytes = peak_memory() - std::min(before, peak_memory());
  write_all(file, &report, sizeof(report));
  write_all(file, message.data(), message.size());
  _exit(0);
}

}  // namespace limited_child_detail

/// Runs `work` in a child process with at most `address_space` bytes (not under sanitizers) and at most `seconds` of
/// wall time.
template <class Work>
ChildResult in_limited_child(Work&& work, std::uint64_t address_space = std::uint64_t{4} << 30, unsigned seconds = 10) {
  namespace detail = limited_child_detail;
  ChildResult result;
  int ends[2] = {-1, -1};
  if (pipe(ends) != 0) throw std::runtime_error("pipe");
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork");
  if (child == 0) detail::run_and_report(work, ends[1], address_space, seconds);
  close(ends[1]);
  std::string bytes;
  char block[4096];
  for (ssize_t count = 0; (count = read(ends[0], block, sizeof(block))) > 0;)
    bytes.append(block, static_cast<std::size_t>(count));
  close(ends[0]);
  int status = 0;
  rusage usage{};
  wait4(child, &status, 0, &usage);
  const auto in_seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  result.seconds = in_seconds(usage.ru_utime) + in_seconds(usage.ru_stime);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  if (bytes.size() < sizeof(detail::Report)) return result;
  detail::Report report;
  std::copy_n(bytes.data(), sizeof(report), reinterpret_cast<char*>(&report));
  if (report.code >= 0) result.code = static_cast<ErrorCode>(report.code);
  result.peak_bytes = report.peak_bytes;
  result.message = bytes.substr(sizeof(report));
  return result;
}

}  // namespace tegl::test
