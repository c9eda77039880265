// SPDX-License-Identifier: BSD-3-Clause
//
// Maps grid positions to the world: axis coordinates, then the affine map, then conversion to the output's type.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "kernel/extract_layers.hpp"
#include "kernel/extract_normals.hpp"
#include "kernel/extract_points.hpp"
#include "tegl/extract.hpp"
#include "tegl/grid.hpp"

namespace tegl::detail {

/// Writes vertices. All passes and dimensions use the same arithmetic in the same order (requires -ffp-contract=off,
/// which the build sets).
template <int N, class Real>
class Placement {
 public:
  using Index = std::array<std::size_t, N>;
  using Vertex = std::array<Real, N>;

  /// `keeps_off_layers`: see inside_slab; N >= 3.
  explicit Placement(const Grid<N>& grid, bool keeps_off_layers = N >= 4)
      : linear_(grid.linear), offset_(grid.offset), mapped_(grid.has_world_map()) {
    // The arithmetic along a row uses 32-bit sample indices.
    is_uniform_ = grid.axes[0].is_uniform() && grid.axes[0].size() < std::numeric_limits<std::int32_t>::max();
    if (is_uniform_) {
      origin_ = grid.axes[0].origin();
      step_ = grid.axes[0].step();
    }
    for (int a = 0; a < N; ++a) {
      coordinates_[a].resize(grid.axes[a].size());
      for (std::size_t i = 0; i < coordinates_[a].size(); ++i) coordinates_[a][i] = grid.axes[a][i];
    }
    for (int a = N == 5 ? N - 2 : N - 1; keeps_off_layers && a < N; ++a) find_insides(a);
  }

  /// Null if no normals were requested.
  [[nodiscard]] const NormalWriter<N, Real>* normals() const noexcept { return normals_ ? &*normals_ : nullptr; }
  void want_normals(const SampleGradients<N>& source, const Grid<N>& grid, const ExtractOptions& options) {
    normals_.emplace(source, grid, options.direction, options.normals, options.kernel);
  }

  [[nodiscard]] double sample(int axis, std::size_t i) const noexcept { return coordinates_[axis][i]; }

  /// Coordinate at the fraction x of the way from sample i to i + 1. Exact at both ends, never outside.
  [[nodiscard]] double between(int axis, std::size_t i, double x) const noexcept {
    return between(coordinates_[axis][i], coordinates_[axis][i + 1], x);
  }

  /// World position of a point given by axis coordinates.
  [[nodiscard, gnu::always_inline]] Vertex world(const std::array<double, N>& point) const noexcept {
    Vertex vertex;
    if (!mapped_) {
      for (int a = 0; a < N; ++a) vertex[a] = static_cast<Real>(point[a]);
      return vertex;
    }
    for (int a = 0; a < N; ++a) {
      double sum = 0;
      for (int b = 0; b < N; ++b) sum += linear_[a][b] * point[b];
      vertex[a] = static_cast<Real>(sum + offset_[a]);
    }
    return vertex;
  }

  /// Position of a point in the cell at `base` along the axes of `Frame`; `place`: coordinates within the cell.
  template <class Frame>
  [[nodiscard]] Vertex in_cell(const Index& base, const std::array<double, Frame::kDim>& place) const noexcept {
    std::array<double, N> point;
    for (int a = 0; a < N; ++a) point[a] = place_or_sample<Frame>(a, base[a], place);
    return Frame::axes().empty() || Frame::axes().back() != N - 1 ? world(point)
                                                                  : inside_slab(world(point), base[N - 1]);
  }

  /// Keeps a point between layers k and k + 1 off both layers by the smallest difference that its type represents. Used
  /// from 4D on, and in 3D for slices at a layer directly from the image. If samples (almost) equal the isovalue,
  /// points between layers would coincide with a layer, and `slice` could not distinguish them from the layer's own
  /// points. In 5D also for layers of the axis before the last one, so that slices have the points of 4D contours.
  [[nodiscard]] Vertex inside_slab(Vertex vertex, std::size_t k, int axis = N - 1) const noexcept {
    if constexpr (N >= 3)
      if (const auto& insides = insides_[static_cast<std::size_t>(axis)]; !insides.empty())
        vertex[axis] = clamped(vertex[axis], insides[k][0], insides[k][1]);
    return vertex;
  }

