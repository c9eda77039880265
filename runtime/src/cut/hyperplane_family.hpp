// SPDX-License-Identifier: BSD-3-Clause
//
// A family of parallel hyperplanes, used by all cutting functions: heights of vertices, levels of hyperplanes, and
// coordinates within them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/slice_at.hpp"
#include "tegl/hyperplane.hpp"

namespace tegl::detail {

/// The hyperplanes with a given normal. If the normal is parallel to a coordinate axis, heights are that coordinate or
/// its negative, and points keep the other coordinates exactly. Otherwise heights are <normal, x>, summed in the order
/// of the axes, with the normal divided by the power of two that brings its largest component between 1 and 2. So
/// neither large nor small normals overflow or underflow, and the scaling adds no rounding error. The combinatorial cut
/// depends only on the order of heights, so rounding does no harm.
template <int N>
class HyperplaneFamily {
 public:
  /// Throws InvalidArgument as `frame_of` does.
  explicit HyperplaneFamily(const Vector<N>& normal) : frame_(frame_of(Hyperplane<N>{normal, 0.0})), normal_(normal) {
    int others = 0;
    for (int a = 0; a < N; ++a) others += a != frame_.dropped && normal[a] != 0.0;
    is_across_axis_ = others == 0;
    const int exponent = std::ilogb(normal[frame_.dropped]);
    for (int a = 0; a < N; ++a) normal_[a] = std::scalbn(normal[a], -exponent);
    unit_ = is_across_axis_ ? std::abs(normal[frame_.dropped]) : std::scalbn(1.0, exponent);
    is_reversed_ = normal[frame_.dropped] < 0.0;
    if (is_across_axis_) normal_[frame_.dropped] = sign();
  }

  /// The height of the hyperplane <normal, x> = offset, rounded as the heights of vertices.
  template <class Real>
  [[nodiscard]] double level(double offset) const {
    constexpr double kMost = std::numeric_limits<double>::max();
    const double within =
        std::clamp(rounded_at<double>(offset) / unit_, -kMost, kMost);  // the quotient may be infinite
    return is_across_axis_ ? static_cast<double>(rounded_at<Real>(within)) : within;
  }

  template <class Real>
  [[nodiscard]] double height(const std::array<Real, N>& x) const {
    if (is_across_axis_) {
      const auto here = static_cast<double>(x[frame_.dropped]);
      return is_reversed_ ? -here : here;
    }
    double sum = 0.0;
    for (int a = 0; a < N; ++a) sum += normal_[a] * static_cast<double>(x[a]);
    return sum;
  }

  /// Heights are <normal, x>.
  [[nodiscard]] const Vector<N>& normal() const noexcept { return normal_; }
  /// The point of the hyperplane at a height that is nearest to 0.
  [[nodiscard]] Vector<N> origin(double level) const {
    double square = 0.0;
    for (const double part : normal_) square += part * part;
    Vector<N> point;
    for (int a = 0; a < N; ++a) point[a] = normal_[a] * (level / square);
    return point;
  }
  /// The offset of the hyperplane at height 1; heights are offsets divided by it.
  [[nodiscard]] double unit() const noexcept { return unit_; }

  /// Components of a vector of N-space within the hyperplanes.
  [[nodiscard]] std::array<double, N - 1> within(const std::array<double, N>& x) const {
    std::array<double, N - 1> result;
    if (is_across_axis_) {
      for (int a = 0, i = 0; a < N; ++a)
        if (a != frame_.dropped) result[i++] = x[a];
      return result;
    }
    for (int i = 0; i < N - 1; ++i) {
      result[i] = 0.0;
      for (int a = 0; a < N; ++a) result[i] += frame_.axes[i][a] * x[a];
    }
    return result;
  }

  /// Whether the i-th coordinate of the cut is a coordinate of the contour: that of the i-th axis that is not dropped.
  [[nodiscard]] bool keeps_axis(int i) const { return normal_[i < dropped_axis() ? i : i + 1] == 0.0; }
  /// Whether the normal is a multiple of an axis, which is the dropped axis.
  [[nodiscard]] bool is_across_axis() const noexcept { return is_across_axis_; }
  /// Whether the normal is a positive multiple of the last axis.
  [[nodiscard]] bool is_along_last_axis() const noexcept {
    return is_across_axis_ && !is_reversed_ && frame_.dropped == N - 1;
  }
  /// For normals that are a multiple of an axis: 1 if it is positive, else -1. A coordinate is a height times this.
  [[nodiscard]] double sign() const noexcept { return is_reversed_ ? -1.0 : 1.0; }
  [[nodiscard]] int dropped_axis() const noexcept { return frame_.dropped; }
  [[nodiscard]] bool is_right_handed() const noexcept { return frame_.is_right_handed; }

 private:
  HyperplaneFrame<N> frame_;
  Vector<N> normal_;
  bool is_across_axis_ = false;
  bool is_reversed_ = false;
  double unit_ = 1.0;
};

}  // namespace tegl::detail
