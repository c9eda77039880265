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
#include "simplify/facet_neighbours.hpp"
#include "simplify/simplex_corners.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Upper bounds of the distances of points from one simplex. The simplex must outlive it.
template <int N>
class PlacedSimplex {
 public:
  static constexpr int D = N - 1;

  explicit PlacedSimplex(const CornersN<N>& corners) : corners_(corners) {
    // the inverse of the matrix of scalar products of the edges, by its cofactors
    for (int i = 0; i < D; ++i) edges_[i] = minus(corners[i + 1], corners[0]);
    std::array<std::array<double, D>, D> product;
    double cube = 1.0;
    for (int i = 0; i < D; ++i) {
      for (int j = 0; j <= i; ++j) product[i][j] = product[j][i] = dot(edges_[i], edges_[j]);
      cube *= product[i][i];
    }
    double content = 0.0;
    if constexpr (D == 1) {
      inverse_[0][0] = 1.0;
      content = product[0][0];
    } else if constexpr (D == 2) {
      inverse_ = {{{product[1][1], -product[1][0]}, {-product[1][0], product[0][0]}}};
      content = product[0][0] * product[1][1] - product[1][0] * product[1][0];
    } else {
      for (int i = 0; i < D; ++i)
        for (int j = 0; j <= i; ++j) {
          const int a = (i + 1) % D, b = (i + 2) % D, c = (j + 1) % D, d = (j + 2) % D;
          inverse_[i][j] = inverse_[j][i] = product[a][c] * product[b][d] - product[a][d] * product[b][c];
        }
      for (int j = 0; j < D; ++j) content += product[0][j] * inverse_[0][j];
    }
    flat_ = !(content > kFlat * cube);
    const double factor = 1.0 / content;
    for (auto& row : inverse_)
      for (double& x : row) x *= factor;
  }

  struct Place {
    double distance;                  ///< of a point of the simplex; the nearest one if `inside`
    bool inside;                      ///< whether the projection onto the hyperplane is inside
    std::array<double, N> weights{};  ///< barycentric coordinates of the projection
  };
  /// The point of the simplex below p; else one near it, with the negative barycentric coordinates of p set to 0. The
  /// distance is that of a point of the simplex, whatever the rounding errors of the weights.
  [[nodiscard]] Place place(const PointN<N>& p) const {
    Place result{};
    if (flat_) {
      result.distance = distance_to_simplex<N>(p, corners_, N);
      result.inside = true;
      return result;
    }
    PointN<N> rest = minus(p, corners_[0]);
    std::array<double, D> along;
    for (int i = 0; i < D; ++i) along[i] = dot(rest, edges_[i]);
    auto& weights = result.weights;
    weights[0] = 1.0;
    for (int i = 0; i < D; ++i) {
      weights[i + 1] = dot(inverse_[i], along);
      weights[0] -= weights[i + 1];
    }
    double positive = 0.0;
    result.inside = true;
    for (const double weight : weights) {
      positive += std::max(0.0, weight);
      result.inside = result.inside && weight >= 0.0;
    }
    const double factor = result.inside ? 1.0 : 1.0 / positive;
    for (int i = 0; i < D; ++i) {
      const double share = std::max(0.0, weights[i + 1]) * factor;
      for (int a = 0; a < N; ++a) rest[a] -= share * edges_[i][a];
    }
    result.distance = norm(rest);
    return result;
  }

 private:
  /// Square of the relative content of simplices that count as flat. Weights of others have errors of about 1e-8.
  static constexpr double kFlat = 1e-8;

