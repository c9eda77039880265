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
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "mesh/simplex_shapes.hpp"
#include "simplify/facet_neighbours.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Upper bounds of the distances of points from one simplex. The simplex must outlive it.
template <int N>
class PlacedSimplex {
 public:
  explicit PlacedSimplex(const CornersN<N>& corners) : corners_(corners) {
    // Gram-Schmidt: `basis_` is orthonormal, `upper_` has the coordinates of the edges in it
    for (int i = 1; i < N; ++i) {
      PointN<N> edge = minus(corners[i], corners[0]);
      const double square = dot(edge, edge);
      for (int j = 1; j < i; ++j) {
        upper_[j][i] = dot(edge, basis_[j]);
        for (int a = 0; a < N; ++a) edge[a] -= upper_[j][i] * basis_[j][a];
      }
      const double rest = dot(edge, edge);
      if (!(rest > kFlat * square)) {
        flat_ = true;
        return;
      }
      inverse_[i] = 1.0 / std::sqrt(rest);
      for (int a = 0; a < N; ++a) basis_[i][a] = edge[a] * inverse_[i];
    }
  }

  struct Place {
    double distance;                  ///< of a point of the simplex; the nearest one if `inside`
    bool inside;                      ///< whether the projection onto the hyperplane is inside
    std::array<double, N> weights{};  ///< barycentric coordinates of the projection
  };
  /// The point of the simplex below p; else one near it, with the negative barycentric coordinates of p set to 0.
  [[nodiscard]] Place place(const PointN<N>& p) const {
    Place result{};
    if (flat_) {
      result.distance = distance_to_simplex<N>(p, corners_, N);
      result.inside = true;
      return result;
    }
    PointN<N> rest = minus(p, corners_[0]);
    std::array<double, N> at{};
    for (int i = 1; i < N; ++i) {
      at[i] = dot(rest, basis_[i]);
      for (int a = 0; a < N; ++a) rest[a] -= at[i] * basis_[i][a];
    }
    auto& weights = result.weights;
    weights[0] = 1.0;
    double positive = 0.0;
    for (int i = N - 1; i > 0; --i) {
      double sum = at[i];
      for (int j = i + 1; j < N; ++j) sum -= upper_[i][j] * weights[j];
      weights[i] = sum * inverse_[i];
      weights[0] -= weights[i];
      positive += std::max(0.0, weights[i]);
    }
    result.inside = std::all_of(weights.begin(), weights.end(), [](double w) { return w >= 0.0; });
    if (result.inside) {
      result.distance = norm(rest);
      return result;
    }
    positive += std::max(0.0, weights[0]);
    PointN<N> way = p;
    for (int i = 0; i < N; ++i) {
      const double share = std::max(0.0, weights[i]) / positive;
      for (int a = 0; a < N; ++a) way[a] -= share * corners_[i][a];
    }
    result.distance = norm(way);
    return result;
  }

  /// An upper bound of the distance; if it is above `limit`, the distance itself is above `limit`.
  [[nodiscard]] double distance(const PointN<N>& p, double limit) const {
    const Place found = place(p);
    if (found.inside || found.distance <= limit) return found.distance;
    return distance_to_simplex<N>(p, corners_, N);
  }

 private:
  /// Square of the relative height of simplices that count as flat. Directions of others have errors of about 1e-12.
  static constexpr double kFlat = 1e-8;

  const CornersN<N>& corners_;
  std::array<PointN<N>, N> basis_{};
  std::array<std::array<double, N>, N> upper_{};
  std::array<double, N> inverse_{};
  bool flat_ = false;
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
  SimplexWalk(std::span<const CornersN<N>> to, const FacetNeighbours<N>& neighbours)
      : to_(to), neighbours_(neighbours) {}

