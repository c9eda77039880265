// SPDX-License-Identifier: BSD-3-Clause
//
// Placement and tolerances of edge contractions.
//
// Based on: M. Garland and P. Heckbert, Surface simplification using quadric error metrics, 1997, section 3 (placement,
// border planes), here in any dimension.
#include "simplify/edge_collapse.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <numeric>
#include <utility>

#include "base/progress.hpp"
#include "hwy/cache_control.h"

namespace tegl::detail {
namespace {

/// Weight of a border face relative to its simplex.
constexpr double kBorderWeight = 10.0;
/// Maximum distance of a place from the middle of the edge, in edge lengths.
constexpr double kFarthestPlace = 2.0;

constexpr double factorial(int n) { return n <= 1 ? 1.0 : n * factorial(n - 1); }

template <int N>
PointN<N> unit(const PointN<N>& vector, double length) {
  PointN<N> result;
  for (int a = 0; a < N; ++a) result[a] = vector[a] / length;
  return result;
}

}  // namespace

template <int N>
EdgeCollapse<N>::EdgeCollapse(CollapseInput<N> input)
    : complex_(input.simplices, input.points.size(), input.threads, part_of(input.progress, 0.0, 0.6),
               std::move(input.neighbours)),
      points_(std::move(input.points)),
      scaled_(points_.size()),
      scale_(input.scale),
      quadrics_(points_.size(), Quadric<N>{}),
      bound_(points_.size(), 0),
      tolerance_(std::move(input.tolerance)),
      version_(points_.size(), 0),
      merged_into_(points_.size()),
      carried_width_(input.carried_width),
      carried_(std::move(input.carried)),
      border_fixed_(input.border_fixed),
      single_precision_(input.single_precision) {
  std::iota(merged_into_.begin(), merged_into_.end(), Index{0});
  if (!points_.empty()) {
    PointN<N> low = points_[0], high = points_[0];
    for (const PointN<N>& point : points_)
      for (int a = 0; a < N; ++a) {
        low[a] = std::min(low[a], point[a]);
        high[a] = std::max(high[a], point[a]);
      }
    centre_ = between(low, high, 0.5);
  }
  for (std::size_t v = 0; v < points_.size(); ++v) {
    scaled_[v] = to_scaled(points_[v]);
    if (complex_.on_border(static_cast<Index>(v))) bound_[v] |= kBorderBit;
  }
  add_quadrics(part_of(input.progress, 0.6, input.keep_embedded ? 0.8 : 1.0));
  if (input.keep_embedded)
    embedded_ = std::make_unique<MovingSimplices<N>>(points_, input.simplices, part_of(input.progress, 0.8, 1.0));
}

template <int N>
PointN<N> EdgeCollapse<N>::to_scaled(const PointN<N>& point) const {
  PointN<N> result;
  for (int a = 0; a < N; ++a) result[a] = (point[a] - centre_[a]) * scale_[a];
  return result;
}

template <int N>
PointN<N> EdgeCollapse<N>::from_scaled(const PointN<N>& point) const {
  PointN<N> result;
  for (int a = 0; a < N; ++a) result[a] = point[a] / scale_[a] + centre_[a];
  return result;
}

template <int N>
PointN<N> EdgeCollapse<N>::rounded(PointN<N> point) const {
  if (single_precision_)
    for (double& x : point) x = static_cast<double>(static_cast<float>(x));
  return point;
}

template <int N>
CornersN<N> EdgeCollapse<N>::corners(Index s) const {
  CornersN<N> result;
  for (int i = 0; i < N; ++i) result[i] = scaled_[complex_.simplex(s)[i]];
  return result;
}

template <int N>
void EdgeCollapse<N>::add_quadrics(const Progress& progress) {
  const auto add = [&](Index s) {
    const CornersN<N> at = corners(s);
    const PointN<N> normal = normal_of<N>(at);
    const double length = norm(normal);
    if (!(length > 0.0)) return;
    const double weight = length / factorial(N - 1);
    const PointN<N> direction = unit<N>(normal, length);
    for (const Index v : complex_.simplex(s)) quadrics_[v].add_plane(direction, at[0], weight);
    if (complex_.border_faces(s) != 0) add_border_quadrics(s, at, kBorderWeight * weight);
  };
  in_parts(complex_.simplex_count(), progress, [&](std::size_t from, std::size_t to) {
    for (std::size_t s = from; s < to; ++s) add(static_cast<Index>(s));
  });
}

/// Adds the hyperplane through each border face at right angles to its simplex. These preserve the shape of borders
/// that may move.
template <int N>
void EdgeCollapse<N>::add_border_quadrics(Index s, const CornersN<N>& at, double weight) {
  for (int omitted = 0; omitted < N; ++omitted) {
    if ((complex_.border_faces(s) >> omitted & 1u) == 0) continue;
    // The component of a vector from the base corner orthogonal to the directions of the face (Gram-Schmidt).
    std::array<PointN<N>, N> basis{};
    int found = 0;
    const int base = omitted == 0 ? 1 : 0;
    const auto rest_of = [&](int corner) {
      PointN<N> way = minus(at[corner], at[base]);
      for (int k = 0; k < found; ++k) {
        const double along = dot(way, basis[k]);
        for (int a = 0; a < N; ++a) way[a] -= along * basis[k][a];
      }
      return way;
    };
    for (int i = 0; i < N; ++i) {
      if (i == omitted || i == base) continue;
      const PointN<N> way = rest_of(i);
      if (norm(way) > 0.0) basis[found++] = unit<N>(way, norm(way));
    }
    const PointN<N> height = rest_of(omitted);
    if (!(norm(height) > 0.0)) continue;
    for (int i = 0; i < N; ++i)
      if (i != omitted) quadrics_[complex_.simplex(s)[i]].add_plane(unit<N>(height, norm(height)), at[base], weight);
  }
}

template <int N>
Index EdgeCollapse<N>::survivor(Index v) {
  while (merged_into_[v] != v) v = merged_into_[v] = merged_into_[merged_into_[v]];
  return v;
}

template <int N>
bool EdgeCollapse<N>::may_move_to(Index v, Index u) const {
  if ((bound_[v] & ~bound_[u]) != 0) return false;
  return !border_fixed_ || (bound_[v] & kBorderBit) == 0;
}

template <int N>
std::optional<CollapseTarget<N>> EdgeCollapse<N>::best_target(Index u, Index v) const {
  Quadric<N> sum = quadrics_[u];
  sum += quadrics_[v];
  CollapseTarget<N> target;
  const std::uint32_t of_u = bound_[u], of_v = bound_[v];
  if (border_fixed_ && (of_u & of_v & kBorderBit) != 0) return std::nullopt;
  // equal constraints: along the edge; different ones: at an end; none: at the minimum of the quadric
  if (of_u == of_v && of_u != 0) {
    target.share = sum.least_between(scaled_[u], scaled_[v]);
    target.at = rounded(between(points_[u], points_[v], target.share));
  } else if (of_u != of_v) {
    if (!may_move_to(v, u) && !may_move_to(u, v)) return std::nullopt;
    target.share = may_move_to(v, u) ? 0.0 : 1.0;
    target.at = target.share == 0.0 ? points_[u] : points_[v];
  } else {
    const PointN<N> middle = between(scaled_[u], scaled_[v], 0.5);
    const PointN<N> edge = minus(scaled_[v], scaled_[u]);
    PointN<N> best = sum.least_near(middle);
    const double square = dot(edge, edge);
    const PointN<N> away = minus(best, middle);
    if (!(dot(away, away) <= kFarthestPlace * kFarthestPlace * square))
      best = between(scaled_[u], scaled_[v], sum.least_between(scaled_[u], scaled_[v]));
    if (square > 0.0) target.share = std::clamp(dot(minus(best, scaled_[u]), edge) / square, 0.0, 1.0);
    target.at = square > 0.0 ? rounded(from_scaled(best)) : points_[u];
  }
  target.cost = sum(to_scaled(target.at));
  return target;
}

template <int N>
void EdgeCollapse<N>::request_corners(Index u, Index v) const {
  const auto request = [&](Index s) {
    if (!complex_.is_alive(s)) return;
    for (const Index corner : complex_.simplex(s)) hwy::Prefetch(&scaled_[corner]);
  };
  for (const Index end : {u, v}) {
    complex_.visit_star(end, request);
    for (std::size_t i = 0; i < sizeof(Quadric<N>); i += 64)
      hwy::Prefetch(reinterpret_cast<const char*>(&quadrics_[end]) + i);
  }
}

template <int N>
void EdgeCollapse<N>::request_cost(Index v) const {
  for (std::size_t i = 0; i < sizeof(Quadric<N>); i += 64)
    hwy::Prefetch(reinterpret_cast<const char*>(&quadrics_[v]) + i);
  hwy::Prefetch(&scaled_[v]);
  hwy::Prefetch(&bound_[v]);
  hwy::Prefetch(&version_[v]);
}

template <int N>
void EdgeCollapse<N>::costs_around(Index u, std::span<const Index> others, std::vector<EdgeCost>& result) const {
  const TargetInput<N> input{quadrics_[u],     scaled_[u], centre_, scale_, kFarthestPlace * kFarthestPlace,
                             single_precision_};
  TargetLanes<N> lanes;
  result.clear();
  for (std::size_t first = 0; first < others.size(); first += kEdgeLanes) {
    for (std::size_t k = 0; k < kEdgeLanes; ++k) {
      const Index v = others[std::min(first + k, others.size() - 1)];
      lanes.set(k, quadrics_[v], scaled_[v], v < u);
    }
    find_target_lanes<N>(input, lanes);
    for (std::size_t k = 0; k < kEdgeLanes && first + k < others.size(); ++k) {
      const Index v = others[first + k];
      EdgeCost edge{v, lanes.cost[k], lanes.square[k]};
      if (lanes.is_far[k] != 0.0 || (bound_[u] | bound_[v]) != 0) {
        const auto target = best_target(std::min(u, v), std::max(u, v));
        if (!target) continue;
        edge.cost = target->cost;
      }
      result.push_back(edge);
    }
  }
}

template <int N>
CollapseTarget<N> EdgeCollapse<N>::target_at(Index u, Index v, const PointN<N>& at, double share) const {
  const PointN<N> scaled_at = to_scaled(at);
  return {at, share, quadrics_[u](scaled_at) + quadrics_[v](scaled_at)};
}

template <int N>
auto EdgeCollapse<N>::common_target(std::span<const Index> vertices) const -> std::optional<CommonTarget> {
  std::uint32_t all = 0;
  int of_border = 0;
  bool equal = true;
  for (const Index v : vertices) {
    all |= bound_[v];
    equal = equal && bound_[v] == bound_[vertices[0]];
    of_border += (bound_[v] & kBorderBit) != 0;
  }
  if (border_fixed_ && of_border > 1) return std::nullopt;
  // different constraints: the place of a vertex that has all of them
  if (!equal) {
    for (const Index v : vertices)
      if (bound_[v] == all) return CommonTarget{points_[v], v};
    return std::nullopt;
  }
  // Relative to the first vertex, so that a coordinate equal in all of them is exact.
  PointN<N> middle = points_[vertices[0]];
  for (const Index v : vertices)
    for (int a = 0; a < N; ++a)
      middle[a] += (points_[v][a] - points_[vertices[0]][a]) / static_cast<double>(vertices.size());
  if (all != 0) return CommonTarget{rounded(middle), std::nullopt};
  // no constraints: the minimum of the quadric, if it is near
  Quadric<N> sum;
  double size = 0.0;
  const PointN<N> from = to_scaled(middle);
  for (const Index v : vertices) {
    sum += quadrics_[v];
    size = std::max(size, norm(minus(scaled_[v], from)));
  }
  const PointN<N> best = sum.least_near(from);
  const bool near = norm(minus(best, from)) <= kFarthestPlace * size;
  return CommonTarget{rounded(near ? from_scaled(best) : middle), std::nullopt};
}

/// Whether the root mean square distance from all hyperplanes of the two vertices is within the tolerance. A tolerance
/// of 0 forbids every contraction: simplices of zero measure contribute no hyperplane, so every place would have cost
/// 0.
template <int N>
bool EdgeCollapse<N>::within_tolerance(Index u, Index v, const CollapseTarget<N>& target) const {
  const double tolerance = std::min(tolerance_[u], tolerance_[v]);
  if (!(tolerance > 0.0)) return false;
  if (tolerance == std::numeric_limits<double>::infinity()) return true;
  const double weight = quadrics_[u].weight() + quadrics_[v].weight();
  return target.cost <= tolerance * tolerance * weight;
}

template <int N>
void EdgeCollapse<N>::blend_carried(Index u, Index v, double share) {
  if (share == 0.0) return;
  for (std::size_t i = 0; i < carried_width_; ++i) {
    double& of_u = carried_[u * carried_width_ + i];
    const double of_v = carried_[v * carried_width_ + i];
    of_u = share == 1.0 ? of_v : of_u + share * (of_v - of_u);
  }
}

/// The contraction of an edge, for the search of intersections.
template <int N>
typename MovingSimplices<N>::Contraction EdgeCollapse<N>::contraction(const Edge& edge, const PointN<N>& at) {
  return {edge.u, edge.v, edge.only_u, edge.only_v, edge.both, at};
}

/// Whether everything except the tolerance allows the contraction of the loaded edge.
template <int N>
bool EdgeCollapse<N>::is_possible(const CollapseTarget<N>& target, LoadedEdge<N>& loaded) {
  return loaded.is_contractible(to_scaled(target.at)) &&
         (!embedded_ || embedded_->stay_apart(contraction(loaded.edge(), target.at)));
}

template <int N>
bool EdgeCollapse<N>::try_contract(Index u, Index v, const CollapseTarget<N>& target, LoadedEdge<N>& loaded) {
  if (!within_tolerance(u, v, target)) {
    note_limit(u, v, target, loaded);
    return false;
  }
  loaded.load(complex_, scaled_, u, v);
  if (!is_possible(target, loaded)) return false;
  if (embedded_) embedded_->contract(contraction(loaded.edge(), target.at));
  loaded.contract();
  points_[u] = target.at;
  scaled_[u] = to_scaled(target.at);
  quadrics_[u] += quadrics_[v];
  bound_[u] |= bound_[v];
  tolerance_[u] = std::min(tolerance_[u], tolerance_[v]);
  blend_carried(u, v, target.share);
  merged_into_[v] = u;
  ++version_[u];
  ++version_[v];
  return true;
}

template <int N>
void EdgeCollapse<N>::note_limit(Index u, Index v, const CollapseTarget<N>& target, LoadedEdge<N>& loaded) {
  const std::atomic_ref<bool> limited(limited_);
  if (limited.load(std::memory_order_relaxed)) return;
  loaded.load(complex_, scaled_, u, v);
  if (is_possible(target, loaded)) limited.store(true, std::memory_order_relaxed);
}

template <int N>
PointN<N> EdgeCollapse<N>::mean_normal(Index v, std::vector<Index>& star) {
  complex_.star(v, star);
  PointN<N> sum{};
  for (const Index s : star) {
    const PointN<N> normal = normal_of<N>(corners(s));
    for (int a = 0; a < N; ++a) sum[a] += normal[a];
  }
  return sum;
}

template class EdgeCollapse<2>;
template class EdgeCollapse<3>;
template class EdgeCollapse<4>;

}  // namespace tegl::detail
