// SPDX-License-Identifier: BSD-3-Clause
//
// From the world back into the grid: the cell that a point lies in, and its place there.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/LU>

#include "tegl/grid.hpp"

namespace tegl::detail {

/// How far outside of the grid, in steps of the axis, a point still counts as on its border; and how much of an
/// interpolation's weight may belong to missing samples: what vertices of single precision are off by.
inline constexpr double kSlack = 1e-3;

/// A cell by its first sample, and a place in it: the share of the way to the next sample, by axis, in [0, 1].
template <int N>
struct CellPlace {
  std::array<std::size_t, N> base;
  std::array<double, N> share;
};

template <int N>
class GridLocator {
 public:
  explicit GridLocator(const Grid<N>& grid)
      : axes_(grid.axes), mapped_(grid.has_world_map()), inverse_(grid.linear.inverse()), offset_(grid.offset) {
    for (int a = 0; a < N; ++a)
      for (std::size_t i = 0; i < axes_[a].size() && !axes_[a].is_uniform(); ++i)
        keys_[a].push_back(axes_[a].is_descending() ? -axes_[a][i] : axes_[a][i]);
  }

  /// False for points outside of the grid (by more than kSlack), or that are not finite. Axes of one sample have share
  /// 0, and a step of that sample's axis as their extent on either side.
  bool find(const std::array<double, N>& world, CellPlace<N>& place) const noexcept {
    return find(world, place, kSlack);
  }
  /// The place in the grid that is nearest along each axis, for points however far outside, too. False for points that
  /// are not finite.
  bool find_nearest(const std::array<double, N>& world, CellPlace<N>& place) const noexcept {
    return find(world, place, std::numeric_limits<double>::infinity());
  }

 private:
  bool find(const std::array<double, N>& world, CellPlace<N>& place, double slack) const noexcept {
    std::array<double, N> point = world;
    if (mapped_)
      for (int a = 0; a < N; ++a) {
        point[a] = 0.0;
        for (int b = 0; b < N; ++b) point[a] += inverse_(a, b) * (world[b] - offset_(b));
      }
    for (int a = 0; a < N; ++a)
      if (!find_along(a, point[a], slack, place.base[a], place.share[a])) return false;
    return true;
  }

  bool find_along(int a, double x, double slack, std::size_t& base, double& share) const noexcept {
    const Axis& axis = axes_[a];
    const std::size_t last = axis.size() - 1;
    base = 0;
    share = 0.0;
    if (!std::isfinite(x)) return false;
    if (last == 0) return std::abs(x - axis[0]) <= slack * std::abs(axis.step());
    base = axis.is_uniform() ? uniform_base(axis, x, last) : uneven_base(a, x, last);
    const double here = axis[base];
    share = (x - here) / (axis[base + 1] - here);
    if (!(share >= -slack && share <= 1.0 + slack)) return false;
    share = std::clamp(share, 0.0, 1.0);
    return true;
  }

  static std::size_t uniform_base(const Axis& axis, double x, std::size_t last) noexcept {
    const double index = (x - axis.origin()) / axis.step();
    if (!(index > 0.0)) return 0;
    auto base = index >= static_cast<double>(last) ? last - 1 : static_cast<std::size_t>(index);
    // The quotient may be off by a rounding: the sample itself decides.
    const bool descending = axis.is_descending();
    if (base > 0 && (descending ? x > axis[base] : x < axis[base])) --base;
    if (base + 1 < last && (descending ? x <= axis[base + 1] : x >= axis[base + 1])) ++base;
    return base;
  }

  std::size_t uneven_base(int a, double x, std::size_t last) const noexcept {
    const std::vector<double>& keys = keys_[a];
    const double key = axes_[a].is_descending() ? -x : x;
    const auto above = static_cast<std::size_t>(std::upper_bound(keys.begin(), keys.end(), key) - keys.begin());
    return std::min(above == 0 ? 0 : above - 1, last - 1);
  }

  std::array<Axis, N> axes_;
  std::array<std::vector<double>, N> keys_;  ///< ascending, of uneven axes
  bool mapped_;
  Eigen::Matrix<double, N, N> inverse_;
  Eigen::Matrix<double, N, 1> offset_;
};

}  // namespace tegl::detail
