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
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

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

/// The pairs of places that sort `kCount` values if they are compared and exchanged in order.
///
/// Based on: D. E. Knuth, The Art of Computer Programming, volume 3, 1998, algorithm 5.2.2M (K. E. Batcher's merge
/// exchange).
template <std::size_t kCount>
constexpr auto exchanges() {
  const auto for_each = [](const auto& exchange) {
    constexpr std::size_t kTop = std::bit_ceil(kCount) / 2;
    for (std::size_t p = kTop; p > 0; p /= 2)
      for (std::size_t q = kTop, r = 0, d = p;; d = q - p, q /= 2, r = p) {
        for (std::size_t i = 0; i + d < kCount; ++i)
          if ((i & p) == r) exchange(i, i + d);
        if (q == p) break;
      }
  };
  constexpr std::size_t kMost = kCount * kCount / 2;
  std::array<std::array<std::uint8_t, 2>, kMost> pairs{};
  std::size_t count = 0;
  for_each([&](std::size_t i, std::size_t j) {
    pairs[count++] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(j)};
  });
  return std::pair(pairs, count);
}

template <int N>
class ContextFit {
 public:
  static constexpr std::size_t kSize = power_of_3(N);
  static constexpr int kRounds = 4;

  ContextFit(const ValuesAround<N>& values, const std::array<StepWeights, N>& steps) {
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
    const double here = values[kSize / 2];
    for (std::size_t i = 0; i < kSize; ++i) {
      const double difference = values[i] - here;
      if (!std::isfinite(difference)) continue;
      differences_[i] = difference;
      nearness_[i] = kNearness[i];
      ++count_;
      for (int a = 0; a < N; ++a) offsets_[a][i] = offsets[a][kPlaces[i][a]];
    }
    for (std::size_t a = 0, step = 1; a < N; ++a, step *= 3)
      for (const std::size_t i : {kSize / 2 - step, kSize / 2 + step})
        if (nearness_[i] != 0.0 && offsets_[a][i] != 0.0)
          (i < kSize / 2 ? quotients_[a].first : quotients_[a].second) = differences_[i] / offsets_[a][i];
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
    find_residuals();
    for (int round = 0; round < kRounds; ++round) {
      weigh();
      if (!improve()) break;
      find_residuals();
    }
    ContextGradient<N> result;
    for (int a = 0; a < N; ++a) result.gradient[a] = step_[a] != 0.0 ? slope_[a] / step_[a] : 0.0;
    result.uncertainty = uncertainty();
    return result;
  }

 private:
  /// The neighbours in the order of ValuesAround, and up to 3 more of weight 0, so that vectors are full.
  static constexpr std::size_t kLanes = 4;
  static constexpr std::size_t kRoom = (kSize + kLanes - 1) / kLanes * kLanes;
  using Values = std::array<double, kRoom>;
  using Lanes = std::array<double, kLanes>;

  /// By neighbour and axis: before, at or behind the sample.
  static constexpr auto kPlaces = [] {
    std::array<std::array<std::uint8_t, N>, kSize> places{};
    for (std::size_t i = 0; i < kSize; ++i) {
      std::size_t rest = i;
      for (int a = 0; a < N; ++a, rest /= 3) places[i][a] = static_cast<std::uint8_t>(rest % 3);
    }
    return places;
  }();
  static constexpr auto kNearness = [] {
    std::array<double, kSize> nearness{};
    for (std::size_t i = 0; i < kSize; ++i) {
      int away = 0;
      for (const std::uint8_t place : kPlaces[i]) away += place == 1 ? 0 : 1;
      nearness[i] = 1.0 / std::max(1, away);
    }
    return nearness;
  }();

  void find_residuals() {
    for (std::size_t i = 0; i < kRoom; ++i) {
      double expected = level_;
      for (int a = 0; a < N; ++a) expected += slope_[a] * offsets_[a][i];
      residuals_[i] = differences_[i] - expected;
    }
  }

