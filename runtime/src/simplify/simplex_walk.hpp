// SPDX-License-Identifier: BSD-3-Clause
//
// Distances of points from a contour, found by a walk from simplex to simplex, and bounds of the distance of a whole
// simplex by those of its corners.
//
// Principle. The distance from one simplex is a convex function. So its maximum over another simplex is at a corner. A
// simplex whose corners are all near one simplex of the contour is therefore near it as a whole; else it is bisected.
// Each distance is that of a point of the contour, so it is an upper bound, even if the walk misses the nearest point.
// Most simplices that are smaller than the distances of interest are bounded by a few multiplications.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/simplex_shapes.hpp"
#include "simplify/box_tree.hpp"
#include "simplify/corner_lanes.hpp"
#include "simplify/facet_neighbours.hpp"
#include "simplify/placed_simplex.hpp"
#include "simplify/simplex_gradients.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// A point of a contour: its distance from another point, and its simplex.
struct NearPoint {
  double distance = std::numeric_limits<double>::infinity();
  Index simplex = 0;
};

/// Walks through one contour. Use one per thread.
template <int N>
class SimplexWalk {
 public:
  /// `tree`: searched where a walk of `bound` ends too far away; null: not searched.
  SimplexWalk(const SimplexGradients<N>& to, const FacetNeighbours<N>& neighbours, const BoxTree<N>* tree = nullptr)
      : to_(to), neighbours_(neighbours), tree_(tree) {}

  /// A point of the contour near p: the nearest one that a walk from the simplex `start` finds. Each step crosses the
  /// facet beyond which p lies farthest.
  [[nodiscard]] NearPoint approach(const PointN<N>& p, Index start) const {
    return end_of_walk(p, start, [&](Index s, const Weights&) {
      const CornersN<N> corners = to_.corners(s);
      return PlacedSimplex<N>(corners).place(p).distance;
    });
  }
  /// The same faster: unless the point is very near, from points that are nearly the nearest ones of their simplices.
  [[nodiscard]] NearPoint approach_nearly(const PointN<N>& p, Index start) const {
    return end_of_walk(p, start, [&](Index s, const Weights& weights) {
      const CornersN<N> corners = to_.corners(s);
      const double rough = to_.distance(p, corners, weights);
      return rough > kVeryNear * norm(minus(corners[1], corners[0])) ? rough
                                                                     : PlacedSimplex<N>(corners).place(p).distance;
    });
  }

  /// A simplex, and points of the contour near its corners. `vertices`: the numbers of the corners in a contour that
  /// all calls with numbers have in common; kNone for others.
  struct Part {
    CornerLanes<N> corners;
    std::array<double, N> distances;  ///< of the near points from the corners
    std::array<Index, N> simplices;   ///< of the near points
    std::array<Index, N> vertices;

    void set_near(int corner, const NearPoint& near) {
      distances[corner] = near.distance;
      simplices[corner] = near.simplex;
    }
  };
  static constexpr Index kNone = FacetNeighbours<N>::kNone;

  /// Bounds the distance of all points of `part` from the contour, if at most `most` parts of it are each within
  /// `limit` of one simplex or of several near its corners; else returns infinity.
  double bound(const Part& part, double limit, std::size_t most) {
    parts_.assign(1, part);
    matches_.clear();
    double result = 0.0;
    const auto take = [&](const NearPoint& match) {
      matches_.push_back(match);
      result = std::max(result, match.distance);
    };
    for (std::size_t made = 1; !parts_.empty();) {
      Part& next = parts_.back();
      const CornerBalls<N> balls = balls_around<N>(next.corners, next.distances, limit);
      if (balls.bound <= limit) {
        for (int i = 0; i < N; ++i)  // each simplex once
          if (std::find(next.simplices.begin(), next.simplices.begin() + i, next.simplices[i]) ==
              next.simplices.begin() + i)
            take({balls.bound, next.simplices[i]});
        parts_.pop_back();
        continue;
      }
      if (const NearPoint match = common_match(next); match.distance <= limit) {
        take(match);
        parts_.pop_back();
        continue;
      }
      NearPoint middle = approach_middle(next, balls);
      // the walk may have missed it: other walks, then a search
      for (int i = 0; i < N && !(middle.distance <= limit); ++i)
        if (const NearPoint other = approach_roughly(balls.edge.middle, next.simplices[i]); other.distance <= limit)
          middle = other;
      if (!(middle.distance <= limit) && tree_ != nullptr) {
        const auto [distance, simplex] = tree_->nearest(balls.edge.middle, middle.simplex);
        middle = {distance, simplex};
      }
      if (const NearPoint match = match_of(next, balls, middle, limit); match.distance <= limit) {
        take(match);
        parts_.pop_back();
        continue;
      }
      if (++made > most || !(middle.distance <= limit)) return kFailed;
      parts_.push_back(next);  // then next refers to memory that may be gone
      move_corner(parts_.back(), balls.edge.first, balls.edge.middle, middle);
      move_corner(*(parts_.end() - 2), balls.edge.second, balls.edge.middle, middle);
    }
    return result;
  }

  /// After a bound below infinity: the simplices, with the bounds of the parts near them.
  [[nodiscard]] std::span<const NearPoint> matches() const noexcept { return matches_; }

 private:
  static constexpr double kFailed = std::numeric_limits<double>::infinity();
  static constexpr int kMostSteps = 16;
  /// At distances beyond this share of an edge, errors of weights in single precision hardly matter.
  static constexpr double kVeryNear = 0.01;
  /// Parts with a radius beyond this multiple of the limit are not compared with one simplex.
  static constexpr double kReach = 1.5;

