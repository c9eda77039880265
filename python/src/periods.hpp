// SPDX-License-Identifier: BSD-3-Clause
//
// The periods of axes that Python's callers name.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "tegl/curved.hpp"
#include "tegl/periodic.hpp"

namespace tegl::python {

/// A view of an image without the samples at the end of these axes that repeat the first ones. `given`: as below.
template <Value T, int N>
Image<T, N> periodic_samples(const Image<T, N>& image, const std::vector<int>& axes, const std::vector<double>& given) {
  return without_repeated<T, N>(image, {}, axes, given).image;
}

/// The periods of axes: those given, or else `default_periods` (NaN).
template <int N>
AxisPeriods<N> periods_of(const Grid<N>& grid, const std::vector<int>& axes, const std::vector<double>& given) {
  AxisPeriods<N> periods{};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::span one(&axes[i], 1);
    periods.at(static_cast<std::size_t>(axes[i])) =
        std::isnan(given.at(i)) ? default_periods<N>(grid, one)[static_cast<std::size_t>(axes[i])] : given[i];
  }
  return periods;
}

}  // namespace tegl::python
