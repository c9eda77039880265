// SPDX-License-Identifier: BSD-3-Clause
//
// Periods of axes: of samples, of longitudes, and in the world.
#include "periodic/periods.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/LU>

#include "base/periods.hpp"
#include "periodic/periodic_layers.hpp"
#include "tegl/eigen.hpp"
#include "tegl/error.hpp"
#include "tegl/stream.hpp"

namespace tegl {
namespace {

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorCode::InvalidArgument, message); }

double length_of(const Axis& axis) { return std::abs(axis[axis.size() - 1] - axis[0]); }

void require_samples(const Axis& axis, int a) {
  if (axis.size() < 3)
    refuse(fmt::format("{} is periodic and has {} samples; expected at least 3", detail::label_of_axis(axis, a),
                       axis.size()));
}

/// A number in a message with six significant digits, or as many more as it takes to differ from `other`.
std::string text_apart(double value, double other) {
  for (int digits = 6; digits < std::numeric_limits<double>::max_digits10; ++digits)
    if (std::string text = fmt::format("{:.{}g}", value, digits); text != fmt::format("{:.{}g}", other, digits))
      return text;
  return fmt::format("{}", value);
}

void check_period(const Axis& axis, int a, double period) {
  if (!std::isfinite(period) || period < 0.0)
    refuse(fmt::format("the period of {} is {}; expected a positive number, or 0 if it is not periodic",
                       detail::label_of_axis(axis, a), period));
  require_samples(axis, a);
  if (!(period > length_of(axis)))
    refuse(fmt::format("the period of {} is {}; expected more than {}, the distance between its first and last sample",
                       detail::label_of_axis(axis, a), text_apart(period, length_of(axis)),
                       text_apart(length_of(axis), period)));
}

bool is_longitude(const Axis& axis) {
  constexpr double kTolerance = 1e-3;  // of a step: coordinates in files may be of single precision
  if (axis.size() < 3 || !is_longitude_unit(axis.unit)) return false;
  const double step = (axis[axis.size() - 1] - axis[0]) / static_cast<double>(axis.size() - 1);
  for (std::size_t i = 1; i < axis.size(); ++i)
    if (std::abs(axis[i] - axis[i - 1] - step) > kTolerance * std::abs(step)) return false;
  const double count = static_cast<double>(axis.size());
  // At half a step and more, a sample would be missing or repeated. On fine axes this is less than the tolerance.
  return std::abs(std::abs(step) * count - detail::kTurn) < std::min(kTolerance * count, 0.5) * std::abs(step);
}

}  // namespace

template <int N>
requires DimensionBetween<N, 2, 5> AxisPeriods<N> sample_periods(const Grid<N>& grid, std::span<const int> axes) {
  AxisPeriods<N> periods{};
  for (const int a : axes) {
    if (a < 0 || a >= N) refuse(fmt::format("axis {} is periodic; expected 0 to {}", a, N - 1));
    const Axis& axis = grid.axes[static_cast<std::size_t>(a)];
    require_samples(axis, a);
    const auto size = static_cast<double>(axis.size());
    periods[static_cast<std::size_t>(a)] =
        axis.is_uniform() ? size * std::abs(axis.step()) : length_of(axis) * size / (size - 1);
  }
  return periods;
}

template <int N>
requires DimensionBetween<N, 2, 5> AxisPeriods<N> longitude_periods(const Grid<N>& grid) {
  AxisPeriods<N> periods{};
  for (int a = 0; a < N; ++a) {
    if (!is_longitude_unit(grid.axes[a].unit)) continue;
    const std::optional<Axis> axis = detail::axis_in_world(grid, a);
    if (axis && is_longitude(*axis)) periods[a] = detail::kTurn / std::abs(grid.linear[a][a]);
  }
  return periods;
}

bool is_longitude_unit(std::string_view unit) noexcept {
  constexpr std::array<std::string_view, 6> kUnits = {"degrees_east", "degree_east", "degree_E",
                                                      "degrees_E",    "degreeE",     "degreesE"};
  return std::find(kUnits.begin(), kUnits.end(), unit) != kUnits.end();
}

Axis longer_axis(const Axis& axis, double period) { return detail::wrapped_axis(axis, period, 0, 1); }

namespace detail {

std::string label_of_axis(const Axis& axis, int number) {
  const std::string name = axis.name.empty() ? std::string(1, "xyztu"[number]) : axis.name;
  return fmt::format("axis {} ({})", number, name);
}

template <int N>
std::optional<Axis> axis_in_world(const Grid<N>& grid, int axis) {
  constexpr double kRounding = 1e-6;  // beside the axis's own coordinate
  const double scale = grid.linear[axis][axis], first = grid.offset[axis];
  for (int a = 0; a < N; ++a)
    if (!(scale != 0.0 && (a == axis || std::abs(grid.linear[a][axis]) <= kRounding * std::abs(scale))))
      return std::nullopt;
  const Axis& own = grid.axes[axis];
  if (scale == 1.0 && first == 0.0) return own;
  Axis moved;
  if (own.is_uniform()) {
    moved = Axis::uniform(own.size(), scale * own[0] + first, scale * own.step());
  } else {
    std::vector<double> coordinates(own.size());
    for (std::size_t i = 0; i < own.size(); ++i) coordinates[i] = scale * own[i] + first;
    moved = Axis::rectilinear(std::move(coordinates));
  }
  moved.name = own.name;
  moved.unit = own.unit;
  return moved;
}

std::string too_long_steps(const Axis& axis, int number, double period, int steps) {
  constexpr double kBelow = 1e-6;  // so much less than half that the rounding of vertices to float makes no difference
  const std::size_t count = axis.size(), apart = static_cast<std::size_t>(steps);
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_across = i + apart >= count;
    const double turn = axis.is_descending() ? -period : period;
    const double to = is_across ? axis[i + apart - count] + turn : axis[i + apart];
    const double length = std::abs(to - axis[i]);
    if (length < (0.5 - kBelow) * period) continue;
    const std::string start = fmt::format("the period of {} is {}, and ", label_of_axis(axis, number), period);
    if (steps > 1)
      return start + fmt::format(
                         "two steps, from {} to {}, are {}; expected two steps of less than half the period, "
                         "as cells extend over two",
                         axis[i], to, length);
    const double span = length_of(axis), likely = span + span / static_cast<double>(count - 1);
    if (!is_across) {
      const bool is_default = !is_longitude_unit(axis.unit) && std::abs(period - likely) <= 1e-12 * likely;
      return fmt::format(
          "the period of {} is {}{}, and the step from {} to {} is {}; expected steps of less than half "
          "the period",
          label_of_axis(axis, number), period, is_default ? " (length plus mean step)" : "", axis[i], to, length);
    }
    return start + fmt::format(
                       "the step across the seam, from {} to {}, is {}; expected steps of less than half the "
                       "period, or a period in the unit of the axis, such as {:.6g}",
                       axis[i], to, length, likely);
  }
  return {};
}

