// SPDX-License-Identifier: BSD-3-Clause
//
// Longitudes: periods of axes, and longitudes in arrays, which are continued across 180 degrees between neighbours on a
// grid.
//
// A run is a sequence of known samples of one row without a gap. Runs with neighbours in common are joined to pieces
// by union-find, which stores the turns of 360 degrees between them.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "periodic/periods.hpp"
#include "tegl/curved.hpp"
#include "tegl/error.hpp"

namespace tegl {
namespace {

using detail::kTurn;
constexpr double kMost = 720.0;  // larger numbers are no places
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

bool is_known(double longitude) { return std::abs(longitude) <= kMost; }

/// The turns that bring `to` nearest to `from`; the fewer of two that are equally near.
double turns(double from, double to) {
  const double apart = (from - to) / kTurn;
  return apart > 0.0 ? std::ceil(apart - 0.5) : std::floor(apart + 0.5);
}

struct Run {
  std::size_t first, end;
};

/// Disjoint sets of runs, with the turns of each one relative to the first run of its set.
class Pieces {
 public:
  void add() {
    parents_.push_back(parents_.size());
    turns_.push_back(0.0);
  }

  std::pair<std::size_t, double> root_of(std::size_t run) {
    double sum = 0.0;
    for (; parents_[run] != run; run = parents_[run]) {
      const std::size_t parent = parents_[run];
      if (parents_[parent] != parent) {  // otherwise this would be the root's 0
        turns_[run] += turns_[parent];
        parents_[run] = parents_[parent];
      }
      sum += turns_[run];
    }
    return {run, sum};
  }

  /// `of_b`: the turns of b relative to a.
  void join(std::size_t a, std::size_t b, double of_b) {
    const auto [first, of_first] = root_of(a);
    const auto [second, of_second] = root_of(b);
    if (first == second) return;
    const double between = of_first + of_b - of_second;
    parents_[std::max(first, second)] = std::min(first, second);
    turns_[std::max(first, second)] = first < second ? between : -between;
  }

 private:
  std::vector<std::size_t> parents_;
  std::vector<double> turns_;  ///< relative to the parent
};

class Continued {
 public:
  Continued(std::span<double> longitudes, std::vector<std::size_t> sizes)
      : longitudes_(longitudes), sizes_(std::move(sizes)), row_(sizes_[0]) {
    strides_.assign(sizes_.size(), 1);
    for (std::size_t a = 1; a < sizes_.size(); ++a) strides_[a] = strides_[a - 1] * sizes_[a - 1];
  }

  void run() {
    find_runs();
    for (std::size_t a = 1; a < sizes_.size(); ++a)
      for (std::size_t r = 0; r < longitudes_.size() / row_; ++r)
        if (r * row_ / strides_[a] % sizes_[a] > 0) join_rows(r - strides_[a] / row_, r);
    bool is_one = true;
    for (std::size_t i = 0; i < runs_.size() && is_one; ++i) is_one = pieces_.root_of(i).first == 0;
    if (!is_one) join_far_pieces();
    for (std::size_t i = 0; i < runs_.size(); ++i)
      if (const double more = pieces_.root_of(i).second; more != 0.0)
        for (std::size_t s = runs_[i].first; s < runs_[i].end; ++s) longitudes_[s] += kTurn * more;
  }

 private:
  /// Finds the runs, and continues longitudes along each of them.
  void find_runs() {
    for (std::size_t first = 0; first < longitudes_.size(); first += row_) {
      first_runs_.push_back(runs_.size());
      for (std::size_t s = first; s < first + row_; ++s) {
        if (!is_known(longitudes_[s])) continue;
        if (s > first && is_known(longitudes_[s - 1])) {
          runs_.back().end = s + 1;
          continue;
        }
        runs_.push_back({s, s + 1});
        pieces_.add();
      }
    }
    first_runs_.push_back(runs_.size());
    for (const Run& run : runs_)
      for (std::size_t s = run.first + 1; s < run.end; ++s)
        longitudes_[s] += kTurn * turns(longitudes_[s - 1], longitudes_[s]);
  }

  /// Joins the runs of two rows at the first neighbours of each two of them.
  void join_rows(std::size_t before, std::size_t row) {
    const std::size_t step = (row - before) * row_;
    std::size_t a = first_runs_[before], b = first_runs_[row];
    while (a < first_runs_[before + 1] && b < first_runs_[row + 1]) {
      const std::size_t first = std::max(runs_[a].first + step, runs_[b].first);
      const std::size_t end_a = runs_[a].end + step, end_b = runs_[b].end;
      if (first < std::min(end_a, end_b)) pieces_.join(a, b, turns(longitudes_[first - step], longitudes_[first]));
      if (end_a <= end_b) ++a;
      if (end_b <= end_a) ++b;
    }
  }

  std::size_t run_of(std::size_t sample) const {
    const auto behind = std::ranges::upper_bound(runs_, sample, {}, &Run::first);
    return static_cast<std::size_t>(behind - runs_.begin()) - 1;
  }

  /// For each two neighbours on the grid: calls visit(sample, next).
  template <class Visit>
  void visit_neighbours(const Visit& visit) const {
    for (std::size_t a = 0; a < sizes_.size(); ++a)
      for (std::size_t s = 0; s < longitudes_.size(); ++s)
        if (s / strides_[a] % sizes_[a] + 1 < sizes_[a]) visit(s, s + strides_[a]);
  }

