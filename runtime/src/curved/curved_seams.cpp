// SPDX-License-Identifier: BSD-3-Clause
#include "curved/curved_seams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <Eigen/LU>

#include "base/periods.hpp"
#include "curved/curved_map.hpp"
#include "periodic/periodic_layers.hpp"
#include "periodic/periods.hpp"

namespace tegl {
namespace detail {

namespace {

template <int N>
std::size_t size_along(const CurvedAxis& one, const Grid<N>& grid, int first, int end) {
  std::size_t size = 1;
  for (int a = first; a < end; ++a) size *= (one.along >> a & 1u) != 0 ? grid.axes[a].size() : 1;
  return size;
}

bool is_axis_curved(std::span<const CurvedAxis> curved, int axis) {
  return std::any_of(curved.begin(), curved.end(), [&](const CurvedAxis& one) { return one.axis == axis; });
}

template <int N>
void require_seams(const Grid<N>& grid, std::span<const CurvedAxis> curved, std::span<const CurvedSeam<N>> seams) {
  require_curved<N>(grid, curved);
  const auto fail = [](const std::string& text) { throw Error(ErrorCode::InvalidGrid, text); };
  unsigned seen = 0;
  for (const CurvedSeam<N>& seam : seams) {
    if (seam.axis < 0 || seam.axis >= N)
      fail(fmt::format("a seam of axis {}; expected an axis from 0 to {}", seam.axis, N - 1));
    if ((seen >> seam.axis & 1u) != 0) fail(fmt::format("two seams of axis {}; expected one", seam.axis));
    seen |= 1u << seam.axis;
    for (int c = 0; c < N; ++c) {
      const double x = seam.vector[c];
      const bool is_straight = !is_axis_curved(curved, c);
      if (!std::isfinite(x))
        fail(fmt::format("the seam of axis {} has the vector component {}; expected a finite number", seam.axis, x));
      if (is_straight && c == seam.axis && x == 0.0)
        fail(fmt::format("the seam of axis {}, which is not curved, has the period 0; expected another", c));
      bool may_differ = is_straight && c == seam.axis;
      for (const CurvedAxis& one : curved)
        may_differ = may_differ || (one.axis == c && (one.along >> seam.axis & 1u) != 0);
      if (x != 0.0 && !may_differ)
        fail(fmt::format("the seam of axis {} has {} along coordinate {}, which does not differ along it; expected 0",
                         seam.axis, x, c));
    }
  }
}

/// Continues the coordinates of some axes, whose numbers are side by side in memory, across a seam.
template <int N>
void continue_together(const CurvedSeam<N>& seam, const Grid<N>& grid, std::span<CurvedAxis* const> axes) {
  const CurvedAxis& first = *axes.front();
  std::array<double, CurvedPoints::kMostColumns> added{};
  for (std::size_t column = 0; column < axes.size(); ++column) added[column] = seam.vector[axes[column]->axis];
  const std::size_t row = size_along(first, grid, 0, seam.axis), block = row * grid.axes[seam.axis].size();
  const auto in_place = [&](const auto* numbers) {
    return CurvedPoints::in_place(numbers + first.column, first.size(), axes.size(), first.points.pitch());
  };
  const CurvedPoints points =
      first.points.floats() != nullptr ? in_place(first.points.floats()) : in_place(first.points.doubles());
  const CurvedPoints continued = points.continued(row, block, added);
  for (std::size_t column = 0; column < axes.size(); ++column) {
    axes[column]->points = continued;
    axes[column]->column = static_cast<unsigned>(column);
  }
}

/// Continues coordinates that are stored by points across a seam; those that are side by side in memory remain so,
/// whether they are columns of one object or each is an object of its own.
template <int N>
void continue_points(const CurvedSeam<N>& seam, LongerCurved<N>& longer) {
  const auto are_floats = [](const CurvedAxis* one) { return one->points.floats() != nullptr; };
  std::vector<CurvedAxis*> axes;
  for (CurvedAxis& one : longer.curved)
    if ((one.along >> seam.axis & 1u) != 0 && one.values.empty()) axes.push_back(&one);
  std::sort(axes.begin(), axes.end(),
            [](const CurvedAxis* a, const CurvedAxis* b) { return first_address(*a) < first_address(*b); });
  for (std::size_t begin = 0, end = 0; begin < axes.size(); begin = end) {
    const CurvedAxis* const first = axes[begin];
    const std::size_t bytes = are_floats(first) ? sizeof(float) : sizeof(double), pitch = first->points.pitch();
    const std::size_t most = std::min(pitch, CurvedPoints::kMostColumns);
    const auto follows = [&](const CurvedAxis* one) {
      return are_floats(one) == are_floats(first) && one->points.pitch() == pitch && one->along == first->along &&
             first_address(*one) == first_address(*first) + bytes * (end - begin);
    };
    for (end = begin + 1; end < axes.size() && end - begin < most && follows(axes[end]);) ++end;
    continue_together<N>(seam, longer.grid, std::span(axes).subspan(begin, end - begin));
  }
}

}  // namespace

template <int N>
LongerCurved<N> longer_curved(const Grid<N>& grid, std::span<const CurvedAxis> curved,
                              std::span<const CurvedSeam<N>> seams) {
  require_seams<N>(grid, curved, seams);
  LongerCurved<N> longer{grid, {curved.begin(), curved.end()}};
  for (const CurvedSeam<N>& seam : seams) {
    for (CurvedAxis& one : longer.curved) {
      if ((one.along >> seam.axis & 1u) == 0) continue;
      // slices across the axis are runs of `row` values, one run for each step along the axes behind
      const std::size_t row = size_along(one, longer.grid, 0, seam.axis);
      const std::size_t block = row * longer.grid.axes[seam.axis].size();
      if (one.values.empty()) continue;
      std::vector<double> values;
      values.reserve(one.values.size() / block * (block + row));
      for (std::size_t first = 0; first < one.values.size(); first += block) {
        const auto from = one.values.begin() + static_cast<std::ptrdiff_t>(first);
        values.insert(values.end(), from, from + static_cast<std::ptrdiff_t>(block));
        for (std::size_t i = 0; i < row; ++i) values.push_back(one.values[first + i] + seam.vector[one.axis]);
      }
      one.values = std::move(values);
    }
    continue_points(seam, longer);
    Axis& axis = longer.grid.axes[seam.axis];
    if (is_axis_curved(curved, seam.axis)) {
      Axis indices = Axis::uniform(axis.size() + 1);
      indices.name = axis.name;
      indices.unit = axis.unit;
      axis = std::move(indices);
    } else {
      axis = wrapped_axis(axis, std::abs(seam.vector[seam.axis]), 0, 1);
    }
  }
  return longer;
}

template <int N>
std::vector<Period<N>> periods_of_seams(const Grid<N>& grid, std::span<const CurvedAxis> curved,
                                        std::span<const CurvedSeam<N>> seams) {
  std::vector<Period<N>> periods;
  for (const CurvedSeam<N>& seam : seams)
    if (seam.vector != Vector<N>{}) periods.push_back({seam.vector, {}, 0});
  if (periods.empty()) return periods;
  // the dual vectors in the space of the vectors
  Eigen::MatrixXd vectors(N, static_cast<Eigen::Index>(periods.size()));
  for (std::size_t p = 0; p < periods.size(); ++p)
    for (int c = 0; c < N; ++c) vectors(c, static_cast<Eigen::Index>(p)) = periods[p].vector[c];
  const Eigen::MatrixXd gram = vectors.transpose() * vectors;
  const Eigen::FullPivLU<Eigen::MatrixXd> solver(gram);
  if (!solver.isInvertible())
    throw Error(ErrorCode::InvalidGrid, "the vectors of the seams are dependent; expected independent ones");
  const Eigen::MatrixXd duals = vectors * solver.inverse();
  for (std::size_t p = 0; p < periods.size(); ++p)
    for (int c = 0; c < N; ++c) {
      const double dual = periods[p].dual[c] = duals(c, static_cast<Eigen::Index>(p));
      double least = std::numeric_limits<double>::infinity();
      const auto add = [&](double x) { least = std::isfinite(x) ? std::min(least, dual * x) : least; };
      for (const CurvedAxis& one : curved)
        for (std::size_t i = 0; one.axis == c && i < one.size(); ++i) add(one[i]);
      if (!is_axis_curved(curved, c))
        for (std::size_t i = 0; i < grid.axes[c].size(); ++i) add(grid.axes[c][i]);
      if (std::isfinite(least)) periods[p].start += least;
    }
  for (const Period<N>& period : periods) require_range(period, "a seam");
  return periods;
}

}  // namespace detail

template <int N>
requires DimensionBetween<N, 2, 4> AxisPeriods<N> index_periods(const Grid<N>& grid, std::span<const CurvedAxis> curved,
                                                                const CurvedSeams<N>& seams) {
  detail::require_seams<N>(grid, curved, seams);
  AxisPeriods<N> periods{};
  for (const CurvedSeam<N>& seam : seams)
    periods[seam.axis] = detail::is_axis_curved(curved, seam.axis) ? static_cast<double>(grid.axes[seam.axis].size())
                                                                   : std::abs(seam.vector[seam.axis]);
  return periods;
}

namespace {

/// The turns in a step between neighbours. Beside a pole within the grid, longitudes begin again along a line: there,
/// neighbours are about a turn apart. 0 for unknown ones.
double turns_of_step(double step) { return std::isfinite(step) ? std::nearbyint(step / detail::kTurn) : 0.0; }

/// The last coordinate along axis `a` less the first one, of each row in which both are known; of longitudes without
/// the turns of single steps.
template <int N>
std::vector<double> growths_of_rows(const Grid<N>& grid, const CurvedAxis& one, int a) {
  const bool is_longitude = is_longitude_unit(one.unit);
  const std::size_t row = detail::size_along(one, grid, 0, a), block = row * grid.axes[a].size();
  std::vector<double> growths;
  growths.reserve(one.size() / grid.axes[a].size());
  for (std::size_t first = 0; first < one.size(); first += block)
    for (std::size_t i = 0; i < row; ++i) {
      double growth = one[first + block - row + i] - one[first + i];
      if (!std::isfinite(growth)) continue;
      for (std::size_t at = first + i; is_longitude && at + row < first + block; at += row)
        growth -= detail::kTurn * turns_of_step(one[at + row] - one[at]);
      growths.push_back(growth);
    }
  return growths;
}

/// NaN of no numbers.
double mean_of(std::span<const double> numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), 0.0) / static_cast<double>(numbers.size());
}

