// SPDX-License-Identifier: BSD-3-Clause
//
// Adapts to system limits of the number of threads (ulimit -u, control groups).
#pragma once

#include <exception>
#include <memory>
#include <string>

namespace tegl::cli {

/// While it exists, limits the program to the number of threads that can be started.
class ThreadLimit {
 public:
  /// Tries to start `threads` threads, 0 for all of the machine. If all of them start, nothing is limited.
  explicit ThreadLimit(unsigned threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

  /// The number of threads, as text, if they are limited; else empty.
  [[nodiscard]] const std::string& remark() const noexcept { return remark_; }

 private:
  struct Limit;
  std::unique_ptr<Limit> limit_;
  std::string remark_;
};

/// Whether an error means that a thread could not be started.
bool is_of_threads(const std::exception& error);

/// The message for such an error.
std::string thread_message();

}  // namespace tegl::cli
