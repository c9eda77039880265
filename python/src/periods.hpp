// SPDX-License-Identifier: BSD-3-Clause
//
// The periods of axes that Python's callers name.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "tegl/periodic.hpp"

namespace tegl::python {

/// The periods of axes: those given, or else of longitudes and by the samples (NaN).
template <int N>
AxisPeriods<N> periods_of(const Grid<N>& grid, const std::vector<int>& axes, const std::vector<double>& given) {
  AxisPeriods<N> periods = sample_periods(grid, axes);
  const AxisPeriods<N> longitudes = longitude_periods(grid);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const auto axis = static_cast<std::size_t>(axes[i]);
    if (longitudes[axis] != 0.0) periods[axis] = longitudes[axis];
    if (!std::isnan(given.at(i))) periods[axis] = given[i];
  }
  return periods;
}

}  // namespace tegl::python
