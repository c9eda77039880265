// SPDX-License-Identifier: BSD-3-Clause
//
// CPU time of parts of a program, and linear fits.
#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <limits>
#include <vector>

namespace tegl::bench {

/// CPU seconds of this process; other programs on the machine do not count.
inline double worked_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// The minimum seconds over several runs, by the clock `now()`.
template <class Now, class Work>
double least_seconds_by(const Now& now, const Work& work, int runs) {
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < runs; ++run) {
    const double start = now();
    work();
    least = std::min(least, now() - start);
  }
  return least;
}

/// The minimum CPU seconds over several runs.
template <class Work>
double least_seconds(const Work& work, int runs = 3) {
  return least_seconds_by(worked_seconds, work, runs);
}

/// y = start + each * x by least squares, and the explained share of the variance of y.
struct Fit {
  double start = 0, each = 0, explained = 0;
};

inline Fit fit_line(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sx += x[i];
    sy += y[i];
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    sxx += (x[i] - sx / n) * (x[i] - sx / n);
    sxy += (x[i] - sx / n) * (y[i] - sy / n);
    syy += (y[i] - sy / n) * (y[i] - sy / n);
  }
  Fit fit;
  if (x.empty()) return fit;
  fit.each = sxx > 0 ? sxy / sxx : 0;
  fit.start = (sy - fit.each * sx) / n;
  fit.explained = sxx > 0 && syy > 0 ? sxy * sxy / (sxx * syy) : 0;
  return fit;
}

}  // namespace tegl::bench
