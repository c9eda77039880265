// SPDX-License-Identifier: BSD-3-Clause
//
// Progress on a terminal: with interrupt.hpp the callback that every long operation takes.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "base/console.hpp"
#include "base/interrupt.hpp"
#include "tegl/error.hpp"

namespace tegl::cli {

/// A bar on a terminal, one stage of the work after the other; draws nothing elsewhere, nor where a terminal cannot
/// write over it. In narrow windows it is a number, or nothing.
class ProgressBar {
 public:
  ProgressBar(const Console& console, bool wanted) : console_(&console), draw_(wanted && console.moves_its_cursor()) {}
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Starts a stage, and returns the callback for it: draws at most 20 times a second, and returns false
  /// once an interrupt was requested. Throws Cancelled if one is already. The callback may come from any
  /// thread and must not outlive the bar.
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
  std::chrono::steady_clock::time_point last_{};
  std::mutex mutex_;
};

/// Seconds since it was made, or since the last lap.
class Stopwatch {
 public:
  double lap();

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace tegl::cli