  /// Joins pieces without neighbours in common: the nearest ones first, by the number of steps between their samples.
  void join_far_pieces() {
    std::vector<std::size_t> nearest(longitudes_.size(), kNone), queue;
    std::vector<std::uint32_t> distances(longitudes_.size(), 0);
    for (const Run& run : runs_)
      for (std::size_t s = run.first; s < run.end; ++s) queue.push_back(nearest[s] = s);
    for (std::size_t q = 0; q < queue.size(); ++q) {
      const std::size_t s = queue[q];
      const auto reach = [&](std::size_t next) {
        if (nearest[next] != kNone) return;
        nearest[next] = nearest[s];
        distances[next] = distances[s] + 1;
        queue.push_back(next);
      };
      for (std::size_t a = 0; a < sizes_.size(); ++a) {
        const std::size_t i = s / strides_[a] % sizes_[a];
        if (i > 0) reach(s - strides_[a]);
        if (i + 1 < sizes_[a]) reach(s + strides_[a]);
      }
    }
    struct Way {
      std::uint32_t length;
      std::size_t a, b;
    };
    std::vector<Way> ways;
    visit_neighbours([&](std::size_t s, std::size_t next) {
      const std::size_t a = nearest[s], b = nearest[next];
      if (a == b || pieces_.root_of(run_of(a)).first == pieces_.root_of(run_of(b)).first) return;
      ways.push_back({distances[s] + distances[next], std::min(a, b), std::max(a, b)});
    });
    std::ranges::stable_sort(ways, {}, &Way::length);
    for (const Way& way : ways)
      pieces_.join(run_of(way.a), run_of(way.b), turns(longitudes_[way.a], longitudes_[way.b]));
  }

  std::span<double> longitudes_;
  std::vector<std::size_t> sizes_, strides_;
  std::size_t row_;
  std::vector<Run> runs_;
  std::vector<std::size_t> first_runs_;  ///< by row
  Pieces pieces_;
};

/// 360 in the world, where `axis` is; if the gap behind the last sample is positive and less than half a turn, and so
/// are all steps: in 5D, these may be longer (`check_periods`).
double turn_of(const Axis& axis, int a, double scale, bool may_have_long_steps) {
  constexpr double kTolerance = 1e-3;  // of a step: coordinates in files may be of single precision
  const double length = std::abs(axis[axis.size() - 1] - axis[0]);
  const double step = length / static_cast<double>(axis.size() - 1);
  const auto refuse = [&](const std::string& reason) {
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("the period of {}, of longitudes, is 360, {}", detail::label_of_axis(axis, a), reason));
  };
  if (!(kTurn - length > kTolerance * step))
    refuse(
        fmt::format("and is not more than {}, the span of its samples; expected an axis without the last sample, if "
                    "that repeats the first one",
                    length));
  if (!(kTurn - length < kTurn / 2))
    refuse(
        fmt::format("but its samples span {}, and the gap behind them is {}; expected less than 180, or a given "
                    "period, such as {}",
                    length, kTurn - length, (length + step) / scale));
  if (may_have_long_steps) return kTurn;
  if (const std::string reason = detail::too_long_steps(axis, a, kTurn); !reason.empty())
    throw Error(ErrorCode::InvalidArgument, reason);
  return kTurn;
}

/// The error about an axis with the unit of longitudes along which, by the world map, others differ, too, or instead.
template <int N>
[[noreturn]] void refuse_mixed(const Grid<N>& grid, int a) {
  std::vector<std::string> others;
  for (int b = 0; b < N; ++b)
    if (b != a && grid.linear[b][a] != 0.0) others.push_back(detail::label_of_axis(grid.axes[b], b));
  const std::string own = detail::label_of_axis(grid.axes[a], a);
  const std::string also = fmt::format("{}", fmt::join(others, " and "));
  throw Error(ErrorCode::InvalidArgument,
              fmt::format("the unit of {} is that of longitudes, but by the affine map, the world's coordinates of {} "
                          "{} differ along it; expected a given period, in the coordinates before the map, or another "
                          "axis",
                          own, also, grid.linear[a][a] != 0.0 ? "also" : "and not its own"));
}

}  // namespace

template <int N>
requires DimensionBetween<N, 2, 5> AxisPeriods<N> default_periods(const Grid<N>& grid, std::span<const int> axes) {
  AxisPeriods<N> periods = sample_periods(grid, axes);
  for (const int a : axes) {
    if (!is_longitude_unit(grid.axes[a].unit)) continue;
    const std::optional<Axis> axis = detail::axis_in_world(grid, a);
    if (!axis) refuse_mixed(grid, a);
    const double scale = std::abs(grid.linear[a][a]);
    periods[a] = turn_of(*axis, a, scale, N == 5) / scale;
  }
  return periods;
}

template AxisPeriods<2> default_periods<2>(const Grid<2>&, std::span<const int>);
template AxisPeriods<3> default_periods<3>(const Grid<3>&, std::span<const int>);
template AxisPeriods<4> default_periods<4>(const Grid<4>&, std::span<const int>);
template AxisPeriods<5> default_periods<5>(const Grid<5>&, std::span<const int>);

void continue_longitudes(std::span<double> longitudes, std::span<const std::size_t> sizes) {
  const std::size_t expected =
      std::accumulate(sizes.begin(), sizes.end(), std::size_t{1}, [](std::size_t a, std::size_t b) { return a * b; });
  if (longitudes.size() != expected)
    throw Error(ErrorCode::InvalidArgument, fmt::format("{} longitudes; expected {}, for {} samples", longitudes.size(),
                                                        expected, fmt::join(sizes, " x ")));
  std::vector<std::size_t> longer;  // than one sample
  std::ranges::copy_if(sizes, std::back_inserter(longer), [](std::size_t size) { return size > 1; });
  if (expected > 0 && !longer.empty()) Continued(longitudes, std::move(longer)).run();
}

}  // namespace tegl
