// SPDX-License-Identifier: BSD-3-Clause
//
// How long a call works without asking whether to go on: what somebody waits for who has pressed Ctrl-C.
#pragma once

#include <algorithm>
#include <ctime>

#include "tegl/error.hpp"

namespace tegl::test {

/// What the progress of a call was like. Gaps are in processor time of the whole program, which no other program on
/// the machine changes much.
class ProgressProbe {
 public:
  /// work(progress), from its start to its end. One call at a time.
  template <class Work>
  void watch(const Work& work) {
    *this = {};
    start_ = last_ = now();
    work(Progress([this](double fraction) { return hear(fraction); }));
    note_gap(now());
    total_ = last_ - start_;
  }

  /// Without a gap longer than this share of the whole there is none in which Ctrl-C is not seen for longer.
  [[nodiscard]] double longest_share() const { return longest_ / total_; }
  /// The fraction that was told last before the longest gap: which part of the work it is.
  [[nodiscard]] double longest_after() const { return longest_after_; }
  [[nodiscard]] double seconds() const { return total_; }           ///< processor time of the whole
  [[nodiscard]] bool falls() const { return falls_; }               ///< whether a fraction was below the one before
  [[nodiscard]] double last_fraction() const { return fraction_; }  ///< 1, where the call ended as it should
  [[nodiscard]] bool is_within_bounds() const { return within_; }   ///< whether all fractions were in [0, 1]

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
