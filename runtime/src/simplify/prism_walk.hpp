// SPDX-License-Identifier: BSD-3-Clause
//
// Tests whether the part of a contour that is connected with given simplices covers a whole simplex within a distance:
// by a walk across facets inside the prism over the simplex.
//
// Principle. The walk adds the neighbour across every facet that may meet the prism. So the boundary of the chain of
// visited simplices lies outside the prism, and prism_cover.hpp applies: if the chain stays within a range of heights
// and covers one point with a nonzero degree, it covers all points. The walk finds the chain from one simplex, without
// a search for all simplices near the prism; it fails at borders, and if the chain leaves the range of heights.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "mesh/simplex_shapes.hpp"
#include "simplify/facet_neighbours.hpp"
#include "simplify/prism_cover.hpp"
#include "simplify/simplex_corners.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Whether the projections of all corners of `part` are certainly on one side of the projected facet opposite to a
/// corner of the simplex, all in the frame. Then the facet does not meet the prism over the part.
template <int N>
bool is_beside(const CornersN<N>& simplex, int corner, const CornersN<N>& part) {
  constexpr int D = N - 1;
  std::array<PointN<D>, D> facet;
  for (int i = 0, k = 0; i < N; ++i)
    if (i != corner) facet[k++] = flat<N>(simplex[i]);
  double longest = 0.0;
  const auto way_to = [&](const PointN<D>& x) {
    const PointN<D> way = minus(x, facet[0]);
    for (const double length : way) longest = std::max(longest, std::abs(length));
    return way;
  };
  for (int i = 1; i < D; ++i) way_to(facet[i]);
  const PointN<D> normal = normal_of<D>(facet);
  double least = std::numeric_limits<double>::infinity(), largest = -least;
  for (const PointN<N>& x : part) {
    const double side = dot(normal, way_to(flat<N>(x)));
    least = std::min(least, side);
    largest = std::max(largest, side);
  }
  double rounding = 1e-13;
  for (int k = 0; k < D; ++k) rounding *= longest;
  return least > rounding || largest < -rounding;
}

/// Walks through one contour. Use one per thread.
template <int N>
class PrismWalk {
 public:
  PrismWalk(const SimplexCorners<N>& to, const FacetNeighbours<N>& neighbours) : to_(to), neighbours_(neighbours) {}

  /// Bounds the distance of all points of `part` from the contour, if simplices connected with `starts` cover it within
  /// `limit`; else returns infinity. Only heights above `rough` are determined exactly. `part`: in the frame; `edge`:
  /// its longest edge, or a longer one.
  double bound(const Frame<N>& frame, const CornersN<N>& part, double edge, std::span<const Index> starts, double rough,
               double limit) {
    const Prism<N> prism(part, edge);
    clear();
    for (const Index start : starts) visit(start);
    // visited_ grows during the walk.
    for (std::size_t i = 0; i < visited_.size(); ++i) {
      if (visited_.size() > kMost || !step(i, frame, part, prism, rough, limit)) return kFailed;
    }
    const auto corners_of = [&](std::size_t k) -> const CornersN<N>& { return chain_[k].at; };
    if (!covers_a_point<N>(chain_.size(), corners_of, part)) return kFailed;
    double result = 0.0;
    for (const Link& link : chain_) result = std::max(result, link.bound);
    return result;
  }

  /// After a bound below infinity: calls on_match(simplex, bound of its distance) for all simplices of the chain.
  template <class OnMatch>
  void visit_matches(const OnMatch& on_match) const {
    for (const Link& link : chain_) on_match(link.simplex, link.bound);
  }

 private:
  static constexpr double kFailed = std::numeric_limits<double>::infinity();
  /// Maximum length of a walk. The table of visited simplices has four times as many entries.
  static constexpr std::size_t kMost = 256;
  static constexpr std::size_t kTable = 4 * kMost;

  /// A simplex of the chain, in the frame.
  struct Link {
    CornersN<N> at;
    Index simplex;
    double bound;
  };

  void clear() {
    for (const std::uint32_t slot : slots_) table_[slot] = FacetNeighbours<N>::kNone;
    slots_.clear();
    visited_.clear();
    chain_.clear();
  }

  void visit(Index t) {
    std::uint32_t slot = t * 2654435761u >> 22;
    static_assert(kTable == 1u << 10);
    for (; table_[slot] != FacetNeighbours<N>::kNone; slot = (slot + 1) % kTable)
      if (table_[slot] == t) return;
    table_[slot] = t;
    slots_.push_back(slot);
    visited_.push_back(t);
  }

  /// Adds a visited simplex to the chain and visits its neighbours in the prism. Returns false if the chain leaves the
  /// range of heights or has a border in the prism.
  bool step(std::size_t number, const Frame<N>& frame, const CornersN<N>& part, const Prism<N>& prism, double rough,
            double limit) {
    const Index t = visited_[number];
    const CornersN<N> at = frame.to_frame_by_axis(to_[t]);
    // Facets whose corners are all beyond one side of the prism are outside of it.
    constexpr unsigned kAll = (1u << N) - 1;
    unsigned outside = 0;
    for (int side = 0; side < prism.sides(); ++side) {
      const unsigned beyond = prism.corners_beyond(side, at);
      if (beyond == kAll) return true;  // a start outside the prism
      const unsigned rest = kAll & ~beyond;
      if ((rest & (rest - 1)) == 0) outside |= rest;
    }
    const PointN<N> heights = prism.heights(at);
    double low = *std::min_element(heights.begin(), heights.end());
    double high = *std::max_element(heights.begin(), heights.end());
    Link link;
    link.simplex = t;
    for (int i = 0; i < N; ++i)
      for (int k = 0; k < N; ++k) link.at[i][k] = at[k][i];
    const auto bound_of = [&] { return std::max(high - prism.low(), prism.high() - low); };
    if (bound_of() > rough) {
      const auto [least, largest] = heights_of_plane<N>(link.at, part, prism);
      low = std::max(low, least);
      high = std::min(high, largest);
      if (low > high) return true;  // it does not meet the prism
    }
    if (bound_of() > rough) {
      if (!clipped_.load(link.at, prism) || !clipped_.clip(prism)) return true;
      std::tie(low, high) = clipped_.heights(prism);
      if (bound_of() > limit) return false;
    }
    link.bound = bound_of();
    chain_.push_back(link);
    for (int i = 0; i < N; ++i) {
      if ((outside >> i & 1u) != 0 || is_beside<N>(link.at, i, part)) continue;
      const Index next = neighbours_.across(t, i);
      if (next != FacetNeighbours<N>::kNone)
        visit(next);
      else if (clipped_.load(link.at, prism) && clipped_.clip(prism) && (clipped_.facets() >> i & 1u) != 0)
        return false;
    }
    return true;
  }

  SimplexCorners<N> to_;
  const FacetNeighbours<N>& neighbours_;
  std::vector<Index> table_ = std::vector<Index>(kTable, FacetNeighbours<N>::kNone);
  std::vector<std::uint32_t> slots_;  ///< used entries of table_
  std::vector<Index> visited_;
  std::vector<Link> chain_;
  ClippedSimplex<N> clipped_;
};

}  // namespace tegl::detail