  /// As in_cell along all axes, for several points in one cell, whose corners are looked up once.
  class Cell {
   public:
    Cell(const Placement& placement, const Index& base) noexcept : placement_(placement), slab_(base[N - 1]) {
      for (int a = 0; a < N; ++a) {
        from_[a] = placement.coordinates_[a][base[a]];
        to_[a] = placement.coordinates_[a][base[a] + 1];
      }
    }
    [[nodiscard]] Vertex operator()(const std::array<double, N>& place) const noexcept { return at(on_axes(place)); }
    /// The two parts of this: axis coordinates of a place in the cell, and the position of a point given by these.
    [[nodiscard]] std::array<double, N> on_axes(const std::array<double, N>& place) const noexcept {
      std::array<double, N> point;
      for (int a = 0; a < N; ++a) point[a] = between(from_[a], to_[a], place[a]);
      return point;
    }
    [[nodiscard]] Vertex at(const std::array<double, N>& point) const noexcept {
      return placement_.inside_slab(placement_.world(point), slab_);
    }
    [[nodiscard]] const std::array<double, N>& from() const noexcept { return from_; }
    [[nodiscard]] const std::array<double, N>& to() const noexcept { return to_; }

   private:
    const Placement& placement_;
    std::size_t slab_;
    std::array<double, N> from_, to_;
  };

  /// Completes the description of edges in layer k and writes their vertices.
  void edges(std::size_t k, EdgePoints<N, Real>& edges) const noexcept {
    edges.layer = sample(N - 1, k);
    edges.next_layer = edges.axis == N - 1 ? sample(N - 1, k + 1) : 0.0;
    edges.along = is_uniform_ ? nullptr : coordinates_[0].data();
    edges.origin = origin_;
    edges.step = step_;
    edges.linear = mapped_ ? linear_[0].data() : nullptr;
    edges.offset = offset_.data();
    edges.inside.fill(std::numeric_limits<Real>::quiet_NaN());
    if (edges.axis == N - 1 && !insides_[N - 1].empty()) edges.inside = insides_[N - 1][k];
    write_points<N, Real>(edges);
  }

 private:
  [[nodiscard]] static double between(double a, double b, double x) noexcept {
    const double p = a + x * (b - a);
    return x >= 1.0 ? b : clamped(p, std::min(a, b), std::max(a, b));
  }
  /// std::clamp without branches, which noise makes hard to predict.
  template <class T>
  [[nodiscard]] static T clamped(T x, T least, T most) noexcept {
    x = least > x ? least : x;
    return x > most ? most : x;
  }

  /// Determines the range of the coordinate along an axis for each slab. Only for grids whose axis is not mixed with
  /// others by the world map; slabs too thin for it keep their full range.
  void find_insides(int axis) {
    for (int a = 0; a < N; ++a)
      if (a != axis && linear_[axis][a] != 0) return;
    const auto layer = [&](std::size_t k) {
      std::array<double, N> point{};
      point[axis] = coordinates_[axis][k];
      return world(point)[axis];
    };
    for (std::size_t k = 0; k + 1 < coordinates_[axis].size(); ++k) {
      const auto [low, high] = std::minmax({layer(k), layer(k + 1)});
      const Real least = (high - low) * (std::numeric_limits<Real>::epsilon() / 2);
      std::array<Real, 2> inside{std::max(std::nextafter(low, high), low + least),
                                 std::min(std::nextafter(high, low), high - least)};
      if (inside[0] > inside[1]) inside = {low, high};
      insides_[axis].push_back(inside);
    }
  }

  template <class Frame>
  double place_or_sample(int axis, std::size_t i, const std::array<double, Frame::kDim>& place) const noexcept {
    constexpr auto kAxes = Frame::axes();
    for (std::size_t j = 0; j < kAxes.size(); ++j)
      if (kAxes[j] == axis) return between(axis, i, place[j]);
    return sample(axis, i);
  }

  std::array<std::vector<double>, N> coordinates_;
  Matrix<N> linear_;
  Vector<N> offset_;
  bool is_uniform_;  ///< coordinates on axis 0 are equidistant
  double origin_ = 0.0, step_ = 0.0;
  bool mapped_;
  std::array<std::vector<std::array<Real, 2>>, N> insides_;  ///< by axis and slab; empty: no restriction
  std::optional<NormalWriter<N, Real>> normals_;
};

}  // namespace tegl::detail
