// SPDX-License-Identifier: BSD-3-Clause
//
// Gradients at samples from the neighbours of one context: those that no jump (C0) or kink (C1) of the values separates
// from the sample. A linear function is fitted to the sample and its 3^N - 1 neighbours, and neighbours that are far
// from it lose their weight; the fit and the weights are computed in turn. The first function takes, along each axis,
// the smaller of both difference quotients (the one that crosses no jump); for the end of an edge that the contour
// crosses, along that edge the difference of its ends, whose values belong together there.
//
// The distance at which a neighbour loses its weight is three times the median distance, as noise and curvature make
// it, plus the largest slope, so that edges as steep as the image can be are not taken for jumps.
//
// Based on: R. Yagel, D. Cohen and A. Kaufman, Context sensitive normal estimation for volume imaging, 1991 (sums over
// the own context; M. Liversage, thesis, 1994, 8.2.16, asks how to find it); A. Harten et al., Uniformly high order
// accurate essentially non-oscillatory schemes, 1987 (the smoother side); P. W. Holland and R. E. Welsch, Robust
// regression using iteratively reweighted least-squares, 1977.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "image/gradient.hpp"

namespace tegl::detail {

/// A gradient with its uncertainty: the part of the values' variation within the context that the linear function does
/// not explain, in [0, 1]: residual / (residual + slope), as root mean squares. 1 if the gradient is 0.
template <int N>
struct ContextGradient {
  std::array<double, N> gradient{};
  double uncertainty = 1.0;
};

/// The direction from a sample along an edge.
struct EdgeFrom {
  int axis = -1;  ///< -1: none
  int sign = 0;   ///< 1: to the next sample, -1: to the one before
};

template <int N>
class ContextFit {
 public:
  static constexpr std::size_t kSize = power_of_3(N);
  static constexpr int kRounds = 4;

  ContextFit(const ValuesAround<N>& values, const std::array<StepWeights, N>& steps) : here_(values[kSize / 2]) {
    // Along each axis, distances are divided by their mean, so that slopes are per step of the grid.
    std::array<std::array<double, 3>, N> offsets{};
    for (int a = 0; a < N; ++a) {
      const bool both = steps[a].backward != 0.0 && steps[a].forward != 0.0;
      const double share = both ? 0.5 : 1.0;
      const double back = steps[a].backward != 0.0 ? share / steps[a].backward : 0.0;
      const double ahead = steps[a].forward != 0.0 ? share / steps[a].forward : 0.0;
      step_[a] = both ? 0.5 * (back + ahead) : back + ahead;
      if (step_[a] != 0.0) offsets[a] = {-back / step_[a], 0.0, ahead / step_[a]};
    }
    for (std::size_t i = 0; i < kSize; ++i) {
      if (!std::isfinite(values[i] - here_)) continue;
      Neighbour& neighbour = found_[count_++];
      neighbour.difference = values[i] - here_;
      int away = 0;
      std::size_t rest = i;
      for (int a = 0; a < N; ++a, rest /= 3) {
        neighbour.offset[a] = offsets[a][rest % 3];
        away += rest % 3 == 1 ? 0 : 1;
      }
      neighbour.nearness = 1.0 / std::max(1, away);
      if (away == 1) set_quotient(i, neighbour);
    }
  }

  [[nodiscard]] ContextGradient<N> fit(EdgeFrom edge) {
    for (int a = 0; a < N; ++a) {
      const auto [back, ahead] = quotients_[a];
      if (a == edge.axis && std::isfinite(edge.sign > 0 ? ahead : back))
        slope_[a] = edge.sign > 0 ? ahead : back;
      else if (std::isfinite(back) && std::isfinite(ahead))
        slope_[a] = std::abs(ahead) < std::abs(back) ? ahead : back;
      else
        slope_[a] = std::isfinite(back) ? back : std::isfinite(ahead) ? ahead : 0.0;
    }
    for (int round = 0; round < kRounds; ++round) {
      weigh();
      if (!improve()) break;
    }
    ContextGradient<N> result;
    for (int a = 0; a < N; ++a) result.gradient[a] = step_[a] != 0.0 ? slope_[a] / step_[a] : 0.0;
    result.uncertainty = uncertainty();
    return result;
  }

