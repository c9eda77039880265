// SPDX-License-Identifier: BSD-3-Clause
//
// Maps points from the world to the grid: the cell that contains a point, and its position in the cell.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "tegl/grid.hpp"

namespace tegl::detail {

/// Tolerance for the rounding of single-precision vertices: the distance from the grid, in steps of the axis, up to
/// which a point counts as on its border; and the share of an interpolation's weight that may belong to missing
/// samples.
inline constexpr double kSlack = 1e-3;

/// A cell by its first sample, and a position in it: by axis the fraction of the way to the next sample, in [0, 1].
template <int N>
struct CellPlace {
  std::array<std::size_t, N> base;
  std::array<double, N> share;
};

/// The inverse matrix.
template <int N>
Matrix<N> inverse_of(const Matrix<N>& matrix);

template <int N>
class GridLocator {
 public:
  explicit GridLocator(const Grid<N>& grid)
      : axes_(grid.axes), mapped_(grid.has_world_map()), inverse_(inverse_of<N>(grid.linear)), offset_(grid.offset) {
    for (int a = 0; a < N; ++a)
      for (std::size_t i = 0; i < axes_[a].size() && !axes_[a].is_uniform(); ++i)
        keys_[a].push_back(axes_[a].is_descending() ? -axes_[a][i] : axes_[a][i]);
  }

  /// Returns false for points outside the grid (by more than kSlack) and for points that are not finite. On axes with
  /// one sample the share is 0, and the tolerance is relative to the axis's step.
  bool find(const std::array<double, N>& world, CellPlace<N>& place) const noexcept {
    return find(world, place, kSlack);
  }
  /// Finds the nearest position along each axis, also for points outside the grid. Returns false for points that are
  /// not finite.
  bool find_nearest(const std::array<double, N>& world, CellPlace<N>& place) const noexcept {
    return find(world, place, std::numeric_limits<double>::infinity());
  }

 private:
  bool find(const std::array<double, N>& world, CellPlace<N>& place, double slack) const noexcept {
    std::array<double, N> point = world;
    if (mapped_)
      for (int a = 0; a < N; ++a) {
        point[a] = 0.0;
        for (int b = 0; b < N; ++b) point[a] += inverse_[a][b] * (world[b] - offset_[b]);
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
    // The quotient may have a rounding error, so the samples themselves are compared.
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
  std::array<std::vector<double>, N> keys_;  ///< ascending; only for non-uniform axes
  bool mapped_;
  Matrix<N> inverse_;
  Vector<N> offset_;
};

}  // namespace tegl::detail
