// SPDX-License-Identifier: BSD-3-Clause
//
// Complexes in space and time: each cell x each interval is a prism.
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "complex/cell_groups.hpp"
#include "tegl/error.hpp"

namespace tegl {

namespace {

void check_times(std::span<const double> times) {
  if (times.size() < 2)
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} times; expected at least 2", times.size()));
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (!std::isfinite(times[k]))
      throw Error(ErrorCode::InvalidArgument, fmt::format("time {} is {}; expected a finite number", k, times[k]));
    if (k > 0 && times[k] <= times[k - 1])
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("time {} is {}, after {}; expected ascending times", k, times[k], times[k - 1]));
  }
}

/// The prisms over the intervals of a group, interval by interval.
detail::CellGroup prisms_over(const detail::CellGroup& group, std::size_t points, std::size_t intervals) {
  detail::CellGroup prisms{detail::prism_of(group.shape), 2 * group.corner_count, {}, true};
  prisms.corners.reserve(2 * group.corners.size() * intervals);
  for (std::size_t k = 0; k < intervals; ++k)
    for (std::size_t c = 0; c < group.size(); ++c)
      for (const std::size_t layer : {k, k + 1})
        for (std::size_t v = 0; v < group.corner_count; ++v)
          prisms.corners.push_back(static_cast<Index>(layer * points + group.cell(c)[v]));
  return prisms;
}

/// Prisms over polygons are polyhedra.
detail::Polytopes prisms_over(const detail::Polytopes& polytopes, std::size_t points, std::size_t intervals) {
  for (std::size_t c = 0; polytopes.dim() == 2 && c < polytopes.size(); ++c)
    if (const auto corners = polytopes.points_of(c); 2 * corners.size() > detail::kPolytopeCorners)
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format("a polygon of {} corners over time, with the points {}, {}, {} and further ones; expected "
                      "at most {}",
                      corners.size(), corners[0], corners[1], corners[2], detail::kPolytopeCorners / 2));
  return polytopes.in_time(points, intervals);
}

}  // namespace

template <int N>
requires DimensionBetween<N, 2, 3> Complex<N + 1> in_time(const Complex<N>& complex, std::span<const double> times,
                                                          std::span<const double> values,
                                                          std::span<const std::array<double, N>> points) {
  check_times(times);
  const std::size_t count = complex.points().size();
  if (values.size() != count * times.size())
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} values; expected {}: {} points at {} times", values.size(),
                                                        count * times.size(), count, times.size()));
  if (!points.empty() && points.size() != count * times.size())
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} moving points; expected {}: {} points at {} times, or none",
                                                        points.size(), count * times.size(), count, times.size()));
  if (count * times.size() > std::numeric_limits<Index>::max())
    throw Error(ErrorCode::TooLarge, fmt::format("{} points at {} times; expected at most {} in all", count,
                                                 times.size(), std::numeric_limits<Index>::max()));
  if (complex.cell_count() > std::numeric_limits<Index>::max() / (times.size() - 1))
    throw Error(ErrorCode::TooLarge,
                fmt::format("{} cells in {} intervals; expected at most {} prisms", complex.cell_count(),
                            times.size() - 1, std::numeric_limits<Index>::max()));
  // points
  std::vector<std::array<double, N + 1>> all(count * times.size());
  for (std::size_t k = 0; k < times.size(); ++k)
    for (std::size_t p = 0; p < count; ++p) {
      const std::array<double, N>& from = points.empty() ? complex.points()[p] : points[k * count + p];
      std::array<double, N + 1>& to = all[k * count + p];
      for (std::size_t i = 0; i < N; ++i) to[i] = from[i];
      to[N] = times[k];
    }
  // prisms
  detail::CellGroups cells;
  for (const detail::CellGroup& group : detail::ComplexAccess::cells(complex).groups)
    cells.groups.push_back(prisms_over(group, count, times.size() - 1));
  cells.polytopes = prisms_over(detail::ComplexAccess::cells(complex).polytopes, count, times.size() - 1);
  cells.cell_count = complex.cell_count() * (times.size() - 1);
  Complex<N + 1> result = detail::ComplexAccess::layered<N + 1>(std::move(all), std::move(cells));
  result.set_values(std::vector<double>(values.begin(), values.end()));
  return result;
}

template Complex<3> in_time<2>(const Complex<2>&, std::span<const double>, std::span<const double>,
                               std::span<const std::array<double, 2>>);
template Complex<4> in_time<3>(const Complex<3>&, std::span<const double>, std::span<const double>,
                               std::span<const std::array<double, 3>>);

}  // namespace tegl
