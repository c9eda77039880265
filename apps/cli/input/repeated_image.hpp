// SPDX-License-Identifier: BSD-3-Clause
//
// Images on periodic axes, to be sampled at wrapped contours.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "tegl/image.hpp"
#include "tegl/sample.hpp"

namespace tegl::cli {

/// The length of a period along an axis of a grid; 0 if the period is along other axes, or if the axis's samples do not
/// end about one step before it.
template <int N>
double period_of_axis(const Grid<N>& grid, int axis, const Period<N>& period) {
  const auto a = static_cast<std::size_t>(axis);
  if (grid.axes[a].size() < 2) return 0.0;
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
  return apart <= 1e-6 * size && rest > 0.5 * step && rest < 1.5 * step ? std::abs(length) : 0.0;
}

/// The axis with its first sample repeated at the end, one period after it.
inline Axis with_repeated_sample(const Axis& axis, double period) {
  std::vector<double> coordinates;
  for (std::size_t i = 0; i < axis.size(); ++i) coordinates.push_back(axis[i]);
  coordinates.push_back(axis[0] + std::copysign(period, axis[axis.size() - 1] - axis[0]));
  Axis longer = Axis::rectilinear(std::move(coordinates));
  longer.name = axis.name;
  longer.unit = axis.unit;
  return longer;
}

/// The image with its first samples repeated at the end of an axis, one period after them.
template <Value T, int N>
OwnedImage<T, N> with_repeated_samples(const OwnedImage<T, N>& owned, int axis, double period) {
  OwnedImage<T, N> result;
  result.grid = owned.grid;
  Axis& along = result.grid.axes[static_cast<std::size_t>(axis)];
  const std::size_t size = along.size();
  along = with_repeated_sample(along, period);
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
      const double length = period_of_axis(owned.grid, a, period);
      if (length == 0.0) continue;
      image = with_repeated_samples(image, a, length);
      // move the vertices into the period that begins at the image's first sample
      const Axis& axis = image.grid.axes[static_cast<std::size_t>(a)];
      const auto share_of = [&](const auto& x) {
        double share = 0.0;
        for (std::size_t i = 0; i < N; ++i) share += period.dual[i] * static_cast<double>(x[i]);
        return share;
      };
      const auto share_at = [&](double coordinate) {
        std::array<double, N> x = image.grid.offset;
        for (std::size_t i = 0; i < N; ++i) x[i] += image.grid.linear[i][static_cast<std::size_t>(a)] * coordinate;
        return share_of(x);
      };
      const double start = std::min(share_at(axis[0]), share_at(axis[axis.size() - 1]));
      constexpr double kRounding = 4 * static_cast<double>(std::numeric_limits<Real>::epsilon());
      for (auto& vertex : at.vertices) {
        const double times = -std::floor(share_of(vertex) - start + kRounding);
        for (std::size_t i = 0; i < N; ++i) vertex[i] += static_cast<Real>(times * period.vector[i]);
      }
    }
  return sample(image.view(), at, name, unit, work);
}

}  // namespace tegl::cli
