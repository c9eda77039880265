// SPDX-License-Identifier: BSD-3-Clause
//
// Images on periodic axes, to be sampled at wrapped contours.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tegl/image.hpp"
#include "tegl/periodic.hpp"
#include "tegl/sample.hpp"

namespace tegl::cli {

/// How far an axis's samples cover a period.
struct CoveredPeriod {
  double length = 0.0;          ///< along the axis; 0 if the period is along others, or if the samples end long before
  bool needs_one_more = false;  ///< whether the samples end about one step before the period does
};

template <int N>
CoveredPeriod covered_period(const Grid<N>& grid, int axis, const Period<N>& period) {
  constexpr double kTolerance = 1e-3;  // of a step
  const auto a = static_cast<std::size_t>(axis);
  if (grid.axes[a].size() < 2) return {};
  double along = 0.0, square = 0.0, apart = 0.0, size = 0.0;
  for (std::size_t i = 0; i < N; ++i) {
    along += period.vector[i] * grid.linear[i][a];
    square += grid.linear[i][a] * grid.linear[i][a];
  }
  const double length = along / square;
  for (std::size_t i = 0; i < N; ++i) {
    apart += std::abs(period.vector[i] - length * grid.linear[i][a]);
    size += std::abs(period.vector[i]);
  }
  const double span = std::abs(grid.axes[a][grid.axes[a].size() - 1] - grid.axes[a][0]);
  const double rest = std::abs(length) - span, step = span / static_cast<double>(grid.axes[a].size() - 1);
  if (!(apart <= 1e-6 * size && rest < 1.5 * step)) return {};
  return {std::abs(length), rest > kTolerance * step};
}

/// The image with its first samples repeated at the end of an axis, one period after them.
template <Value T, int N>
OwnedImage<T, N> with_repeated_samples(const OwnedImage<T, N>& owned, int axis, double period) {
  OwnedImage<T, N> result;
  result.grid = owned.grid;
  Axis& along = result.grid.axes[static_cast<std::size_t>(axis)];
  const std::size_t size = along.size();
  along = longer_axis(along, period);
  std::size_t row = 1;
  for (int a = 0; a < axis; ++a) row *= owned.grid.axes[static_cast<std::size_t>(a)].size();
  const T* const samples = owned.values.data();
  std::vector<T> values;
  values.reserve(owned.values.size() / size * (size + 1));
  for (std::size_t first = 0; first < owned.values.size(); first += row * size) {
    values.insert(values.end(), samples + first, samples + first + row * size);
    values.insert(values.end(), samples + first, samples + first + row);
  }
  result.values = Values<T>(std::move(values));
  return result;
}

/// Moves vertices outside of the places that the samples of a grid have along an axis to these, by whole periods.
template <int N, class Real>
void move_to_samples(const Grid<N>& grid, int axis, const Period<N>& period, Contour<N, Real>& contour) {
  constexpr double kRounding = 4 * static_cast<double>(std::numeric_limits<Real>::epsilon());
  const auto a = static_cast<std::size_t>(axis);
  const auto share_at = [&](double coordinate) {
    std::array<double, N> x = grid.offset;
    for (std::size_t i = 0; i < N; ++i) x[i] += grid.linear[i][a] * coordinate;
    return share_of(period, x);
  };
  const auto [start, end] = std::minmax({share_at(grid.axes[a][0]), share_at(grid.axes[a][grid.axes[a].size() - 1])});
  for (auto& vertex : contour.vertices) {
    std::array<double, N> x;
    std::copy(vertex.begin(), vertex.end(), x.begin());
    const double share = share_of(period, x);
    if (share >= start && share <= end) continue;
    const double times = -std::floor(share - start + kRounding);
    for (std::size_t i = 0; i < N; ++i) vertex[i] += static_cast<Real>(times * period.vector[i]);
  }
}

/// Interpolates an image at the vertices of a contour, which may be wrapped: then the image continues across the ends
/// of its axes that have a period of the contour.
template <Value T, int N, class Real>
Attribute sample_across_periods(const OwnedImage<T, N>& owned, const Contour<N, Real>& contour, const std::string& name,
                                const std::string& unit, const WorkOptions& work) {
  if (contour.periods.empty()) return sample(owned.view(), contour, name, unit, work);
  OwnedImage<T, N> image = owned;
  Contour<N, Real> at;
  at.vertices = contour.vertices;
  for (const Period<N>& period : contour.periods)
    for (int a = 0; a < N; ++a) {
      const CoveredPeriod covered = covered_period(owned.grid, a, period);
      if (covered.length == 0.0) continue;
      if (covered.needs_one_more) image = with_repeated_samples(image, a, covered.length);
      move_to_samples(image.grid, a, period, at);
    }
  return sample(image.view(), at, name, unit, work);
}

}  // namespace tegl::cli
