// SPDX-License-Identifier: BSD-3-Clause
//
// Time measurement for reports.
#pragma once

#include <chrono>
#include <cstdint>

namespace tegl::detail {

/// Adds the time since the last call to one of several counters.
class Stopwatch {
 public:
  void add_to(double& seconds) noexcept {
    const auto now = Clock::now();
    seconds += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  /// Divides the time since the last call between two counters: `share` of it is added to the first.
  void share_between(double& first, double share, double& second) noexcept {
    double both = 0.0;
    add_to(both);
    first += share * both;
    second += (1.0 - share) * both;
  }

  /// Time since an arbitrary fixed moment.
  static std::int64_t nanoseconds() noexcept {
    return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now().time_since_epoch()).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace tegl::detail
