// SPDX-License-Identifier: BSD-3-Clause
//
// Axes of a grid: construction with validation, and parts.
#include "tegl/grid.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tegl {

Axis Axis::uniform(std::size_t size, double origin, double step) {
  if (size == 0) throw Error(ErrorCode::InvalidGrid, "axis of 0 samples; expected at least 1");
  if (!std::isfinite(origin) || !std::isfinite(step) || step == 0.0)
    throw Error(
        ErrorCode::InvalidGrid,
        fmt::format("axis with origin {} and step {}; expected finite values and a step other than 0", origin, step));
  Axis axis;
  axis.size_ = size;
  axis.origin_ = origin;
  axis.step_ = step;
  return axis;
}

Axis Axis::rectilinear(std::vector<double> coordinates) {
  if (coordinates.empty()) throw Error(ErrorCode::InvalidGrid, "axis of 0 samples; expected at least 1");
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (!std::isfinite(coordinates[i]))
      throw Error(ErrorCode::InvalidGrid,
                  fmt::format("axis coordinate {} is {}; expected a finite value", i, coordinates[i]));
  const bool descending = coordinates.size() > 1 && coordinates[1] < coordinates[0];
  for (std::size_t i = 1; i < coordinates.size(); ++i)
    if (coordinates[i] == coordinates[i - 1] || (coordinates[i] < coordinates[i - 1]) != descending)
      throw Error(ErrorCode::InvalidGrid,
                  fmt::format("axis coordinates {} and {} are {} and {}; expected strictly {} coordinates", i - 1, i,
                              coordinates[i - 1], coordinates[i], descending ? "descending" : "ascending"));
  Axis axis;
  axis.size_ = coordinates.size();
  axis.coordinates_ = std::move(coordinates);
  return axis;
}

double Axis::step() const noexcept {
  if (coordinates_.empty()) return step_;
  if (size_ < 2) return 1.0;
  return (coordinates_.back() - coordinates_.front()) / static_cast<double>(size_ - 1);
}

Axis Axis::part(std::size_t first, std::size_t count) const {
  if (count == 0 || first >= size_ || count > size_ - first)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("samples [{}, {} + {}) of an axis of {}", first, first, count, size_));
  // Stored explicitly, so that the part's coordinates equal the whole's bit by bit.
  std::vector<double> coordinates(count);
  for (std::size_t i = 0; i < count; ++i) coordinates[i] = (*this)[first + i];
  if (count == 1 && is_uniform()) {
    Axis axis = uniform(1, coordinates[0], step_);
    axis.name = name;
    axis.unit = unit;
    return axis;
  }
  Axis axis = rectilinear(std::move(coordinates));
  axis.name = name;
  axis.unit = unit;
  return axis;
}

}  // namespace tegl
