// SPDX-License-Identifier: BSD-3-Clause
//
// From places in the grid to the world: axis coordinates, then the affine map, then the output's type.
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

/// Writes vertices. The same arithmetic in the same order for every vertex, whichever pass it comes
/// from and in whichever dimension: see the build's -ffp-contract=off.
template <int N, class Real>
class Placement {
 public:
  using Index = std::array<std::size_t, N>;
  using Vertex = std::array<Real, N>;

  /// `keeps_off_layers`, N = 3 or 4: see inside_slab.
  explicit Placement(const Grid<N>& grid, bool keeps_off_layers = N == 4)
      : linear_(grid.linear), offset_(grid.offset), mapped_(grid.has_world_map()) {
    // The arithmetic along a row takes the numbers of samples for 32-bit integers.
    is_uniform_ = grid.axes[0].is_uniform() && grid.axes[0].size() < std::numeric_limits<std::int32_t>::max();
    if (is_uniform_) {
      origin_ = grid.axes[0].origin();
      step_ = grid.axes[0].step();
    }
    for (int a = 0; a < N; ++a) {
      coordinates_[a].resize(grid.axes[a].size());
      for (std::size_t i = 0; i < coordinates_[a].size(); ++i) coordinates_[a][i] = grid.axes[a][i];
    }
    if (keeps_off_layers) find_insides();
  }

  /// Null: none are wanted.
  [[nodiscard]] const NormalWriter<N, Real>* normals() const noexcept { return normals_ ? &*normals_ : nullptr; }
  void want_normals(const SampleSource<N>& source, const Grid<N>& grid, const ExtractOptions& options) {
    normals_.emplace(source, grid, options.direction, options.gradient);
  }

  [[nodiscard]] double sample(int axis, std::size_t i) const noexcept { return coordinates_[axis][i]; }

  /// The coordinate at the share x of the way from sample i to i + 1; exact at both ends, never outside.
  [[nodiscard]] double between(int axis, std::size_t i, double x) const noexcept {
    const double a = coordinates_[axis][i];
    const double b = coordinates_[axis][i + 1];
    const double p = a + x * (b - a);
    return x >= 1.0 ? b : std::clamp(p, std::min(a, b), std::max(a, b));
  }

  /// A point given by its axis coordinates.
  [[nodiscard]] Vertex world(const std::array<double, N>& point) const noexcept {
    Vertex vertex;
    if (!mapped_) {
      for (int a = 0; a < N; ++a) vertex[a] = static_cast<Real>(point[a]);
      return vertex;
    }
    for (int a = 0; a < N; ++a) {
      double sum = 0;
      for (int b = 0; b < N; ++b) sum += linear_(a, b) * point[b];
      vertex[a] = static_cast<Real>(sum + offset_(a));
    }
    return vertex;
  }

  /// A point of a cell along the axes of `frame`'s mask, based at `base`, from its place in the cell.
  template <class Frame>
  [[nodiscard]] Vertex in_cell(const Index& base, const std::array<double, Frame::kDim>& place) const noexcept {
    std::array<double, N> point;
    for (int a = 0; a < N; ++a) point[a] = place_or_sample<Frame>(a, base[a], place);
    return Frame::axes().empty() || Frame::axes().back() != N - 1 ? world(point)
                                                                  : inside_slab(world(point), base[N - 1]);
  }

  /// Completes what is known of edges in layer k, and writes their points.
  void edges(std::size_t k, EdgePoints<N, Real>& edges) const noexcept {
    edges.layer = sample(N - 1, k);
    edges.next_layer = edges.axis == N - 1 ? sample(N - 1, k + 1) : 0.0;
    edges.along = is_uniform_ ? nullptr : coordinates_[0].data();
    edges.origin = origin_;
    edges.step = step_;
    edges.linear = mapped_ ? linear_.data() : nullptr;
    edges.offset = offset_.data();
    edges.inside.fill(std::numeric_limits<Real>::quiet_NaN());
    if (edges.axis == N - 1 && !insides_.empty()) edges.inside = insides_[k];
    write_points<N, Real>(edges);
  }

 private:
  /// A point between layers k and k + 1, kept off both by the least that shows in its type: in 4D, and in 3D for cuts
  /// at a layer straight from the image. Where samples equal the isovalue (or almost), points between layers would fall
  /// into a layer, and a cut there could not tell them from the layer's own points (`slice`).
  Vertex inside_slab(Vertex vertex, std::size_t k) const noexcept {
    if constexpr (N == 3 || N == 4)
      if (!insides_.empty()) vertex[N - 1] = std::clamp(vertex[N - 1], insides_[k][0], insides_[k][1]);
    return vertex;
  }

  /// The last coordinates that points in each slab may have: of grids whose last axis is apart, and slabs with room.
  void find_insides() {
    for (int a = 0; a < N - 1; ++a)
      if (linear_(N - 1, a) != 0) return;
    const auto layer = [this](std::size_t k) {
      std::array<double, N> point{};
      point[N - 1] = coordinates_[N - 1][k];
      return world(point)[N - 1];
    };
    for (std::size_t k = 0; k + 1 < coordinates_[N - 1].size(); ++k) {
      const auto [low, high] = std::minmax({layer(k), layer(k + 1)});
      const Real least = (high - low) * (std::numeric_limits<Real>::epsilon() / 2);
      std::array<Real, 2> inside{std::max(std::nextafter(low, high), low + least),
                                 std::min(std::nextafter(high, low), high - least)};
      if (inside[0] > inside[1]) inside = {low, high};
      insides_.push_back(inside);
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
  Eigen::Matrix<double, N, N, Eigen::RowMajor> linear_;
  Eigen::Matrix<double, N, 1> offset_;
  bool is_uniform_;  ///< axis 0
  double origin_ = 0.0, step_ = 0.0;
  bool mapped_;
  std::vector<std::array<Real, 2>> insides_;  ///< by slab; none: points may be anywhere
  std::optional<NormalWriter<N, Real>> normals_;
};

}  // namespace tegl::detail