  /// The median of the residuals' magnitudes.
  [[nodiscard]] double median() const {
    std::array<double, kSize> sorted;
    for (std::size_t i = 0; i < kSize; ++i)
      sorted[i] = nearness_[i] != 0.0 ? std::abs(residuals_[i]) : std::numeric_limits<double>::infinity();
    if constexpr (kSize <= 27) {
      // without branches, which would be hard to predict
      constexpr auto kExchanges = exchanges<kSize>();
      [&]<std::size_t... E>(std::index_sequence<E...>) {
        (exchange(sorted[kExchanges.first[E][0]], sorted[kExchanges.first[E][1]]), ...);
      }
      (std::make_index_sequence<kExchanges.second>());
    } else {
      std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(count_ / 2), sorted.end());
    }
    return sorted[count_ / 2];
  }
  [[gnu::always_inline]] static void exchange(double& a, double& b) {
    const double low = std::min(a, b);
    b = std::max(a, b);
    a = low;
  }

  void weigh() {
    double scale = 0.0;
    for (const double slope : slope_) scale = std::max(scale, std::abs(slope));
    scale += 3.0 * median();
    if (scale > 0.0) {
      for (std::size_t i = 0; i < kRoom; ++i) {
        const double ratio = residuals_[i] / scale;
        weights_[i] = nearness_[i] / to_8th(1.0 + ratio * ratio);
      }
    } else {
      for (std::size_t i = 0; i < kRoom; ++i) weights_[i] = residuals_[i] != 0.0 ? nearness_[i] * 1e-96 : nearness_[i];
    }
  }
  static double to_8th(double x) noexcept {
    const double square = x * x, to_4th = square * square;
    return to_4th * to_4th;
  }

  /// The weighted linear fit. A small weight of the slopes so far decides what the context leaves open.
  bool improve() {
    // the normal equations: rows of the lower triangle, and the right side, summed in kLanes parts
    constexpr int kRows = N + 1;
    std::array<std::array<Lanes, kRows + 1>, kRows + 1> parts{};
    for (std::size_t first = 0; first < kRoom; first += kLanes) {
      std::array<Lanes, kRows + 1> row;  // 1, offsets, residual
      for (std::size_t l = 0; l < kLanes; ++l) {
        row[0][l] = 1.0;
        for (int a = 0; a < N; ++a) row[a + 1][l] = offsets_[a][first + l];
        row[kRows][l] = residuals_[first + l];
      }
      for (int j = 0; j < kRows; ++j) {
        Lanes weighted;
        for (std::size_t l = 0; l < kLanes; ++l) weighted[l] = weights_[first + l] * row[j][l];
        for (int k = j; k <= kRows; ++k)
          for (std::size_t l = 0; l < kLanes; ++l) parts[k][j][l] += weighted[l] * row[k][l];
      }
    }
    std::array<std::array<double, kRows>, kRows + 1> matrix;
    for (int k = 0; k <= kRows; ++k)
      for (int j = 0; j < kRows; ++j) {
        const Lanes& part = parts[k][j];
        matrix[k][j] = (part[0] + part[1]) + (part[2] + part[3]);
      }
    const double sum = matrix[0][0];
    for (int a = 1; a < kRows; ++a) matrix[a][a] += 1e-6 * sum;
    const std::array<double, kRows> change = solve(matrix);
    for (const double x : change)
      if (!std::isfinite(x)) return false;
    level_ += change[0];
    for (int a = 0; a < N; ++a) slope_[a] += change[a + 1];
    return true;
  }

  /// Solves the equations whose matrix is symmetric and positive definite (its lower triangle), and whose right side is
  /// the last row: L D L^T without pivots.
  static std::array<double, N + 1> solve(std::array<std::array<double, N + 1>, N + 2>& m) {
    constexpr int kRows = N + 1;
    // Row i becomes that of L, except for the diagonal, which becomes D; the right side becomes that of L^T x = b.
    for (int i = 0; i <= kRows; ++i)
      for (int j = 0; j < std::min(i + 1, kRows); ++j) {
        double sum = m[i][j];
        for (int k = 0; k < j; ++k) sum -= m[i][k] * m[j][k] * m[k][k];
        m[i][j] = i == j ? sum : sum / m[j][j];
      }
    std::array<double, kRows> x = m[kRows];
    for (int i = kRows - 1; i >= 0; --i)
      for (int k = i + 1; k < kRows; ++k) x[i] -= m[k][i] * x[k];
    return x;
  }

  [[nodiscard]] double uncertainty() const {
    double unexplained = 0.0, explained = 0.0;
    for (std::size_t i = 0; i < kSize; ++i) {
      const double expected = differences_[i] - residuals_[i] - level_;
      unexplained += weights_[i] * residuals_[i] * residuals_[i];
      explained += weights_[i] * expected * expected;
    }
    const double rest = std::sqrt(unexplained), slope = std::sqrt(explained);
    return slope > 0.0 && std::isfinite(rest) ? rest / (rest + slope) : 1.0;
  }

  double level_ = 0.0;  ///< of the linear function at the sample, minus the sample's value
  std::array<double, N> step_{}, slope_{};
  std::array<std::pair<double, double>, N> quotients_ = [] {
    std::array<std::pair<double, double>, N> none;
    none.fill({std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()});
    return none;
  }();
  // by neighbour; all are 0 for missing ones
  std::array<Values, N> offsets_{};  ///< in steps
  Values differences_{};             ///< of its value and the sample's
  Values nearness_{};
  Values residuals_{}, weights_{};
  std::size_t count_ = 0;
};

}  // namespace tegl::detail
