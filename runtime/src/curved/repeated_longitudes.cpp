// SPDX-License-Identifier: BSD-3-Clause
//
// Samples that repeat the first ones of their axis a full turn further, as global ocean grids have them in one or two
// columns, and images without them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "curved/curved_map.hpp"
#include "periodic/periods.hpp"
#include "tegl/curved.hpp"
#include "tegl/error.hpp"

namespace tegl {
namespace {

using detail::kTurn;
/// Of a coordinate: the rounding of single precision, in which files may have coordinates.
constexpr double kSingleRounding = 0x1p-22;
/// Of a period's product with the scale of the world map.
constexpr double kProductRounding = 1e-9;

template <int N>
using SampleIndex = std::type_identity_t<std::array<std::size_t, N>>;  // N is deduced from the image

bool is_along(const CurvedAxis& one, int axis) { return (one.along >> axis & 1u) != 0; }

/// Coordinates along an axis, row by row: i of row r is `one[first(r) + i * step]`.
struct Rows {
  std::size_t step = 1, size = 0, count = 0;
  [[nodiscard]] std::size_t first(std::size_t row) const { return row / step * step * size + row % step; }
};

template <int N>
Rows rows_along(const CurvedAxis& one, const Grid<N>& grid, int axis) {
  Rows rows;
  rows.size = grid.axes[axis].size();
  for (int a = 0; a < axis; ++a) rows.step *= is_along(one, a) ? grid.axes[a].size() : 1;
  rows.count = one.size() / rows.size;
  return rows;
}

/// The first i for which the coordinate i is a turn from the coordinate 0; `size` if there is none.
template <class Coordinate>
std::size_t first_after_turn(std::size_t size, const Coordinate& coordinate) {
  if (size < 2 || !std::isfinite(coordinate(0))) return size;
  for (std::size_t i = 1; i < size; ++i) {
    const double length = std::abs(coordinate(i) - coordinate(0)), step = kTurn / static_cast<double>(i);
    if (std::abs(length - kTurn) <= std::max(1e-3 * step, kTurn * kSingleRounding)) return i;
  }
  return size;
}

/// Whether the coordinates at the end of a row repeat the first ones, to a tolerance, of which `beyond(difference)` is
/// beyond zero.
template <class Coordinate, class Beyond>
bool is_repeated(std::size_t size, std::size_t period, double tolerance, const Coordinate& coordinate,
                 const Beyond& beyond) {
  for (std::size_t i = 0; i + period < size; ++i) {
    const double first = coordinate(i), repeated = coordinate(i + period);
    if (std::isfinite(first) != std::isfinite(repeated)) return false;
    if (std::isfinite(first) && !(std::abs(beyond(repeated - first)) <= tolerance)) return false;
  }
  return true;
}

double tolerance_of_longitudes(std::size_t period) {
  return std::max(1e-3 * kTurn / static_cast<double>(period), kTurn * kSingleRounding);
}

auto coordinates_of_row(const CurvedAxis& one, const Rows& rows, std::size_t row) {
  return [&one, first = rows.first(row), step = rows.step](std::size_t i) { return one[first + i * step]; };
}

/// Whether all coordinates at the end of an axis repeat those of the first samples: longitudes by turns, others
/// equally. Where a tripolar grid is folded, longitudes run there and back, so they are no turn further.
/// `period`: the number of samples after which they repeat.
template <int N>
bool is_repeated(const Grid<N>& grid, const CurvedAxis& one, int axis, std::size_t period) {
  const Rows rows = rows_along(one, grid, axis);
  const bool is_longitude = is_longitude_unit(one.unit);
  double tolerance = tolerance_of_longitudes(period);
  if (!is_longitude) {
    double most = 0.0;
    for (std::size_t i = 0; i < one.size(); ++i)
      if (std::isfinite(one[i])) most = std::max(most, std::abs(one[i]));
    tolerance = kSingleRounding * most;
  }
  const auto beyond = [=](double difference) { return is_longitude ? std::remainder(difference, kTurn) : difference; };
  for (std::size_t r = 0; r < rows.count; ++r)
    if (!is_repeated(rows.size, period, tolerance, coordinates_of_row(one, rows, r), beyond)) return false;
  return true;
}

/// The number of samples along an axis of longitudes after which they are a turn further and repeat, by its own
/// coordinates or by a row of curved ones; the axis's size if there is none.
template <int N>
std::size_t period_in_samples(const Grid<N>& grid, std::span<const CurvedAxis> curved, int axis) {
  const std::size_t size = grid.axes[axis].size();
  for (const CurvedAxis& one : curved) {
    if (!is_along(one, axis) || !is_longitude_unit(one.unit)) continue;
    const Rows rows = rows_along(one, grid, axis);
    std::size_t refused = size;
    for (std::size_t r = 0; r < rows.count; ++r) {
      const std::size_t period = first_after_turn(size, coordinates_of_row(one, rows, r));
      if (period == size || period == refused) continue;
      if (is_repeated(grid, one, axis, period)) return period;
      refused = period;
    }
    return size;
  }
  const bool is_curved =
      std::any_of(curved.begin(), curved.end(), [&](const CurvedAxis& one) { return one.axis == axis; });
  if (is_curved || !is_longitude_unit(grid.axes[axis].unit)) return size;
  const std::optional<Axis> own = detail::axis_in_world(grid, axis);
  if (!own) return size;
  const auto coordinate = [&](std::size_t i) { return (*own)[i]; };
  const std::size_t period = first_after_turn(size, coordinate);
  if (period == size) return size;
  const auto beyond_turn = [turn = own->is_descending() ? -kTurn : kTurn](double difference) {
    return difference - turn;
  };
  return is_repeated(size, period, tolerance_of_longitudes(period), coordinate, beyond_turn) ? period : size;
}

/// The next sample in memory, of those from `first` on along an axis; false behind the last one.
template <Value T, int N>
bool advance(const Image<T, N>& image, SampleIndex<N>& index, std::size_t axis = 0, std::size_t first = 0) {
  for (std::size_t a = 0; a < N; ++a) {
    if (++index[a] < image.size(static_cast<int>(a))) return true;
    index[a] = a == axis ? first : 0;
  }
  return false;
}

/// How far two values of samples at the same place may be apart: a formula of their coordinates may have other rounding
/// a turn further. 0 for integers.
template <Value T, int N>
double tolerance_of_values(const Image<T, N>& ends) {
  if constexpr (!std::is_floating_point_v<T>) return 0.0;
  double most = 0.0;
  SampleIndex<N> index{};
  for (bool more = true; more; more = advance(ends, index)) {
    const auto value = std::abs(static_cast<double>(ends(index)));
    if (std::isfinite(value)) most = std::max(most, value);
  }
  return (sizeof(T) == sizeof(float) ? 1e-6 : 1e-12) * most;
}

/// The first sample in memory among the last `count` ones along an axis whose value is not the one that it repeats.
template <Value T, int N>
std::optional<SampleIndex<N>> first_other_value(const Image<T, N>& image, int axis, std::size_t count) {
  const auto along = static_cast<std::size_t>(axis);
  const std::size_t period = image.size(axis) - count;
  SampleIndex<N> index{};
  index[along] = period;
  std::optional<double> tolerance;  // unless all are equal
  do {
    SampleIndex<N> first = index;
    first[along] -= period;
    const T one = image(first), other = image(index);
    if (one == other || (one != one && other != other)) continue;  // NaN does not equal itself
    if (!tolerance)
      tolerance = std::max(tolerance_of_values<T, N>(image.part(axis, 0, count)),
                           tolerance_of_values<T, N>(image.part(axis, period, count)));
    const double apart = std::abs(static_cast<double>(one) - static_cast<double>(other));
    if (*tolerance == 0.0 || !(apart <= *tolerance)) return index;
  } while (advance(image, index, along, period));
  return std::nullopt;
}

template <Value T, int N>
[[noreturn]] void refuse_other_value(const Image<T, N>& image, int axis, std::size_t count,
                                     const SampleIndex<N>& index) {
  SampleIndex<N> first = index;
  first[static_cast<std::size_t>(axis)] -= image.size(axis) - count;
  const std::string last = count == 1 ? "sample" : fmt::format("{} samples", count);
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("the last {} along {} {} at the longitudes of the first, 360 degrees further, but with other "
                          "values: {} at the sample ({}), {} at the sample ({}); expected equal values, or an image "
                          "without the last {}",
                          last, detail::label_of_axis(image.grid().axes[axis], axis), count == 1 ? "is" : "are",
                          image(index), fmt::join(index, ", "), image(first), fmt::join(first, ", "), last));
}

/// The coordinates without the last `count` samples along an axis.
template <int N>
void leave_out(std::vector<CurvedAxis>& curved, const Grid<N>& grid, int axis, std::size_t count) {
  std::vector<std::size_t> of_points;
  std::vector<CurvedAxis> side_by_side;
  for (std::size_t c = 0; c < curved.size(); ++c) {
    CurvedAxis& one = curved[c];
    if (!is_along(one, axis)) continue;
    const Rows rows = rows_along(one, grid, axis);
    const std::size_t block = rows.step * rows.size, left = rows.step * (rows.size - count);
    std::vector<double> values;
    values.reserve(one.size() / rows.size * (rows.size - count));
    for (std::size_t first = 0; first < one.size(); first += block)
      for (std::size_t i = first; i < first + left; ++i) values.push_back(one[i]);
    const bool is_of_points = one.values.empty();
    one.values = std::move(values);
    one.points = {};
    if (!is_of_points) continue;
    of_points.push_back(c);
    side_by_side.push_back(std::move(one));
  }
  side_by_side = by_points(std::move(side_by_side));
  for (std::size_t i = 0; i < of_points.size(); ++i) curved[of_points[i]] = std::move(side_by_side[i]);
}

/// Leaves out what an axis repeats, if `has_equal_values(image, axis, count)`. `period`: a given one, or NaN.
template <Value T, int N, class HasEqualValues>
void leave_out_repeated(WithoutRepeated<T, N>& result, int axis, double period,
                        const HasEqualValues& has_equal_values) {
  const std::size_t count = repeated_longitudes<N>(result.image.grid(), result.curved, axis, period);
  if (count == 0 || !has_equal_values(result.image, axis, count)) return;
  leave_out(result.curved, result.image.grid(), axis, count);
  result.image = result.image.part(axis, 0, result.image.size(axis) - count);
  result.left_out[static_cast<std::size_t>(axis)] = count;
}

}  // namespace

