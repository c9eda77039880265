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

/// The samples around a place that have a weight in the multilinear interpolation.
template <int N>
struct CellCorners {
  std::array<std::array<std::size_t, N>, std::size_t{1} << N> index;
  std::array<double, std::size_t{1} << N> weight;
  unsigned count = 0;
};

/// The corners with weights other than 0; along axes that are not in the set `along`, only those at the cell's base.
template <int N>
CellCorners<N> weighted_corners(const CellPlace<N>& place, unsigned along = (1u << N) - 1) noexcept {
  CellCorners<N> corners;
  corners.index[0] = place.base;
  corners.weight[0] = 1.0;
  corners.count = 1;
  for (int a = 0; a < N; ++a) {
    const double share = place.share[a];
    if ((along >> a & 1u) == 0 || share == 0.0) continue;
    if (share == 1.0) {
      for (unsigned i = 0; i < corners.count; ++i) ++corners.index[i][a];
      continue;
    }
    for (unsigned i = 0; i < corners.count; ++i) {
      corners.index[corners.count + i] = corners.index[i];
      ++corners.index[corners.count + i][a];
      corners.weight[corners.count + i] = corners.weight[i] * share;
      corners.weight[i] *= 1.0 - share;
    }
    corners.count *= 2;
  }
  return corners;
}

/// The inverse matrix.
template <int N>
Matrix<N> inverse_of(const Matrix<N>& matrix);

template <int N>
class GridLocator {
 public:
  explicit GridLocator(const Grid<N>& grid)
      : axes_(grid.axes), mapped_(grid.has_world_map()), inverse_(inverse_of<N>(grid.linear)), offset_(grid.offset) {
    for (int a = 0; a < N; ++a) {
      const Axis& axis = axes_[a];
      lines_[a] = {axis.origin(), axis.step(), axis.size() - 1, axis.is_uniform(), axis.is_descending()};
      for (std::size_t i = 0; i < axis.size() && !axis.is_uniform(); ++i)
        keys_[a].push_back(axis.is_descending() ? -axis[i] : axis[i]);
    }
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

  /// The axis's properties, so that points need no calls.
  struct Line {
    double origin;
    double step;
    std::size_t last;  ///< sample
    bool uniform;
    bool descending;

    [[nodiscard]] double at(std::size_t i) const noexcept { return origin + static_cast<double>(i) * step; }
  };

  bool find_along(int a, double x, double slack, std::size_t& base, double& share) const noexcept {
    const Line& line = lines_[a];
    base = 0;
    share = 0.0;
    if (!std::isfinite(x)) return false;
    if (line.last == 0) return std::abs(x - line.origin) <= slack * std::abs(line.step);
    base = line.uniform ? uniform_base(line, x) : uneven_base(a, x);
    const double here = line.uniform ? line.at(base) : axes_[a][base];
    const double next = line.uniform ? line.at(base + 1) : axes_[a][base + 1];
    share = (x - here) / (next - here);
    if (!(share >= -slack && share <= 1.0 + slack)) return false;
    share = std::clamp(share, 0.0, 1.0);
    return true;
  }

  static std::size_t uniform_base(const Line& line, double x) noexcept {
    const double index = (x - line.origin) / line.step;
    if (!(index > 0.0)) return 0;
    auto base = index >= static_cast<double>(line.last) ? line.last - 1 : static_cast<std::size_t>(index);
    // The quotient may have a rounding error, so the samples themselves are compared.
    if (base > 0 && (line.descending ? x > line.at(base) : x < line.at(base))) --base;
    if (base + 1 < line.last && (line.descending ? x <= line.at(base + 1) : x >= line.at(base + 1))) ++base;
    return base;
  }

  std::size_t uneven_base(int a, double x) const noexcept {
    const std::vector<double>& keys = keys_[a];
    const double key = axes_[a].is_descending() ? -x : x;
    const auto above = static_cast<std::size_t>(std::upper_bound(keys.begin(), keys.end(), key) - keys.begin());
    return std::min(above == 0 ? 0 : above - 1, lines_[a].last - 1);
  }

  std::array<Axis, N> axes_;
  std::array<Line, N> lines_;
  std::array<std::vector<double>, N> keys_;  ///< ascending; only for non-uniform axes
  bool mapped_;
  Matrix<N> inverse_;
  Vector<N> offset_;
};

}  // namespace tegl::detail