  using Weights = typename SimplexGradients<N>::Weights;

  /// The end of a walk from `start` if p is above or below it, else the nearest simplex on the way.
  /// `distance_from(simplex, weights of p)`: the distance of a point of the simplex.
  template <class DistanceFrom>
  [[nodiscard]] NearPoint end_of_walk(const PointN<N>& p, Index start, const DistanceFrom& distance_from) const {
    const auto local = to_.local(p);
    struct Step {
      Index simplex;
      Weights weights;
    };
    std::array<Step, kMostSteps> way;  // set step by step
    std::size_t steps = 0;
    for (Index at = start, before = kNone; at != kNone && steps < kMostSteps;) {
      const Weights weights = to_.weights(at, local);
      if (weights.inside) return {distance_from(at, weights), at};
      way[steps++] = {at, weights};
      const Index next = beyond(at, before, weights.of_corners);
      if (next == before) break;
      before = std::exchange(at, next);
    }
    NearPoint best;
    for (std::size_t i = 0; i < steps; ++i)
      if (const double distance = distance_from(way[i].simplex, way[i].weights); distance < best.distance)
        best = {distance, way[i].simplex};
    return best;
  }

  /// The simplex across the facet beyond which a point of these weights lies farthest, if possible not `before`.
  [[nodiscard]] Index beyond(Index at, Index before, std::array<float, N> weights) const {
    Index next = kNone;
    for (int tried = 0; tried < N - 1 && (next == kNone || next == before); ++tried) {
      const auto least = std::min_element(weights.begin(), weights.end());
      if (!(*least < 0.0f)) break;
      *least = 0.0f;
      next = neighbours_.across(at, static_cast<int>(least - weights.begin()));
    }
    return next;
  }

  /// As approach, with distances from points that are nearly the nearest ones of their simplices.
  [[nodiscard]] NearPoint approach_roughly(const PointN<N>& p, Index start) const {
    return end_of_walk(p, start, [&](Index s, const Weights& weights) { return to_.distance(s, p, weights); });
  }

  static void move_corner(Part& part, int corner, const PointN<N>& to, const NearPoint& near) {
    part.corners.set(corner, to);
    part.set_near(corner, near);
    part.vertices[corner] = kNone;
  }

  /// Whether the root of `square` is at most `room`.
  static bool is_within(double square, double room) { return room >= 0.0 && square <= room * room; }

  /// A point near the middle of the longest edge. The edges of a contour are in several simplices: their middles are
  /// kept, and found in a way that depends on the edge only. So results do not depend on what is kept.
  [[nodiscard]] NearPoint approach_middle(const Part& part, const CornerBalls<N>& balls) {
    int first = balls.edge.first, second = balls.edge.second;
    if (part.vertices[first] == kNone || part.vertices[second] == kNone)
      return approach_roughly(balls.edge.middle, part.simplices[balls.nearest]);
    if (part.vertices[second] < part.vertices[first]) std::swap(first, second);
    const std::uint64_t key = std::uint64_t{part.vertices[first]} << 32 | part.vertices[second];
    if (middles_.empty()) middles_.resize(kKept);
    Middle& kept = middles_[key * kHash >> (64 - kKeptBits)];
    if (kept.edge != key)
      kept = {key, approach_roughly(between(part.corners[first], part.corners[second], 0.5), part.simplices[first])};
    return kept.near;
  }

  /// A simplex that is nearest to several corners, and the distance of the part from it; infinity if there is none.
  [[nodiscard]] NearPoint common_match(const Part& part) const {
    NearPoint match;
    int most = 1;
    for (int i = 1; i < N; ++i) {
      int times = 1;
      for (int j = 0; j < i; ++j) times += part.simplices[j] == part.simplices[i];
      if (times <= most) continue;
      most = times;
      match.simplex = part.simplices[i];
    }
    if (most > 1) match.distance = largest_distance(part, match.simplex);
    return match;
  }

  /// The simplex near the middle of the longest edge, if the part is within `limit` of it, or else a distance above
  /// `limit`.
  [[nodiscard]] NearPoint match_of(const Part& part, const CornerBalls<N>& balls, const NearPoint& middle,
                                   double limit) const {
    if (is_within(balls.square_of_middle, limit - middle.distance))
      return {std::min(limit, middle.distance + std::sqrt(balls.square_of_middle)), middle.simplex};
    if (!is_within(balls.square_of_middle, kReach * limit)) return {kFailed, middle.simplex};
    return {largest_distance(part, middle.simplex), middle.simplex};
  }

  /// The largest distance of a corner from the simplex.
  [[nodiscard]] double largest_distance(const Part& part, Index simplex) const {
    const std::array<double, N> distances = to_.distances(simplex, part.corners);
    double largest = 0.0;
    for (int i = 0; i < N; ++i)
      largest = std::max(largest, part.simplices[i] == simplex ? part.distances[i] : distances[i]);
    return largest;
  }

  /// The middle of an edge, by the numbers of its ends.
  struct Middle {
    std::uint64_t edge = ~std::uint64_t{0};
    NearPoint near;
  };
  static constexpr int kKeptBits = 13;
  static constexpr std::size_t kKept = std::size_t{1} << kKeptBits;
  static constexpr std::uint64_t kHash = 0x9E3779B97F4A7C15u;

  const SimplexGradients<N>& to_;
  const FacetNeighbours<N>& neighbours_;
  const BoxTree<N>* tree_;
  std::vector<Part> parts_;
  std::vector<NearPoint> matches_;
  std::vector<Middle> middles_;  ///< by a hash of the edge: the last one with that hash
};

}  // namespace tegl::detail