template <int N>
requires DimensionBetween<N, 2, 5> std::size_t repeated_longitudes(const Grid<N>& grid,
                                                                   std::span<const CurvedAxis> curved, int axis,
                                                                   double given) {
  if (axis < 0 || axis >= N)
    throw Error(ErrorCode::InvalidGrid, fmt::format("longitudes along axis {}; expected 0 to {}", axis, N - 1));
  if constexpr (N == 5) {
    if (!curved.empty()) throw Error(ErrorCode::InvalidGrid, "a curved grid in 5D; expected 2 to 4 dimensions");
  } else {
    if (!curved.empty()) detail::require_curved<N>(grid, curved);
  }
  if (!std::isnan(given) && !(std::abs(std::abs(given * grid.linear[axis][axis]) - kTurn) <= kProductRounding * kTurn))
    return 0;
  const std::size_t size = grid.axes[axis].size(), period = period_in_samples(grid, curved, axis);
  if (period < 3 || period >= size) return 0;  // fewer samples are no periodic axis
  for (const CurvedAxis& one : curved)
    if (is_along(one, axis) && !is_repeated(grid, one, axis, period)) return 0;
  return size - period;
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> WithoutRepeated<T, N> without_repeated(const Image<T, N>& image,
                                                                          std::span<const CurvedAxis> curved,
                                                                          std::span<const int> axes,
                                                                          std::span<const double> periods) {
  WithoutRepeated<T, N> result{image, {curved.begin(), curved.end()}};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double period = i < periods.size() ? periods[i] : std::numeric_limits<double>::quiet_NaN();
    leave_out_repeated(result, axes[i], period, [](const Image<T, N>& whole, int along, std::size_t count) {
      const auto other = first_other_value(whole, along, count);
      if (other) refuse_other_value(whole, along, count, *other);
      return true;
    });
  }
  return result;
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> std::vector<int> longitude_axes(const Image<T, N>& image,
                                                                   std::span<const CurvedAxis> curved) {
  bool is_longer = false;
  for (int axis = 0; axis < N && !is_longer; ++axis) is_longer = repeated_longitudes<N>(image.grid(), curved, axis) > 0;
  if (!is_longer) return longitude_axes<N>(image.grid(), curved);
  WithoutRepeated<T, N> result{image, {curved.begin(), curved.end()}};
  for (int axis = 0; axis < N; ++axis)
    leave_out_repeated(
        result, axis, std::numeric_limits<double>::quiet_NaN(),
        [](const Image<T, N>& whole, int along, std::size_t count) { return !first_other_value(whole, along, count); });
  return longitude_axes<N>(result.image.grid(), result.curved);
}

#define TEGL_INSTANTIATE_GRIDS(N) \
  template std::size_t repeated_longitudes<N>(const Grid<N>&, std::span<const CurvedAxis>, int, double);
TEGL_INSTANTIATE_GRIDS(2)
TEGL_INSTANTIATE_GRIDS(3)
TEGL_INSTANTIATE_GRIDS(4)
TEGL_INSTANTIATE_GRIDS(5)
#undef TEGL_INSTANTIATE_GRIDS
#define TEGL_INSTANTIATE_DIMENSIONS(T, N)                                                                \
  template WithoutRepeated<T, N> without_repeated<T, N>(const Image<T, N>&, std::span<const CurvedAxis>, \
                                                        std::span<const int>, std::span<const double>);  \
  template std::vector<int> longitude_axes<T, N>(const Image<T, N>&, std::span<const CurvedAxis>);
#include "base/instantiate.hpp"

}  // namespace tegl
