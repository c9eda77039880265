// SPDX-License-Identifier: BSD-3-Clause
//
// Times for reports.
#pragma once

#include <chrono>

namespace tegl::detail {

/// Adds the time since the last call to one of several counters.
class Stopwatch {
 public:
  void add_to(double& seconds) noexcept {
    const auto now = Clock::now();
    seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace tegl::detail
