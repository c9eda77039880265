// SPDX-License-Identifier: BSD-3-Clause
//
// Coordinate frames of hyperplanes, and scaling of axes.
#include "tegl/hyperplane.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/slice_at.hpp"
#include "tegl/eigen.hpp"
#include "tegl/error.hpp"

namespace tegl {

template <int N>
requires DimensionBetween<N, 2, 5> Hyperplane<N> Hyperplane<N>::across(int axis, double at) {
  detail::require_cut_axis<N>(axis);
  return {unit_vector<N>(axis), at};
}

template <int N>
requires DimensionBetween<N, 2, 5> HyperplaneFrame<N> frame_of(const Hyperplane<N>& hyperplane) {
  using Column = Eigen::Matrix<double, N, 1>;
  const Column normal = as_eigen(hyperplane.normal);
  double most = normal.cwiseAbs().maxCoeff();
  if (!normal.allFinite() || !(most > 0.0))
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("normal of a hyperplane that is 0 or not finite: ({}); expected finite numbers that are not "
                    "all 0",
                    fmt::join(hyperplane.normal, ", ")));
  if (!std::isfinite(hyperplane.offset))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("slice at {}; expected a finite coordinate", hyperplane.offset));
  HyperplaneFrame<N> frame;
  for (int a = 0; a < N; ++a)
    if (std::abs(normal[a]) == most) frame.dropped = a;
  // Divide by the largest component first, so that the length neither overflows nor vanishes.
  const Column shrunk = normal / most;
  const double length = shrunk.norm();
  const Column up = shrunk / length;
  frame.up = to_vector(up);
  as_eigen(frame.origin) = up * (hyperplane.offset / most / length);
  const int k = frame.dropped;
  const Column nearer = up[k] < 0.0 ? Column(-up) : up;
  // The rotation in the plane of e_k and u that maps one to the other maps e_i to e_i - u_i / (1 + u_k) (e_k + u).
  for (int i = 0, column = 0; i < N; ++i) {
    if (i == k) continue;
    Column axis = -(nearer[i] / (1.0 + nearer[k])) * nearer;
    axis[k] -= nearer[i] / (1.0 + nearer[k]);
    axis[i] += 1.0;
    for (int a = 0; a < N; ++a) frame.axes[column][a] = axis[a] + 0.0;  // turns -0 into 0, for output
    ++column;
  }
  // A rotation preserves the sign of det[e_0 … without e_k … e_{N-1}, e_k]; N - 1 - k exchanges make that determinant
  // 1.
  frame.is_right_handed = ((N - 1 - k) % 2 == 0) == (up[k] > 0.0);
  return frame;
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Contour<N, Real> scale_axes(Contour<N, Real> contour,
                                                               const std::type_identity_t<Vector<N>>& factors) {
  for (int a = 0; a < N; ++a)
    if (!(factors[a] > 0.0) || !std::isfinite(factors[a]))
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("factor {} of axis {}; expected a finite number above 0", factors[a], a));
  for (auto& vertex : contour.vertices)
    for (int a = 0; a < N; ++a) vertex[a] = static_cast<Real>(static_cast<double>(vertex[a]) * factors[a]);
  for (Period<N>& period : contour.periods)
    for (int a = 0; a < N; ++a) {
      period.vector[a] *= factors[a];
      period.dual[a] /= factors[a];
    }
  for (auto& normal : contour.normals) {
    Eigen::Matrix<double, N, 1> turned;
    for (int a = 0; a < N; ++a) turned[a] = static_cast<double>(normal[a]) / factors[a];
    const double length = turned.norm();
    for (int a = 0; a < N; ++a) normal[a] = length > 0.0 ? static_cast<Real>(turned[a] / length) : Real{0};
  }
  return contour;
}

template struct Hyperplane<2>;
template struct Hyperplane<3>;
template struct Hyperplane<4>;
template struct Hyperplane<5>;
template HyperplaneFrame<2> frame_of(const Hyperplane<2>&);
template HyperplaneFrame<3> frame_of(const Hyperplane<3>&);
template HyperplaneFrame<4> frame_of(const Hyperplane<4>&);
template HyperplaneFrame<5> frame_of(const Hyperplane<5>&);
#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real) \
  template Contour<N, Real> scale_axes(Contour<N, Real>, const Vector<N>&);
#include "base/instantiate.hpp"

}  // namespace tegl
