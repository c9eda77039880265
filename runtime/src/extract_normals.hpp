// SPDX-License-Identifier: BSD-3-Clause
//
// Normals of vertices: the image's gradient there, in the world, of length 1.
// Based on: M. Liversage, thesis, 1994, section 8.2. Vertices that are not on edges of the grid (barycentres, corners
// of caps) have the gradient at the corners of their cell, interpolated multilinearly: on edges that is the same.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <Eigen/LU>

#include "gradient.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

template <int N, class Real>
class NormalWriter {
 public:
  using Index = std::array<std::size_t, N>;
  using Vertex = std::array<Real, N>;

  NormalWriter(std::unique_ptr<const GradientField<N>> field, const Grid<N>& grid, GradientDirection direction)
      : field_(std::move(field)), to_world_(Eigen::Matrix<double, N, N>::Identity()), mapped_(grid.has_world_map()) {
    // Gradients are covectors: the inverse transpose carries them along.
    if (mapped_) to_world_ = grid.linear.inverse().transpose();
    if (direction == GradientDirection::descent) to_world_ = -to_world_;
    sign_ = direction == GradientDirection::descent ? -1.0 : 1.0;
  }

  /// As Placement::edges.
  void edges(const Index& start, int axis, const std::uint32_t* at, std::size_t count, const double* alphas,
             Vertex* out) const noexcept {
    constexpr std::size_t kAtOnce = 64;
    std::array<std::array<double, N>, kAtOnce> gradients;
    for (std::size_t i = 0; i < count; i += kAtOnce) {
      const std::size_t some = std::min(kAtOnce, count - i);
      field_->on_edges(start, axis, at + i, some, alphas + i, gradients.data());
      for (std::size_t j = 0; j < some; ++j) out[i + j] = normal(gradients[j]);
    }
  }

  /// As Placement::in_cell.
  template <class Frame>
  [[nodiscard]] Vertex in_cell(const Index& base, const std::array<double, Frame::kDim>& place) const noexcept {
    std::array<double, N> sum{};
    for (unsigned corner = 0; corner < 1u << Frame::kDim; ++corner) {
      double weight = 1.0;
      for (int j = 0; j < Frame::kDim; ++j) weight *= (corner >> j & 1u) != 0 ? place[j] : 1.0 - place[j];
      if (weight == 0.0) continue;
      Index index = base;
      for (int a = 0; a < N; ++a) index[a] += Frame::spread(corner) >> a & 1u;
      const auto gradient = field_->at(index);
      for (int a = 0; a < N; ++a) sum[a] += weight * gradient[a];
    }
    return normal(sum);
  }

 private:
  /// 0 where the gradient vanishes.
  [[nodiscard]] Vertex normal(const std::array<double, N>& gradient) const noexcept {
    std::array<double, N> v;
    double square = 0.0;
    for (int a = 0; a < N; ++a) {
      if (mapped_) {
        v[a] = 0.0;
        for (int b = 0; b < N; ++b) v[a] += to_world_(a, b) * gradient[b];
      } else {
        v[a] = sign_ * gradient[a];
      }
      square += v[a] * v[a];
    }
    if (!(square > 1e-280 && square < 1e280)) square = scaled(v);
    const double inverse = square > 0.0 ? 1.0 / std::sqrt(square) : 0.0;
    Vertex result;
    for (int a = 0; a < N; ++a) result[a] = static_cast<Real>(v[a] * inverse);
    return result;
  }

  /// Brings the largest component to 1, if there is one; returns the square of the length.
  static double scaled(std::array<double, N>& v) noexcept {
    double largest = 0.0;
    for (const double x : v) largest = std::max(largest, std::abs(x));
    double square = 0.0;
    for (double& x : v) {
      x = largest > 0.0 ? x / largest : 0.0;
      square += x * x;
    }
    return square;
  }

  std::unique_ptr<const GradientField<N>> field_;
  Eigen::Matrix<double, N, N> to_world_;
  bool mapped_;
  double sign_;
};

}  // namespace tegl::detail
