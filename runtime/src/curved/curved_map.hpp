// SPDX-License-Identifier: BSD-3-Clause
//
// The map from the indices of a curved grid to space: places, derivatives, orientation.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "image/locate.hpp"
#include "tegl/curved.hpp"

namespace tegl::detail {

/// Throws InvalidGrid unless the curved axes fit the grid.
template <int N>
void require_curved(const Grid<N>& grid, std::span<const CurvedAxis> curved);

template <int N>
class CurvedMap {
 public:
  using SampleIndex = std::array<std::size_t, N>;

  /// The curved axes must fit the grid, and outlive the map.
  CurvedMap(const Grid<N>& grid, std::span<const CurvedAxis> curved);

  /// Bit a: axis a is curved.
  [[nodiscard]] unsigned curved() const noexcept { return curved_; }
  [[nodiscard]] bool is_curved(int axis) const noexcept { return (curved_ >> axis & 1u) != 0; }
  /// Bit a: a curved coordinate differs along axis a.
  [[nodiscard]] unsigned along() const noexcept { return along_; }

  /// Sign of the orientation of the cell's edges at a corner, in space relative to the indices; 0 if they are
  /// dependent, NaN if coordinates are unknown. Axes that are not curved count as ascending.
  [[nodiscard]] double orientation(const SampleIndex& cell, unsigned corner) const noexcept;
  /// The orientation of most of some cells that are spread over the grid: 1 or -1.
  [[nodiscard]] double main_orientation() const;

  /// Replaces the curved coordinates of a point by those of its place in the grid.
  void move(const CellPlace<N>& place, std::array<double, N>& point) const noexcept {
    // Nearly all places are on an edge: between two samples.
    int edge = -1;
    int edges = 0;
    for (int a = 0; a < N; ++a) {
      const bool is_between = (along_ >> a & 1u) != 0 && place.share[a] != 0.0;
      edges += is_between ? 1 : 0;
      edge = is_between ? a : edge;
    }
    const double share = edges == 0 ? 0.0 : place.share[edge];
    if (edges > 1 || share == 1.0) return move_inside(place, point);
    for (std::size_t k = 0; k < axes_.size(); ++k) {
      const double* at = axes_[k].values.data();
      for (int a = 0; a < N; ++a) at += place.base[a] * strides_[k][a];
      const std::size_t step = edges == 0 ? 0 : strides_[k][edge];
      point[axes_[k].axis] = step == 0 ? *at : (1.0 - share) * *at + share * at[step];
    }
  }
  /// The derivatives by index, derivatives[c][a], of coordinate c along axis a, at a place: central differences between
  /// samples, interpolated. Only those of curved coordinates are set, the others are 0.
  [[nodiscard]] Matrix<N> derivatives(const CellPlace<N>& place) const noexcept;

 private:
  [[nodiscard]] double value(std::size_t k, const SampleIndex& index) const noexcept {
    std::size_t at = 0;
    for (int a = 0; a < N; ++a) at += index[a] * strides_[k][a];
    return axes_[k].values[at];
  }
  /// For places between more than two samples.
  void move_inside(const CellPlace<N>& place, std::array<double, N>& point) const noexcept;
  [[nodiscard]] double difference(std::size_t k, const SampleIndex& index, int a) const noexcept;

  std::span<const CurvedAxis> axes_;
  std::array<std::array<std::size_t, N>, N> strides_{};  ///< of the arrays; 0 along other axes
  SampleIndex sizes_;
  unsigned curved_ = 0;
  unsigned along_ = 0;
};

}  // namespace tegl::detail
