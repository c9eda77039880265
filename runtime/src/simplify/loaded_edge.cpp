// SPDX-License-Identifier: BSD-3-Clause
//
// Tests of the shapes around an edge.
//
// Based on: M. Garland and P. Heckbert, Surface simplification using quadric error metrics, 1997, section 4.3 (no
// flips), here in any dimension.
#include "simplify/loaded_edge.hpp"

#include <algorithm>
#include <limits>

namespace tegl::detail {
namespace {

/// Minimum cosine of the angle by which a normal may turn: 78 degrees.
constexpr double kLeastCosine = 0.2;
/// Simplices of at least this shape are accepted whatever the shapes before. Those at or below kFlatShape count as
/// flat.
template <int N>
constexpr double kGoodShape = N == 4 ? 0.01 : 0.05;
constexpr double kFlatShape = 1e-6;

}  // namespace

template <int N>
void LoadedEdge<N>::load(CollapsibleComplex<N>& complex, const Buffer<PointN<N>>& scaled, Index u, Index v) {
  if (complex_ != nullptr && edge_.u == u && edge_.v == v) return;
  complex_ = &complex;
  scaled_ = scaled.data();
  complex.load(u, v, edge_);
  keeps_topology_.reset();
  worst_shape_.reset();
  is_measured_.assign((size_around() + kEdgeLanes - 1) / kEdgeLanes, 0);
  if (around_.size() < is_measured_.size()) around_.resize(is_measured_.size());
}

/// Measured only when they are used: many contractions fail at the first simplices.
template <int N>
auto LoadedEdge<N>::around(std::size_t group) -> const SimplexLanes<N>& {
  SimplexLanes<N>& lanes = around_[group];
  if (is_measured_[group] != 0) return lanes;
  is_measured_[group] = 1;
  const std::size_t of_u = edge_.only_u.size(), of_v = edge_.only_v.size();
  for (std::size_t k = 0; k < kEdgeLanes; ++k) {
    const std::size_t i = std::min(group * kEdgeLanes + k, size_around() - 1);  // the last group repeats the last one
    const Index s = i < of_u ? edge_.only_u[i] : i < of_u + of_v ? edge_.only_v[i - of_u] : edge_.both[i - of_u - of_v];
    const auto& simplex = complex_->simplex(s);
    const Index end = i < of_u ? edge_.u : edge_.v;
    lanes.moving[k] = 0.0;
    for (int corner = 0; corner < N; ++corner) {
      lanes.set_corner(k, corner, scaled_[simplex[corner]]);
      if (simplex[corner] == end) lanes.moving[k] = corner;
    }
  }
  measure_lanes<N>(lanes);
  return lanes;
}

template <int N>
double LoadedEdge<N>::worst_shape() {
  if (!worst_shape_) {
    worst_shape_ = std::numeric_limits<double>::infinity();
    for (std::size_t group = 0; group < is_measured_.size(); ++group)
      for (const double shape : around(group).before.shape) worst_shape_ = std::min(*worst_shape_, shape);
  }
  return *worst_shape_;
}

template <int N>
PointN<N> LoadedEdge<N>::normal_around() {
  PointN<N> sum{};
  for (std::size_t i = 0; i < size_around(); ++i)
    for (int a = 0; a < N; ++a) sum[a] += around(i / kEdgeLanes).before.normal[a][i % kEdgeLanes];
  return sum;
}

/// Whether a simplex is neither flipped nor degraded when its vertex moves. `after`: its group after that.
template <int N>
bool LoadedEdge<N>::keeps_shape(std::size_t number, const ShapeLanes<N>& after) {
  const std::size_t k = number % kEdgeLanes;
  const ShapeLanes<N>& before = around(number / kEdgeLanes).before;
  // a flat simplex may stay flat if it gets no flatter
  const bool was_flat = before.shape[k] <= kFlatShape;
  if (after.shape[k] <= kFlatShape) return was_flat && after.shape[k] >= before.shape[k];
  // orientation: against the mean normal if it was flat, else against its own
  const auto normal_of_lane = [&](const ShapeLanes<N>& lanes) {
    PointN<N> normal;
    for (int a = 0; a < N; ++a) normal[a] = lanes.normal[a][k];
    return normal;
  };
  const PointN<N> normal = normal_of_lane(after);
  if (was_flat) {
    if (!(dot(normal, normal_around()) > 0.0)) return false;
  } else if (!(dot(normal, normal_of_lane(before)) > kLeastCosine * before.length[k] * after.length[k])) {
    return false;
  }
  // shape: good, or no worse than the worst one around the edge
  return after.shape[k] >= kGoodShape<N> || after.shape[k] >= worst_shape();
}

template <int N>
bool LoadedEdge<N>::keeps_shapes(const PointN<N>& place) {
  const std::size_t of_u = edge_.only_u.size(), of_both = of_u + edge_.only_v.size();
  const auto keep = [&](std::size_t from, std::size_t to) {
    ShapeLanes<N> after;
    for (std::size_t i = from; i < to; ++i) {
      if (i == from || i % kEdgeLanes == 0) move_lanes<N>(around(i / kEdgeLanes), place, after);
      if (!keeps_shape(i, after)) return false;
    }
    return true;
  };
  return (place == scaled_[edge_.u] || keep(0, of_u)) && (place == scaled_[edge_.v] || keep(of_u, of_both));
}

template <int N>
bool LoadedEdge<N>::is_contractible(const PointN<N>& place) {
  if (edge_.both.empty() || keeps_topology_ == false || !keeps_shapes(place)) return false;
  if (!keeps_topology_) keeps_topology_ = complex_->is_contractible(edge_, scratch_);
  return *keeps_topology_;
}

template <int N>
void LoadedEdge<N>::contract() {
  complex_->contract(edge_, scratch_);
  drop();
}

template class LoadedEdge<2>;
template class LoadedEdge<3>;
template class LoadedEdge<4>;

}  // namespace tegl::detail