/// The mean of `growths_of_rows`; NaN if none are known.
template <int N>
double mean_growth(const Grid<N>& grid, const CurvedAxis& one, int a) {
  return mean_of(growths_of_rows(grid, one, a));
}

/// Whether the coordinates along axis `a` grow by a full turn from the first one to one step behind the last one, in
/// all rows with known ends, of which there must be one.
template <int N>
bool is_around(const Grid<N>& grid, const CurvedAxis& one, int a) {
  constexpr double kOfAStep = 0.5;
  const std::size_t size = grid.axes[a].size();
  if (size < 3) return false;
  const std::size_t row = detail::size_along(one, grid, 0, a), block = row * size;
  bool any = false;
  for (std::size_t first = 0; first < one.size(); first += block)
    for (std::size_t i = 0; i < row; ++i) {
      const double growth = std::abs(one[first + block - row + i] - one[first + i]);
      if (!std::isfinite(growth)) continue;
      const double step = growth / static_cast<double>(size - 1);
      if (!(std::abs(detail::kTurn - growth - step) <= kOfAStep * step)) return false;
      any = true;
    }
  return any;
}

/// The coordinate that a given period of axis `a` is along: longitudes whose name stands for this axis, or else its
/// own, unless these are longitudes whose name stands for the axis of another one.
template <int N>
int coordinate_of_period(const Grid<N>& grid, std::span<const CurvedAxis> curved, int a) {
  if (!detail::is_axis_curved(curved, a)) return a;
  int found = a;
  for (const CurvedAxis& one : curved) {
    if (!is_longitude_unit(one.unit)) continue;
    const int axis = axis_of_longitudes(grid, one);
    if (axis == a) return one.axis;
    if (one.axis == a) found = axis;
  }
  const auto is_found = [&](const CurvedAxis& one) { return one.axis == found && (one.along >> a & 1u) != 0; };
  return std::ranges::any_of(curved, is_found) ? found : a;
}