 private:
  struct Neighbour {
    std::array<double, N> offset;  ///< in steps
    double difference;             ///< of its value and the sample's
    double nearness;
    double weight;
  };

  void set_quotient(std::size_t i, const Neighbour& neighbour) {
    for (int a = 0; a < N; ++a)
      if (neighbour.offset[a] != 0.0)
        (i < kSize / 2 ? quotients_[a].first : quotients_[a].second) = neighbour.difference / neighbour.offset[a];
  }

  [[nodiscard]] double residual(const Neighbour& neighbour) const {
    double expected = level_;
    for (int a = 0; a < N; ++a) expected += slope_[a] * neighbour.offset[a];
    return neighbour.difference - expected;
  }

  void weigh() {
    std::array<double, kSize> distances;
    for (std::size_t i = 0; i < count_; ++i) distances[i] = std::abs(residual(found_[i]));
    std::array<double, kSize> sorted = distances;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(count_ / 2);
    std::nth_element(sorted.begin(), middle, sorted.begin() + static_cast<std::ptrdiff_t>(count_));
    double scale = 0.0;
    for (const double slope : slope_) scale = std::max(scale, std::abs(slope));
    scale += 3.0 * *middle;
    for (std::size_t i = 0; i < count_; ++i) {
      const double ratio = scale > 0.0 ? distances[i] / scale : distances[i] > 0.0 ? 1e6 : 0.0;
      const double distant = 1.0 + ratio * ratio;
      const double to_4th = distant * distant * distant * distant;
      found_[i].weight = found_[i].nearness / (to_4th * to_4th);
    }
  }

  /// The weighted linear fit. A small weight of the slopes so far decides what the context leaves open.
  bool improve() {
    using Matrix = Eigen::Matrix<double, N + 1, N + 1>;
    using Vector = Eigen::Matrix<double, N + 1, 1>;
    Matrix normal = Matrix::Zero();
    Vector right = Vector::Zero();
    double sum = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
      Vector row;
      row[0] = 1.0;
      for (int a = 0; a < N; ++a) row[a + 1] = found_[i].offset[a];
      normal.noalias() += found_[i].weight * row * row.transpose();
      right.noalias() += found_[i].weight * residual(found_[i]) * row;
      sum += found_[i].weight;
    }
    for (int a = 0; a < N; ++a) normal(a + 1, a + 1) += 1e-6 * sum;
    const Vector change = normal.ldlt().solve(right);
    if (!change.allFinite()) return false;
    level_ += change[0];
    for (int a = 0; a < N; ++a) slope_[a] += change[a + 1];
    return true;
  }

  [[nodiscard]] double uncertainty() const {
    double unexplained = 0.0, explained = 0.0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double distance = residual(found_[i]);
      const double expected = found_[i].difference - distance - level_;
      unexplained += found_[i].weight * distance * distance;
      explained += found_[i].weight * expected * expected;
    }
    const double rest = std::sqrt(unexplained), slope = std::sqrt(explained);
    return slope > 0.0 && std::isfinite(rest) ? rest / (rest + slope) : 1.0;
  }

  double here_;
  double level_ = 0.0;  ///< of the linear function at the sample, minus the sample's value
  std::array<double, N> step_{}, slope_{};
  std::array<std::pair<double, double>, N> quotients_ = [] {
    std::array<std::pair<double, double>, N> none;
    none.fill({std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()});
    return none;
  }();
  std::array<Neighbour, kSize> found_;
  std::size_t count_ = 0;
};

}  // namespace tegl::detail
