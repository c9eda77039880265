// SPDX-License-Identifier: BSD-3-Clause
//
// Vertices inside of cells: means of vertices on edges and of corners.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace tegl::detail {

/// Coordinates between two layers of the last axis, as far from both as their type distinguishes; both layers if there
/// are none between.
template <class Real>
std::pair<Real, Real> inside_of(double low_layer, double high_layer) noexcept {
  const auto [low, high] = std::minmax({static_cast<Real>(low_layer), static_cast<Real>(high_layer)});
  const Real least = (high - low) * (std::numeric_limits<Real>::epsilon() / 2);
  const Real from = std::max(std::nextafter(low, high), low + least);
  const Real to = std::min(std::nextafter(high, low), high - least);
  return from > to ? std::pair{low, high} : std::pair{from, to};
}

/// Moves the last coordinate of a vertex off two layers.
template <class Real, std::size_t N>
void keep_between(double layer, double other, std::array<Real, N>& vertex) noexcept {
  const auto [low, high] = inside_of<Real>(layer, other);
  vertex[N - 1] = std::clamp(vertex[N - 1], low, high);
}

/// The point a part of the way from one to another.
template <class Real, std::size_t N>
std::array<Real, N> part_of_way(const std::array<double, N>& from, const std::array<double, N>& to,
                                double part) noexcept {
  std::array<Real, N> vertex;
  for (std::size_t i = 0; i < N; ++i) vertex[i] = static_cast<Real>(from[i] * (1 - part) + to[i] * part);
  return vertex;
}

/// The mean of points, within their bounds; in complexes whose cells are between layers, between these and off both.
/// The sum, and so its rounding, depends on the order of the points.
template <int N, class Real>
class VertexMean {
 public:
  using Point = std::array<double, N>;
  using Vertex = std::array<Real, N>;

  VertexMean() {
    lowest_.fill(std::numeric_limits<double>::infinity());
    highest_.fill(-std::numeric_limits<double>::infinity());
  }
  void add(const Point& point) noexcept {
    for (std::size_t i = 0; i < N; ++i) {
      sum_[i] += point[i];
      lowest_[i] = std::min(lowest_[i], point[i]);
      highest_[i] = std::max(highest_[i], point[i]);
    }
    ++count_;
  }
  void add_normal(const Vertex& normal) noexcept {
    for (std::size_t i = 0; i < N; ++i) normal_[i] += double{normal[i]};
  }
  /// Adds the layer of a corner, or of an end of an edge.
  void add_layer(double layer) noexcept {
    low_layer_ = std::min(low_layer_, layer);
    high_layer_ = std::max(high_layer_, layer);
  }

  [[nodiscard]] Point mean() const noexcept {
    Point mean;
    for (std::size_t i = 0; i < N; ++i) mean[i] = std::clamp(sum_[i] / count_, lowest_[i], highest_[i]);
    return mean;
  }
  /// The sum of the normals.
  [[nodiscard]] const Point& normal() const noexcept { return normal_; }
  [[nodiscard]] Vertex place(bool is_layered) const noexcept {
    Vertex vertex;
    const Point mean = this->mean();
    for (std::size_t i = 0; i < N; ++i) vertex[i] = static_cast<Real>(mean[i]);
    if (is_layered && low_layer_ != high_layer_) keep_between(low_layer_, high_layer_, vertex);
    return vertex;
  }

 private:
  Point sum_{}, lowest_, highest_, normal_{};
  double count_ = 0;
  double low_layer_ = std::numeric_limits<double>::infinity();
  double high_layer_ = -std::numeric_limits<double>::infinity();
};

}  // namespace tegl::detail