/// A length along a coordinate, in the direction in which that grows along axis `a`.
template <int N>
double along_axis(const Grid<N>& grid, std::span<const CurvedAxis> curved, int a, int coordinate, double length) {
  if (!std::isfinite(length) || length <= 0.0)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("the seam of axis {} has the period {}; expected a positive number", a, length));
  double growth = grid.axes[a].is_descending() ? -1.0 : 1.0;
  for (const CurvedAxis& one : curved)
    if (one.axis == coordinate && (one.along >> a & 1u) != 0) growth = mean_growth(grid, one, a);
  return growth < 0.0 ? -length : length;
}

/// Throws InvalidArgument for a length of a seam of axis `a` along a curved coordinate unless the step across the seam,
/// in the mean of all rows, has the direction in which the coordinates grow, and is less than half the length, and if
/// coordinates repeat the first ones in half of the rows: the row in which a tripolar grid is folded lowers the mean.
/// Single rows may have other steps, as those beside the poles of such a grid.
template <int N>
void require_short_step(const Grid<N>& grid, const CurvedAxis& one, int a, double length) {
  constexpr double kRounding = 1e-6;  // of the length: coordinates may be of single precision
  const std::vector<double> growths = growths_of_rows(grid, one, a);
  const double growth = mean_of(growths), step = length - growth;
  const auto repeats = [&](double of_row) {
    return (length - of_row) / length <= kRounding && std::abs(length - of_row) < 0.5 * std::abs(length);
  };
  const auto rows = static_cast<std::size_t>(std::count_if(growths.begin(), growths.end(), repeats));
  const bool is_short = std::isnan(step) || (step / length > kRounding && step / length < 0.5);
  if (is_short && 2 * rows <= growths.size()) return;
  const std::string start = fmt::format("the period of {}, a curved axis, is {}, and ",
                                        detail::label_of_axis(grid.axes[a], a), std::abs(length));
  const char* const expected =
      "expected a longer period, or samples without the last ones, if these repeat the first ones";
  if (is_short)
    throw Error(ErrorCode::InvalidArgument,
                start + fmt::format("the last coordinates are {} or more from the first ones, in {} of {} rows; {}",
                                    std::abs(length), rows, growths.size(), expected));
  if (std::abs(step) < 0.5 * std::abs(length))
    throw Error(ErrorCode::InvalidArgument,
                start + fmt::format("the last coordinates are {} from the first ones, in the mean of all rows; {}",
                                    std::abs(growth), expected));
  throw Error(ErrorCode::InvalidArgument,
              start + fmt::format("the step across the seam is {}, in the mean of all rows; expected less than half "
                                  "the period, or a period in the unit of the coordinates",
                                  std::abs(step)));
}

