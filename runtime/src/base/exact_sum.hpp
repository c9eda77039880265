// SPDX-License-Identifier: BSD-3-Clause
//
// Sums of many numbers that lose nothing but the last bits.
// Based on: A. Neumaier, "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen", ZAMM 54 (1974).
#pragma once

#include <cmath>

namespace tegl::detail {

/// Adds up numbers together with what is rounded off. Needs code without re-association (no -ffast-math).
class CompensatedSum {
 public:
  void add(double x) noexcept {
    const double sum = sum_ + x;
    rest_ += std::abs(sum_) >= std::abs(x) ? (sum_ - sum) + x : (x - sum) + sum_;
    sum_ = sum;
  }
  /// What is rounded off is of no use once numbers are infinite.
  [[nodiscard]] double value() const noexcept { return std::isfinite(rest_) ? sum_ + rest_ : sum_; }

 private:
  double sum_ = 0.0;
  double rest_ = 0.0;
};

}  // namespace tegl::detail
