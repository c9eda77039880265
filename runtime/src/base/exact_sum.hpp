// SPDX-License-Identifier: BSD-3-Clause
//
// Compensated summation of many numbers.
// Based on: A. Neumaier, "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen", ZAMM 54 (1974).
#pragma once

#include <cmath>

namespace tegl::detail {

/// Adds numbers and, separately, their rounding errors. Requires code without re-association (no -ffast-math).
class CompensatedSum {
 public:
  void add(double x) noexcept {
    const double sum = sum_ + x;
    rest_ += std::abs(sum_) >= std::abs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
    sum_ = sum;
  }
  /// The sum including the rounding errors. These are ignored if they are not finite, as after infinite numbers.
  [[nodiscard]] double value() const noexcept { return std::isfinite(rest_) ? sum_ + rest_ : sum_; }

 private:
  double sum_ = 0.0;
  double rest_ = 0.0;
};

}  // namespace tegl::detail
