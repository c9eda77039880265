// SPDX-License-Identifier: BSD-3-Clause
//
// The map from the indices of a curved grid to space: places, derivatives, orientation.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "curved/curved_block.hpp"
#include "image/locate.hpp"
#include "tegl/curved.hpp"

namespace tegl::detail {

/// Throws InvalidGrid unless the curved axes fit the grid.
template <int N>
void require_curved(const Grid<N>& grid, std::span<const CurvedAxis> curved);

/// The address of the first coordinate of an axis that is stored by points.
[[nodiscard]] inline std::uintptr_t first_address(const CurvedAxis& one) noexcept {
  return one.points.floats() != nullptr ? reinterpret_cast<std::uintptr_t>(one.points.floats() + one.column)
                                        : reinterpret_cast<std::uintptr_t>(one.points.doubles() + one.column);
}

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
  /// Continues derivatives across seams, where the map's last sample along the axis repeats the first one.
  void set_seams(std::span<const CurvedSeam<N>> seams) noexcept {
    for (const CurvedSeam<N>& seam : seams) {
      periodic_ |= 1u << seam.axis;
      turns_[seam.axis] = seam.vector;
    }
  }

  /// Finds the edges of the block's points, which are indices times steps.
  template <class Real>
  void find_edges(const Real* points, const IndexSteps& steps, CurvedBlock& block) const noexcept {
    find_ends(points, N, steps, arrays_, block);
  }
  /// Sets the edge of point i of a block, and its bit of `inside`.
  void set_edge(std::size_t i, const CellPlace<N>& place, CurvedBlock& block) const noexcept;
  /// Starts to load coordinates at the edges of a block.
  void request(const CurvedBlock& block) const noexcept;
  /// Sets the curved coordinates of points on edges; of those inside cells `set_inside`. Meanwhile starts to load the
  /// coordinates of `next`, which may have no points. Returns whether all of these coordinates are finite.
  template <class Real>
  bool set_on_edges(const CurvedBlock& block, const CurvedBlock& next, Real* points) const noexcept {
    bool finite = true;
    for (std::size_t k = 0; k < arrays_.size(); ++k)
      finite = interpolate(arrays_[k], block.ends[k], block.count, next.ends[k], next.count, N, points) && finite;
    return finite;
  }
  /// Sets the curved coordinates of a point. Returns whether they are finite.
  template <class Real>
  bool set_inside(const CellPlace<N>& place, Real* point) const noexcept {
    bool finite = true;
    for (std::size_t k = 0; k < axes_.size(); ++k) {
      const double x = inside(k, place);
      finite = finite && std::isfinite(x);
      point[axes_[k].axis] = static_cast<Real>(x);
    }
    return finite;
  }
  /// The derivatives by index, derivatives[c][a], of coordinate c along axis a, at a place: central differences between
  /// samples, interpolated. Only those of curved coordinates are set, the others are 0.
  [[nodiscard]] Matrix<N> derivatives(const CellPlace<N>& place) const noexcept;

 private:
  [[nodiscard]] double value(std::size_t k, const SampleIndex& index) const noexcept {
    std::size_t at = 0;
    for (int a = 0; a < N; ++a) at += index[a] * strides_[k][a];
    return axes_[k][at];
  }
  /// Adds an array with these strides to `arrays_`.
  void add_array(const CurvedAxis& one, const SampleIndex& strides);
  /// The coordinate of axes_[k] at a place between any number of samples.
  [[nodiscard]] double inside(std::size_t k, const CellPlace<N>& place) const noexcept;
  [[nodiscard]] double difference(std::size_t k, const SampleIndex& index, int a) const noexcept;

  std::span<const CurvedAxis> axes_;
  std::vector<CurvedArrays> arrays_;                     ///< those of axes_, by the axes that they have, and by memory
  std::array<std::array<std::size_t, N>, N> strides_{};  ///< of the arrays; 0 along other axes
  SampleIndex sizes_;
  unsigned curved_ = 0;
  unsigned along_ = 0;
  unsigned periodic_ = 0;
  std::array<Vector<N>, N> turns_{};  ///< by periodic axis
};

}  // namespace tegl::detail
