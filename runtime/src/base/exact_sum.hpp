// SPDX-License-Identifier: BSD-3-Clause
//
// Compensated summation of many numbers.
// Based on: A. Neumaier, "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen", ZAMM 54 (1974); with
// the rounding error of a sum by D. E. Knuth, The Art of Computer Programming, volume 2, 4.2.2, which needs no branch.
#pragma once

#include <cmath>

namespace tegl::detail {

/// Adds x to a sum, and the rounding error of that to `rest`. Requires code without re-association (no -ffast-math).
inline void add_exactly(double x, double& sum, double& rest) noexcept {
  const double before = sum;
  sum = before + x;
  const double added = sum - before;
  rest += (before - (sum - added)) + (x - added);
}

/// The sum including the rounding errors. These are ignored if they are not finite, as after infinite numbers.
inline double with_rest(double sum, double rest) noexcept { return std::isfinite(rest) ? sum + rest : sum; }

/// Adds numbers and, separately, their rounding errors.
class CompensatedSum {
 public:
  void add(double x) noexcept { add_exactly(x, sum_, rest_); }
  [[nodiscard]] double value() const noexcept { return with_rest(sum_, rest_); }

 private:
  double sum_ = 0.0;
  double rest_ = 0.0;
};

}  // namespace tegl::detail