/// The mean over all rows of the longest step along axis `a`, in longitudes without turns; 0 if none is known.
template <int N>
double mean_longest_step(const Grid<N>& grid, const CurvedAxis& one, int a) {
  const std::size_t row = detail::size_along(one, grid, 0, a), block = row * grid.axes[a].size();
  double sum = 0.0, count = 0.0;
  for (std::size_t first = 0; first < one.size(); first += block)
    for (std::size_t i = 0; i < row; ++i) {
      double longest = 0.0;
      for (std::size_t at = first + i; at + row < first + block; at += row) {
        const double step = one[at + row] - one[at];
        longest = std::fmax(longest, std::abs(step - detail::kTurn * turns_of_step(step)));  // ignores NaN
      }
      if (longest > 0.0) ++count;
      sum += longest;
    }
  return count > 0.0 ? sum / count : 0.0;
}

/// `back`, how far longitudes end from where they begin along axis `a`; 0 if they return there, as along an O-grid
/// around an island: if the way back is at most about twice as long as the longest step, in the mean of all rows.
template <int N>
double span_of_region(const Grid<N>& grid, const CurvedAxis& one, int a, double back) {
  constexpr double kLonger = 2.001;   // around an island in three steps, the last one may be twice the others
  constexpr double kRounding = 1e-3;  // degrees
  return back > kRounding && back > kLonger * mean_longest_step(grid, one, a) ? back : 0.0;  // 0 for NaN
}