template <int N>
void check_periods(const Grid<N>& grid, const AxisPeriods<N>& periods, const ExtractOptions& options) {
  for (int a = 0; a < N; ++a) {
    if (periods[a] == 0.0) continue;
    check_period(grid.axes[a], a, periods[a]);
    if (N == 5) continue;  // vertices of divisions are right nevertheless
    if (const std::string reason = too_long_steps(grid.axes[a], a, periods[a]); !reason.empty()) refuse(reason);
  }
  if (std::all_of(periods.begin(), periods.end(), [](double period) { return period == 0.0; }))
    refuse("no axis is periodic; expected a period that is not 0");
  if (options.ambiguity == Ambiguity::custom)
    refuse("Ambiguity::custom with periodic axes; expected another: a custom estimator may read samples at the border");
}

template <int N>
void require_range(const Period<N>& period, const std::string& axis) {
  double square = 0.0, of_dual = 0.0;
  for (int a = 0; a < N; ++a) {
    square += period.vector[a] * period.vector[a];
    of_dual += period.dual[a] * period.dual[a];
  }
  if (std::isnormal(square) && std::isnormal(of_dual) && std::isfinite(period.start)) return;
  throw Error(ErrorCode::InvalidGrid,
              fmt::format("the period of {} is the vector ({:.6g}) in space; expected a length from 1e-150 to 1e150, "
                          "whose square double represents, and a first sample not too far away",
                          axis, fmt::join(period.vector, ", ")));
}

template <int N>
std::vector<Period<N>> world_periods(const Grid<N>& grid, const AxisPeriods<N>& periods) {
  const Eigen::Matrix<double, N, N> linear = as_eigen(grid.linear);
  const Eigen::Matrix<double, N, N> inverse = linear.inverse();
  Vector<N> first = grid.offset;  // world coordinates of the first sample
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < N; ++b) first[a] += grid.linear[a][b] * grid.axes[b][0];
  std::vector<Period<N>> result;
  for (int b = 0; b < N; ++b) {
    if (periods[b] == 0.0) continue;
    const double length = grid.axes[b].is_descending() ? -periods[b] : periods[b];
    Period<N>& period = result.emplace_back();
    for (int a = 0; a < N; ++a) {
      period.vector[a] = grid.linear[a][b] * length;
      period.dual[a] = inverse(b, a) / length;
    }
    period.start = share_of(period, first);
    require_range(period, label_of_axis(grid.axes[b], b));
  }
  return result;
}

#define TEGL_INSTANTIATE_PERIODS(N)                                                             \
  template std::optional<Axis> axis_in_world<N>(const Grid<N>&, int);                           \
  template void require_range<N>(const Period<N>&, const std::string&);                         \
  template void check_periods<N>(const Grid<N>&, const AxisPeriods<N>&, const ExtractOptions&); \
  template std::vector<Period<N>> world_periods<N>(const Grid<N>&, const AxisPeriods<N>&);
TEGL_INSTANTIATE_PERIODS(2)
TEGL_INSTANTIATE_PERIODS(3)
TEGL_INSTANTIATE_PERIODS(4)
TEGL_INSTANTIATE_PERIODS(5)
#undef TEGL_INSTANTIATE_PERIODS

}  // namespace detail

template <int N>
requires DimensionBetween<N, 2, 4> std::vector<Period<N>> contour_periods(const Grid<N>& grid,
                                                                          const AxisPeriods<N>& periods) {
  return detail::world_periods(grid, periods);
}

#define TEGL_INSTANTIATE_PERIODS(N)                                                \
  template AxisPeriods<N> sample_periods<N>(const Grid<N>&, std::span<const int>); \
  template AxisPeriods<N> longitude_periods<N>(const Grid<N>&);
TEGL_INSTANTIATE_PERIODS(2)
TEGL_INSTANTIATE_PERIODS(3)
TEGL_INSTANTIATE_PERIODS(4)
TEGL_INSTANTIATE_PERIODS(5)
#undef TEGL_INSTANTIATE_PERIODS
template std::vector<Period<2>> contour_periods<2>(const Grid<2>&, const AxisPeriods<2>&);
template std::vector<Period<3>> contour_periods<3>(const Grid<3>&, const AxisPeriods<3>&);
template std::vector<Period<4>> contour_periods<4>(const Grid<4>&, const AxisPeriods<4>&);

}  // namespace tegl
