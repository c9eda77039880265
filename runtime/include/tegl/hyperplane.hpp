// SPDX-License-Identifier: BSD-3-Clause
//
// Hyperplanes of N-space, and coordinates in them.
#pragma once

#include <Eigen/Core>

#include "tegl/contour.hpp"

namespace tegl {

/// The points x with <normal, x> = offset. The normal may have any length but 0; the side that it points to is above.
template <int N>
requires DimensionBetween<N, 2, 4>
struct Hyperplane {
  using Vector = Eigen::Matrix<double, N, 1>;  ///< components by axis
  Vector normal = Vector::Unit(N - 1);         ///< a, of any length but 0
  double offset = 0.0;                         ///< b

  /// x_axis = at.
  static Hyperplane across(int axis, double at) { return {Vector::Unit(axis), at}; }
};

/// Orthonormal coordinates in a hyperplane: y stands for the point `origin + axes * y`.
///
/// The frame depends on the hyperplane alone. Let e_k be the axis that its normal is nearest to (the last of several).
/// The frame's axes are the others, in their order, turned by the least rotation that takes e_k to the normal, or to
/// its opposite if that is nearer. So across a coordinate axis the frame is the other axes themselves, to the last bit;
/// and it changes continuously with the normal as long as k stays the same.
template <int N>
requires DimensionBetween<N, 2, 4>
struct HyperplaneFrame {
  Eigen::Matrix<double, N, N - 1> axes;  ///< column = axis
  Eigen::Matrix<double, N, 1> origin;    ///< the hyperplane's point nearest to 0
  Eigen::Matrix<double, N, 1> up;        ///< the normal, of length 1
  int dropped = N - 1;                   ///< k
  bool is_right_handed = true;           ///< whether det[axes, up] is 1, and not -1

  /// A point of the hyperplane in N-space.
  [[nodiscard]] Eigen::Matrix<double, N, 1> to_space(const Eigen::Matrix<double, N - 1, 1>& y) const {
    return origin + axes * y;
  }
  /// The foot of a point's perpendicular to the hyperplane, in the hyperplane's coordinates.
  [[nodiscard]] Eigen::Matrix<double, N - 1, 1> to_plane(const Eigen::Matrix<double, N, 1>& x) const {
    return axes.transpose() * x;
  }
};

/// Lengths and right angles are those of the coordinates as they are: where axes have different units (mm and s), say
/// by `scale_axes` first how much of one is as long as how much of the other. N = 2, 3, 4.
/// Throws InvalidArgument if the normal is 0 or not finite, or the offset not finite.
template <int N>
requires DimensionBetween<N, 2, 4> HyperplaneFrame<N> frame_of(const Hyperplane<N>& hyperplane);

/// Multiplies the coordinates along each axis by a factor above 0. Normals are made those of the stretched contour;
/// names, units, attributes and simplices stay. N = 2, 3, 4. Throws InvalidArgument for other factors. O(#V).
template <int N, class Real>
requires DimensionBetween<N, 2, 4>
void scale_axes(Contour<N, Real>& contour, const Eigen::Matrix<double, N, 1>& factors);

}  // namespace tegl
