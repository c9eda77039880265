// SPDX-License-Identifier: BSD-3-Clause
//
// Hyperplanes in N-space, and Cartesian coordinates in them.
#pragma once

#include <Eigen/Core>

#include "tegl/contour.hpp"

namespace tegl {

/// The points x with <normal, x> = offset. The normal may have any non-zero length; its side is "above".
template <int N>
requires DimensionBetween<N, 2, 4>
struct Hyperplane {
  using Vector = Eigen::Matrix<double, N, 1>;  ///< components by axis
  Vector normal = Vector::Unit(N - 1);         ///< a, of any non-zero length
  double offset = 0.0;                         ///< b

  /// The hyperplane x_axis = at.
  static Hyperplane across(int axis, double at) { return {Vector::Unit(axis), at}; }
};

/// Orthonormal coordinates in a hyperplane: y is the point `origin + axes * y`.
///
/// The frame depends only on the hyperplane. Let e_k be the axis closest to the normal (the last one if several are).
/// The frame's axes are the other axes in their order, rotated by the smallest rotation that takes e_k to the normal,
/// or to its opposite if that is closer. For a hyperplane across a coordinate axis, the frame is therefore exactly the
/// other axes. The frame changes continuously with the normal while k stays the same.
template <int N>
requires DimensionBetween<N, 2, 4>
struct HyperplaneFrame {
  Eigen::Matrix<double, N, N - 1> axes;  ///< column = axis
  Eigen::Matrix<double, N, 1> origin;    ///< the point of the hyperplane nearest to 0
  Eigen::Matrix<double, N, 1> up;        ///< the unit normal
  int dropped = N - 1;                   ///< k
  bool is_right_handed = true;           ///< whether det[axes, up] is +1 (right-handed), not -1

  /// The point of N-space with hyperplane coordinates y.
  [[nodiscard]] Eigen::Matrix<double, N, 1> to_space(const Eigen::Matrix<double, N - 1, 1>& y) const {
    return origin + axes * y;
  }
  /// Hyperplane coordinates of the orthogonal projection of a point.
  [[nodiscard]] Eigen::Matrix<double, N - 1, 1> to_plane(const Eigen::Matrix<double, N, 1>& x) const {
    return axes.transpose() * x;
  }
};

/// The frame of a hyperplane. Lengths and angles are those of the coordinates as given. If axes have different units
/// (mm and s), call `scale_axes` first to define how they compare. N = 2, 3, 4. Throws InvalidArgument if the normal is
/// 0 or not finite, or the offset is not finite.
template <int N>
requires DimensionBetween<N, 2, 4> HyperplaneFrame<N> frame_of(const Hyperplane<N>& hyperplane);

/// Multiplies the coordinates along each axis by a positive factor. Normals become those of the scaled contour; names,
/// units, attributes and simplices are unchanged. N = 2, 3, 4. Throws InvalidArgument for other factors. O(#V).
template <int N, class Real>
requires DimensionBetween<N, 2, 4>
void scale_axes(Contour<N, Real>& contour, const Eigen::Matrix<double, N, 1>& factors);

}  // namespace tegl
