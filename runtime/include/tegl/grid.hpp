// SPDX-License-Identifier: BSD-3-Clause
//
// The coordinates of an image: one axis per dimension (uniform or rectilinear), then an affine map to the world.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "tegl/dimensions.hpp"
#include "tegl/error.hpp"
#include "tegl/vector.hpp"

namespace tegl {

/// Coordinates of the samples along one dimension: uniform (origin + i * step, step != 0) or rectilinear
/// (finite, strictly monotone, ascending or descending). At least one sample.
class Axis {
 public:
  Axis() = default;

  /// `size` samples at origin + i * step. Throws InvalidGrid for size 0, a zero or non-finite step.
  [[nodiscard]] static Axis uniform(std::size_t size, double origin = 0.0, double step = 1.0);

  /// Samples at the given coordinates. Throws InvalidGrid unless they are finite and strictly monotone.
  [[nodiscard]] static Axis rectilinear(std::vector<double> coordinates);

  [[nodiscard]] std::size_t size() const noexcept { return size_; }                ///< number of samples
  [[nodiscard]] bool is_uniform() const noexcept { return coordinates_.empty(); }  ///< whether all steps are equal
  [[nodiscard]] double origin() const noexcept { return (*this)[0]; }              ///< coordinate of sample 0
  /// The step of a uniform axis; the mean step of a rectilinear one.
  [[nodiscard]] double step() const noexcept;
  /// True if coordinates decrease with the index.
  [[nodiscard]] bool is_descending() const noexcept { return step() < 0; }

  /// Coordinate of sample i < size().
  [[nodiscard]] double operator[](std::size_t i) const noexcept {
    return coordinates_.empty() ? origin_ + static_cast<double>(i) * step_ : coordinates_[i];
  }

  /// The samples [first, first + count), with identical coordinates.
  [[nodiscard]] Axis part(std::size_t first, std::size_t count) const;

  std::string name = {};  ///< such as "lon", "t"; may be empty
  std::string unit = {};  ///< such as "mm", "degrees_east", "s"; may be empty

 private:
  std::size_t size_ = 0;
  double origin_ = 0.0;
  double step_ = 1.0;
  std::vector<double> coordinates_;
};

/// An N-dimensional grid. Readers put the axis that is fastest in memory first and time last. World position of index
/// i: linear * (axes[0][i_0], ..., axes[N-1][i_{N-1}]) + offset.
template <int N>
requires DimensionBetween<N, 2, 5>
struct Grid {
  std::array<Axis, N> axes = {};     ///< axis 0 first; time last
  Matrix<N> linear = identity<N>();  ///< matrix of the world map, linear[row][column]
  Vector<N> offset = {};             ///< its translation

  /// A uniform grid with origin 0 and step 1.
  [[nodiscard]] static Grid unit(const std::array<std::size_t, N>& sizes) {
    Grid grid;
    for (int a = 0; a < N; ++a) grid.axes[a] = Axis::uniform(sizes[a]);
    return grid;
  }
  /// Number of samples along each axis.
  [[nodiscard]] std::array<std::size_t, N> sizes() const {
    std::array<std::size_t, N> result;
    for (int a = 0; a < N; ++a) result[a] = axes[a].size();
    return result;
  }
  /// True unless `linear` is the identity and `offset` is zero.
  [[nodiscard]] bool has_world_map() const { return linear != identity<N>() || offset != Vector<N>{}; }
  /// Whether the world map keeps an axis separate, so that its layers are across it: row and column `axis` of `linear`
  /// are zero except for their common element, which is not. Precondition: 0 <= axis < N.
  [[nodiscard]] bool is_separate(int axis) const {
    for (int a = 0; a < N; ++a)
      if (a != axis && (linear[axis][a] != 0.0 || linear[a][axis] != 0.0)) return false;
    return linear[axis][axis] != 0.0;
  }
};

/// One coordinate of the samples of a curved grid (tegl/curved.hpp).
struct CurvedAxis {
  int axis = 0;        ///< which coordinate of the vertices this is, and the axis of the image that it stands for
  unsigned along = 0;  ///< bit a: the coordinate differs along axis a of the image; bit `axis` is set
  /// A coordinate for each index of the axes in `along`, the first of these axes fastest. NaN or infinite: unknown.
  std::vector<double> values = {};
  std::string name = {};                               ///< of the coordinate, such as "lon"; empty: as the image's axis
  std::string unit = {};                               ///< of the coordinate; empty: as the image's axis
  bool operator==(const CurvedAxis&) const = default;  ///< equal if all members are
};

}  // namespace tegl