/// The length of a seam of axis `a` along longitudes: 360 if they grow by 180 or more, in the direction in which they
/// grow, and otherwise 0.
template <int N>
double turn_across(const Grid<N>& grid, const CurvedAxis& one, int a) {
  const double growth = mean_growth(grid, one, a);
  return std::abs(growth) >= 0.5 * detail::kTurn ? std::copysign(detail::kTurn, growth) : 0.0;  // 0 for NaN
}

/// Whether longitudes run around the globe along axis `a`, or farther: in half of the rows with known ends, with a step
/// to the first ones of at most about the longest one. In the row in which a tripolar grid is folded they do not.
template <int N>
bool runs_around(const Grid<N>& grid, const CurvedAxis& one, int a) {
  constexpr double kLonger = 1.5;
  const double longest = kLonger * mean_longest_step(grid, one, a);
  const std::vector<double> growths = growths_of_rows(grid, one, a);
  const auto is_turn = [&](double growth) { return detail::kTurn - std::abs(growth) <= longest; };
  return !growths.empty() && 2 * std::ranges::count_if(growths, is_turn) >= std::ssize(growths);
}

/// Throws InvalidArgument for longitudes that end far from where they begin, as those of a region do: they neither run
/// around the globe nor return to their places, as along an O-grid around an island.
template <int N>
void require_return(const Grid<N>& grid, const CurvedAxis& one, int a) {
  for (int b = 0; b < N; ++b)
    if (b != a && (one.along >> b & 1u) != 0 && runs_around(grid, one, b)) return;
  std::vector<double> growths = growths_of_rows(grid, one, a);
  for (double& growth : growths) growth = std::abs(growth);  // on both sides of a pole, they grow in other directions
  const double back = span_of_region(grid, one, a, mean_of(growths));
  if (back == 0.0) return;
  throw Error(
      ErrorCode::InvalidArgument,
      fmt::format("the longitudes along {}, a curved axis, span {:.6g}, in the mean of all rows, so they neither run "
                  "around the globe nor return to the first ones; expected a span of more than 180 and less "
                  "than 360, or a given period",
                  detail::label_of_axis(grid.axes[a], a), back));
}

}  // namespace

template <int N>
requires DimensionBetween<N, 2, 4> std::vector<CurvedSeam<N>> find_seams(const Grid<N>& grid,
                                                                         std::span<const CurvedAxis> curved,
                                                                         std::span<const int> axes,
                                                                         std::span<const double> periods) {
  detail::require_curved<N>(grid, curved);
  if (!periods.empty() && periods.size() != axes.size())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("{} periods of seams; expected one for each of {} axes", periods.size(), axes.size()));
  std::vector<CurvedSeam<N>> seams;
  for (const int a : axes) {
    if (a < 0 || a >= N)
      throw Error(ErrorCode::InvalidGrid, fmt::format("a seam of axis {}; expected an axis from 0 to {}", a, N - 1));
    CurvedSeam<N>& seam = seams.emplace_back(CurvedSeam<N>{a, {}});
    const bool is_given = !periods.empty() && !std::isnan(periods[seams.size() - 1]);
    if (!is_given && !detail::is_axis_curved(curved, a)) {
      const double period = default_periods(grid, std::span(&a, 1))[a];
      seam.vector[a] = grid.axes[a].is_descending() ? -period : period;
    }
    for (const CurvedAxis& one : curved) {
      if ((one.along >> a & 1u) == 0 || !is_longitude_unit(one.unit)) continue;
      const double turn = seam.vector[one.axis] = turn_across(grid, one, a);
      if (is_given) continue;
      if (turn != 0.0)
        require_short_step(grid, one, a, turn);
      else
        require_return(grid, one, a);
    }
    if (!is_given) continue;
    const int coordinate = coordinate_of_period(grid, curved, a);
    seam.vector[coordinate] = along_axis(grid, curved, a, coordinate, periods[seams.size() - 1]);
    for (const CurvedAxis& one : curved)
      if (one.axis == coordinate) require_short_step(grid, one, a, seam.vector[coordinate]);
  }
  return seams;
}