  /// A point of the contour near p: the nearest one that a walk from the simplex `start` finds. Each step crosses the
  /// facet beyond which p lies farthest.
  [[nodiscard]] NearPoint approach(const PointN<N>& p, Index start) const {
    NearPoint best;
    Index at = start, before = FacetNeighbours<N>::kNone;
    for (int step = 0; step < kMostSteps; ++step) {
      auto place = PlacedSimplex<N>(to_[at]).place(p);
      if (place.distance < best.distance) best = {place.distance, at};
      if (place.inside) break;
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

  /// Bounds the distance of all points of `part` from the contour, if at most `most` parts of it are each within
  /// `limit` of one simplex; else returns infinity. `near`: points of the contour near the corners.
  double bound(const CornersN<N>& part, const std::array<NearPoint, N>& near, double limit, std::size_t most) {
    parts_.assign(1, {part, near});
    matches_.clear();
    double result = 0.0;
    for (std::size_t made = 1; !parts_.empty();) {
      const Part next = parts_.back();
      parts_.pop_back();
      Index around = next.near[0].simplex;
      const NearPoint match = match_of(next, limit, around);
      if (match.distance <= limit) {
        matches_.push_back(match);
        result = std::max(result, match.distance);
        continue;
      }
      if (++made > most || !bisect(next, around, limit)) return kFailed;
    }
    return result;
  }

  /// After a bound below infinity: the simplices, with the bounds of the parts near them.
  [[nodiscard]] std::span<const NearPoint> matches() const noexcept { return matches_; }

 private:
  static constexpr double kFailed = std::numeric_limits<double>::infinity();
  static constexpr int kMostSteps = 16;
  /// Parts with a radius beyond this multiple of the limit are bisected at once.
  static constexpr double kReach = 1.5;

  struct Part {
    CornersN<N> corners;
    std::array<NearPoint, N> near;  ///< near the corners
  };

  /// A simplex within `limit` of all corners: one that is near several corners, or near the middle; or one whose
  /// distance from the middle is within `limit` less the radius. The distance is above `limit` if none is found.
  /// `around`: becomes a simplex near the middle, if that is searched.
  [[nodiscard]] NearPoint match_of(const Part& part, double limit, Index& around) const {
    NearPoint match;
    int most = 1;
    for (int i = 1; i < N; ++i) {
      int times = 1;
      for (int j = 0; j < i; ++j) times += part.near[j].simplex == part.near[i].simplex;
      if (times <= most) continue;
      most = times;
      match.simplex = part.near[i].simplex;
    }
    if (most > 1) {
      match.distance = largest_distance(part, match.simplex, limit);
      if (match.distance <= limit) return match;
    }
    const PointN<N> middle = middle_of<N>(part.corners);
    double radius = 0.0;
    for (const PointN<N>& corner : part.corners) radius = std::max(radius, norm(minus(corner, middle)));
    if (radius > kReach * limit) return {kFailed, around};
    const NearPoint below = approach(middle, around);
    around = below.simplex;
    if (below.distance + radius <= limit) return {below.distance + radius, below.simplex};
    if (most > 1 && match.simplex == below.simplex) return match;
    return {largest_distance(part, below.simplex, limit), below.simplex};
  }

  /// The largest distance of a corner from the simplex, or one above `limit`.
  [[nodiscard]] double largest_distance(const Part& part, Index simplex, double limit) const {
    const PlacedSimplex<N> placed(to_[simplex]);
    double largest = 0.0;
    for (int i = 0; i < N && largest <= limit; ++i)
      largest = std::max(
          largest, part.near[i].simplex == simplex ? part.near[i].distance : placed.distance(part.corners[i], limit));
    return largest;
  }

  /// Adds both halves to the parts, by a walk from the simplex `around`. Returns false if no point within `limit` of
  /// the new corner is found.
  bool bisect(const Part& part, Index around, double limit) {
    const auto [first, second] = ends_of_longest_edge<N>(part.corners);
    const PointN<N> middle = between(part.corners[first], part.corners[second], 0.5);
    const NearPoint near = approach(middle, around);
    if (!(near.distance <= limit)) return false;
    for (const int end : {first, second}) {
      Part& half = parts_.emplace_back(part);
      half.corners[end] = middle;
      half.near[end] = near;
    }
    return true;
  }

  std::span<const CornersN<N>> to_;
  const FacetNeighbours<N>& neighbours_;
  std::vector<Part> parts_;
  std::vector<NearPoint> matches_;
};

}  // namespace tegl::detail
