// SPDX-License-Identifier: BSD-3-Clause
//
// Measures the time between progress callbacks: the delay of a response to Ctrl-C.
#pragma once

#include <algorithm>
#include <ctime>

#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::test {

/// Progress of one call. Gaps are CPU times of the whole program, which other programs on the machine hardly influence.
class ProgressProbe {
 public:
  /// Runs and measures work(progress). One call at a time.
  template <class Work>
  void watch(const Work& work) {
    *this = {};
    start_ = last_ = now();
    work(Progress([this](double fraction) { return hear(fraction); }));
    note_gap(now());
    total_ = last_ - start_;
  }

  /// The longest gap between callbacks as a share of the total time; it bounds the delay of a response to Ctrl-C.
  [[nodiscard]] double longest_share() const { return longest_ / total_; }
  /// The last fraction reported before the longest gap; identifies the phase of the work.
  [[nodiscard]] double longest_after() const { return longest_after_; }
  [[nodiscard]] double seconds() const { return total_; }  ///< CPU time of the whole call
  [[nodiscard]] bool falls() const { return falls_; }      ///< true if a fraction was smaller than the previous one
  [[nodiscard]] double last_fraction() const { return fraction_; }  ///< the last fraction; 1 if the call completed
  [[nodiscard]] bool is_within_bounds() const { return within_; }   ///< true if all fractions were in [0, 1]

 private:
  static double now() {
    std::timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  bool hear(double fraction) {
    note_gap(now());
    falls_ = falls_ || fraction < fraction_;
    within_ = within_ && fraction >= 0.0 && fraction <= 1.0;
    fraction_ = fraction;
    return true;
  }

  void note_gap(double time) {
    if (time - last_ > longest_) {
      longest_ = time - last_;
      longest_after_ = fraction_;
    }
    last_ = time;
  }

  double start_ = 0.0, last_ = 0.0, longest_ = 0.0, longest_after_ = 0.0, total_ = 0.0;
  double fraction_ = 0.0;
  bool falls_ = false;
  bool within_ = true;
};

}  // namespace tegl::test
