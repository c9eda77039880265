// SPDX-License-Identifier: BSD-3-Clause
//
// Hyperplanes in N-space, and Cartesian coordinates in them.
#pragma once

#include <array>
#include <type_traits>

#include "tegl/contour.hpp"
#include "tegl/dimensions.hpp"
#include "tegl/vector.hpp"

namespace tegl {

/// The points x with <normal, x> = offset. The normal may have any non-zero length; its side is "above".
template <int N>
requires DimensionBetween<N, 2, 5>
struct Hyperplane {
  Vector<N> normal = unit_vector<N>(N - 1);  ///< of any non-zero length
  double offset = 0.0;                       ///< its signed distance from 0, times the length of the normal

  /// The hyperplane x_axis = at. Throws InvalidArgument for an axis other than 0 to N - 1.
  [[nodiscard]] static Hyperplane across(int axis, double at);
};

/// Orthonormal coordinates in a hyperplane: y is the point origin + y_0 axes[0] + ... + y_{N-2} axes[N - 2].
///
/// The frame depends only on the hyperplane. Let e_k be the axis closest to the normal (the last one if several are).
/// The frame's axes are the other axes in their order, rotated by the smallest rotation that takes e_k to the normal,
/// or to its opposite if that is closer. For a hyperplane across a coordinate axis, the frame is therefore exactly the
/// other axes. The frame changes continuously with the normal while k stays the same.
template <int N>
requires DimensionBetween<N, 2, 5>
struct HyperplaneFrame {
  std::array<Vector<N>, N - 1> axes = {};  ///< unit vectors
  Vector<N> origin = {};                   ///< the point of the hyperplane nearest to 0
  Vector<N> up = unit_vector<N>(N - 1);    ///< the unit normal
  int dropped = N - 1;                     ///< k
  bool is_right_handed = true;             ///< whether det[axes, up] is +1 (right-handed), not -1

  /// The point of N-space with hyperplane coordinates y.
  [[nodiscard]] Vector<N> to_space(const Vector<N - 1>& y) const noexcept {
    Vector<N> x;
    for (std::size_t a = 0; a < N; ++a) {
      double sum = axes[0][a] * y[0];
      for (std::size_t i = 1; i < N - 1; ++i) sum += axes[i][a] * y[i];
      x[a] = origin[a] + sum;
    }
    return x;
  }
  /// Hyperplane coordinates of the orthogonal projection of a point.
  [[nodiscard]] Vector<N - 1> to_plane(const Vector<N>& x) const noexcept {
    Vector<N - 1> y;
    for (std::size_t i = 0; i < N - 1; ++i) {
      double sum = axes[i][0] * x[0];
      for (std::size_t a = 1; a < N; ++a) sum += axes[i][a] * x[a];
      y[i] = sum;
    }
    return y;
  }
};

/// The frame of a hyperplane. Lengths and angles are measured in the coordinates as given. If axes have different units
/// (mm and s), call `scale_axes` first to define how they compare. N = 2 to 5. Throws InvalidArgument if the normal is
/// 0 or not finite, or the offset is not finite.
template <int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] HyperplaneFrame<N> frame_of(const Hyperplane<N>& hyperplane);

/// The contour with the coordinates along each axis multiplied by a positive factor. Normals are transformed to normals
/// of the scaled contour; names, units, attributes and simplices are unchanged. Pass the contour by std::move to scale
/// it without a copy. N = 2 to 5. Throws InvalidArgument for other factors. O(#V).
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Contour<N, Real> scale_axes(Contour<N, Real> contour, const std::type_identity_t<Vector<N>>& factors);

}  // namespace tegl