template <int N>
requires DimensionBetween<N, 2, 4>
int axis_of_longitudes(const Grid<N>& grid, const CurvedAxis& longitudes) {
  constexpr double kMore = 2.0;  // times the growth along their own axis
  const std::span<const CurvedAxis> one(&longitudes, 1);
  detail::require_curved<N>(grid, one);
  if (!is_longitude_unit(longitudes.unit)) return longitudes.axis;
  std::vector<int> around;
  int longest = longitudes.axis;
  // from the centre of an O-grid, they grow in all directions, so their mean counts
  const auto span_along = [&](int a) {
    return span_of_region(grid, longitudes, a, std::abs(mean_growth(grid, longitudes, a)));
  };
  double most = kMore * span_along(longest);
  for (int a = 0; a < N; ++a) {
    if ((longitudes.along >> a & 1u) == 0) continue;
    if (is_around(grid, longitudes, a) || repeated_longitudes<N>(grid, one, a) > 0) around.push_back(a);
    const double span = span_along(a);
    if (a == longitudes.axis || !(span > most)) continue;
    longest = a;
    most = span;
  }
  return around.size() == 1 ? around.front() : longest;
}

template <int N>
requires DimensionBetween<N, 2, 5> std::vector<int> longitude_axes(const Grid<N>& grid,
                                                                   std::span<const CurvedAxis> curved) {
  if constexpr (N == 5) {
    if (!curved.empty()) throw Error(ErrorCode::InvalidGrid, "a curved grid in 5D; expected 2 to 4 dimensions");
  } else {
    if (!curved.empty()) detail::require_curved<N>(grid, curved);
  }
  const AxisPeriods<N> straight = longitude_periods(grid);
  std::vector<int> axes;
  for (int a = 0; a < N; ++a) {
    const auto continues = [&](const CurvedAxis& one) {
      return (one.along >> a & 1u) != 0 && is_longitude_unit(one.unit) && is_around(grid, one, a);
    };
    const bool is_straight = !detail::is_axis_curved(curved, a);
    if ((is_straight && straight[a] != 0.0) || std::any_of(curved.begin(), curved.end(), continues)) axes.push_back(a);
  }
  return axes;
}

#define TEGL_INSTANTIATE_SEAMS(N)                                                                                      \
  namespace detail {                                                                                                   \
  template LongerCurved<N> longer_curved<N>(const Grid<N>&, std::span<const CurvedAxis>,                               \
                                            std::span<const CurvedSeam<N>>);                                           \
  template std::vector<Period<N>> periods_of_seams<N>(const Grid<N>&, std::span<const CurvedAxis>,                     \
                                                      std::span<const CurvedSeam<N>>);                                 \
  }                                                                                                                    \
  template AxisPeriods<N> index_periods<N>(const Grid<N>&, std::span<const CurvedAxis>, const CurvedSeams<N>&);        \
  template std::vector<int> longitude_axes<N>(const Grid<N>&, std::span<const CurvedAxis>);                            \
  template int axis_of_longitudes<N>(const Grid<N>&, const CurvedAxis&);                                               \
  template std::vector<CurvedSeam<N>> find_seams<N>(const Grid<N>&, std::span<const CurvedAxis>, std::span<const int>, \
                                                    std::span<const double>);
TEGL_INSTANTIATE_SEAMS(2)
TEGL_INSTANTIATE_SEAMS(3)
TEGL_INSTANTIATE_SEAMS(4)
#undef TEGL_INSTANTIATE_SEAMS
template std::vector<int> longitude_axes<5>(const Grid<5>&, std::span<const CurvedAxis>);

}  // namespace tegl
