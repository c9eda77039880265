// SPDX-License-Identifier: BSD-3-Clause
//
// Progress bar on a terminal. With interrupt.hpp it is the progress callback of all long operations.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "base/console.hpp"
#include "base/interrupt.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::cli {

/// The remaining time of work that has taken `seconds` for `fraction` of it and continues at the same rate, as in
/// "3 min left". Empty before 2 s or 1 % of the work, and at the end.
[[nodiscard]] std::string time_left(double seconds, double fraction);

/// A progress bar on a terminal, with the estimated remaining time of long stages; one stage after the other. Draws
/// nothing on other streams, nor on terminals without cursor movement. In narrow windows it is a number, or nothing.
class ProgressBar {
 public:
  ProgressBar(const Console& console, bool wanted) : console_(&console), draw_(wanted && console.moves_its_cursor()) {}
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Starts a stage and returns its callback, which draws at most 20 times a second and returns false once an interrupt
  /// is requested. Throws Cancelled if one already is. The callback may be called by any thread and must not outlive
  /// the bar.
  Progress stage(std::string name);

  /// Removes the bar from the terminal.
  void clear();

 private:
  void draw(double fraction);
  [[nodiscard]] std::string text(double fraction) const;

  const Console* console_;
  bool draw_;
  bool visible_ = false;
  std::string name_;
  std::chrono::steady_clock::time_point start_{};  ///< of the stage
  std::chrono::steady_clock::time_point last_{};
  std::mutex mutex_;
};

/// Measures seconds since construction or since the last lap.
class Stopwatch {
 public:
  double lap();

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace tegl::cli