  const CornersN<N>& corners_;
  std::array<PointN<N>, D> edges_;  ///< from corner 0
  std::array<std::array<double, D>, D> inverse_;
  bool flat_;
};

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
  SimplexWalk(const SimplexCorners<N>& to, const FacetNeighbours<N>& neighbours, const BoxTree<N>* tree = nullptr)
      : to_(to), neighbours_(neighbours), tree_(tree) {}

  /// A point of the contour near p: the nearest one that a walk from the simplex `start` finds. Each step crosses the
  /// facet beyond which p lies farthest.
  /// `enough`: a distance at which the walk may end.
  [[nodiscard]] NearPoint approach(const PointN<N>& p, Index start, double enough = 0.0) const {
    NearPoint best;
    Index at = start, before = FacetNeighbours<N>::kNone;
    for (int step = 0; step < kMostSteps; ++step) {
      const CornersN<N> corners = to_[at];
      auto place = PlacedSimplex<N>(corners).place(p);
      if (place.distance < best.distance) best = {place.distance, at};
      if (place.inside || place.distance <= enough) break;
      Index next = FacetNeighbours<N>::kNone;
      for (int tried = 0; tried < N - 1 && (next == FacetNeighbours<N>::kNone || next == before); ++tried) {
        const auto least = std::min_element(place.weights.begin(), place.weights.end());
        if (!(*least < 0.0)) break;
        *least = 0.0;
        next = neighbours_.across(at, static_cast<int>(least - place.weights.begin()));
      }
      if (next == FacetNeighbours<N>::kNone || next == before) break;
      before = std::exchange(at, next);
    }
    return best;
  }

  /// A simplex, and points of the contour near its corners. `vertices`: the numbers of the corners in a contour that
  /// all calls with numbers have in common; kNone for others.
  struct Part {
    CornersN<N> corners;
    std::array<NearPoint, N> near;
    std::array<Index, N> vertices;
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
      const Balls balls(next.corners);
      if (const double bound = farthest_of(next) + balls.radius; bound <= limit) {
        for (const NearPoint& corner : next.near) take({bound, corner.simplex});
        parts_.pop_back();
        continue;
      }
      if (const NearPoint match = common_match(next, limit); match.distance <= limit) {
        take(match);
        parts_.pop_back();
        continue;
      }
      NearPoint middle = approach_middle(next, balls, limit);
      if (!(middle.distance <= limit) && tree_ != nullptr) {
        const auto [distance, simplex] = tree_->nearest(balls.middle, middle.simplex);
        middle = {distance, simplex};
      }
      if (const NearPoint match = match_of(next, balls, middle, limit); match.distance <= limit) {
        take(match);
        parts_.pop_back();
        continue;
      }
      if (++made > most || !(middle.distance <= limit)) return kFailed;
      Part half = next;
      move_corner(half, balls.first, balls.middle, middle);
      move_corner(next, balls.second, balls.middle, middle);
      parts_.push_back(half);
    }
    return result;
  }

  /// After a bound below infinity: the simplices, with the bounds of the parts near them.
  [[nodiscard]] std::span<const NearPoint> matches() const noexcept { return matches_; }

 private:
  static constexpr double kFailed = std::numeric_limits<double>::infinity();
  static constexpr int kMostSteps = 16;
  /// Parts with a radius beyond this multiple of the limit are not compared with one simplex.
  static constexpr double kReach = 1.5;

  static void move_corner(Part& part, int corner, const PointN<N>& to, const NearPoint& near) {
    part.corners[corner] = to;
    part.near[corner] = near;
    part.vertices[corner] = kNone;
  }
  static double farthest_of(const Part& part) {
    double most = 0.0;
    for (const NearPoint& point : part.near) most = std::max(most, point.distance);
    return most;
  }

  /// Balls around a part. Every point of a simplex is within the radius of the smallest ball around it from one of its
  /// corners, so at most that plus the largest distance of a corner away from the contour. Jung's theorem bounds the
  /// radius by the longest edge.
  struct Balls {
    explicit Balls(const CornersN<N>& part) {
      std::tie(first, second) = ends_of_longest_edge<N>(part);
      middle = between(part[first], part[second], 0.5);
      double largest = 0.0, least = std::numeric_limits<double>::infinity();
      for (int i = 0; i < N; ++i) {
        const PointN<N> way = minus(part[i], middle);
        const double square = dot(way, way);
        largest = std::max(largest, square);
        if (square < least) nearest = i;
        least = std::min(least, square);
      }
      const PointN<N> edge = minus(part[first], part[second]);
      radius_of_middle = std::sqrt(largest);
      radius = std::sqrt(std::min(largest, dot(edge, edge) * (N - 1) / (2 * N)));
    }
    int first = 0, second = 1;  ///< the ends of the longest edge
    PointN<N> middle;           ///< of the longest edge
    int nearest = 0;            ///< the corner nearest to it
    double radius_of_middle;    ///< of the ball around that
    double radius;              ///< at least that of the smallest ball
  };

  /// A point near the middle of the longest edge. The edges of a contour are in several simplices: their middles are
  /// kept, and found in a way that depends on the edge only. So results do not depend on what is kept.
  [[nodiscard]] NearPoint approach_middle(const Part& part, const Balls& balls, double limit) {
    int first = balls.first, second = balls.second;
    if (part.vertices[first] == kNone || part.vertices[second] == kNone)
      return approach(balls.middle, part.near[balls.nearest].simplex, limit - balls.radius_of_middle);
    if (part.vertices[second] < part.vertices[first]) std::swap(first, second);
    const std::uint64_t key = std::uint64_t{part.vertices[first]} << 32 | part.vertices[second];
    if (middles_.empty()) middles_.resize(kKept);
    Middle& kept = middles_[key * kHash >> (64 - kKeptBits)];
    if (kept.edge != key)
      kept = {key, approach(between(part.corners[first], part.corners[second], 0.5), part.near[first].simplex)};
    return kept.near;
  }

  /// A simplex that is nearest to several corners, and the distance of the part from it: one above `limit` if there is
  /// none within the limit.
  [[nodiscard]] NearPoint common_match(const Part& part, double limit) const {
    NearPoint match;
    int most = 1;
    for (int i = 1; i < N; ++i) {
      int times = 1;
      for (int j = 0; j < i; ++j) times += part.near[j].simplex == part.near[i].simplex;
      if (times <= most) continue;
      most = times;
      match.simplex = part.near[i].simplex;
    }
    if (most > 1) match.distance = largest_distance(part, match.simplex, limit);
    return match;
  }

  /// The simplex near the middle of the longest edge, if the part is within `limit` of it, or else a distance above
  /// `limit`.
  [[nodiscard]] NearPoint match_of(const Part& part, const Balls& balls, const NearPoint& middle, double limit) const {
    const double bound = middle.distance + balls.radius_of_middle;
    if (bound <= limit) return {bound, middle.simplex};
    if (balls.radius_of_middle > kReach * limit) return {kFailed, middle.simplex};
    return {largest_distance(part, middle.simplex, limit), middle.simplex};
  }

  /// The largest distance of a corner from the simplex, or one above `limit`.
  [[nodiscard]] double largest_distance(const Part& part, Index simplex, double limit) const {
    const CornersN<N> corners = to_[simplex];
    const PlacedSimplex<N> placed(corners);
    double largest = 0.0;
    for (int i = 0; i < N && largest <= limit; ++i)
      largest = std::max(
          largest, part.near[i].simplex == simplex ? part.near[i].distance : placed.place(part.corners[i]).distance);
    return largest;
  }

  /// The middle of an edge, by the numbers of its ends.
  struct Middle {
    std::uint64_t edge = ~std::uint64_t{0};
    NearPoint near;
  };
  static constexpr int kKeptBits = 16;
  static constexpr std::size_t kKept = std::size_t{1} << kKeptBits;
  static constexpr std::uint64_t kHash = 0x9E3779B97F4A7C15u;

  SimplexCorners<N> to_;
  const FacetNeighbours<N>& neighbours_;
  const BoxTree<N>* tree_;
  std::vector<Part> parts_;
  std::vector<NearPoint> matches_;
  std::vector<Middle> middles_;  ///< by a hash of the edge: the last one with that hash
};

}  // namespace tegl::detail
