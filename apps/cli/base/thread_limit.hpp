// SPDX-License-Identifier: BSD-3-Clause
//
// Threads where the system limits how many there may be (ulimit -u, control groups).
#pragma once

#include <exception>
#include <memory>
#include <string>

namespace tegl::cli {

/// Keeps the program, as long as it lives, to as many threads as can be started.
class ThreadLimit {
 public:
  /// Tries to start so many threads, 0 for all that the machine has. If all of them start, nothing is limited.
  explicit ThreadLimit(unsigned threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

  /// How many threads there are if they are fewer; else empty.
  [[nodiscard]] const std::string& remark() const noexcept { return remark_; }

 private:
  struct Limit;
  std::unique_ptr<Limit> limit_;
  std::string remark_;
};

/// Whether an error is one of a thread that could not be started.
bool is_of_threads(const std::exception& error);

/// What to say of such an error.
std::string thread_message();

}  // namespace tegl::cli
