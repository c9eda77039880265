// SPDX-License-Identifier: BSD-3-Clause
//
// A bounding volume hierarchy of simplices for range and nearest-neighbour queries: a binary tree of boxes over
// simplices in the order of a space-filling curve (C. Lauterbach et al., Fast BVH construction on GPUs, 2009).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "base/workers.hpp"
#include "mesh/simplex_shapes.hpp"
#include "simplify/simplex_corners.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

template <int N>
struct Box {
  PointN<N> low = filled(std::numeric_limits<double>::infinity());
  PointN<N> high = filled(-std::numeric_limits<double>::infinity());

  static PointN<N> filled(double x) {
    PointN<N> result;
    result.fill(x);
    return result;
  }
  void add(const PointN<N>& p) {
    for (int a = 0; a < N; ++a) {
      low[a] = std::min(low[a], p[a]);
      high[a] = std::max(high[a], p[a]);
    }
  }
  void add(const Box& other) {
    add(other.low);
    add(other.high);
  }
  /// Whether the gap between the boxes is at most `reach` along every axis.
  [[nodiscard]] bool meets(const Box& other, double reach) const {
    for (int a = 0; a < N; ++a)
      if (low[a] > other.high[a] + reach || other.low[a] > high[a] + reach) return false;
    return true;
  }
  [[nodiscard]] double square_distance(const PointN<N>& p) const {
    double sum = 0.0;
    for (int a = 0; a < N; ++a) {
      const double away = std::max({0.0, low[a] - p[a], p[a] - high[a]});
      sum += away * away;
    }
    return sum;
  }
};

/// Bounding volume hierarchy of simplices with N corners each, in an order in which neighbours follow each other. What
/// `SimplexCorners` refers to must outlive it.
template <int N>
class BoxTree {
 public:
  explicit BoxTree(const SimplexCorners<N>& simplices, unsigned threads = 1, const Progress& progress = {})
      : simplices_(simplices) {
    if (simplices.size() == 0) return;
    origin_ = simplices[0][0];
    // the nodes of one level with all below them, then those above
    const Range all{0, static_cast<Index>(simplices.size())};
    std::size_t level = 1;  // the number of nodes in it, and of its first node
    std::size_t largest = simplices.size();
    for (nodes_.resize(2); largest > kLeafSize; largest -= largest / 2) nodes_.resize(2 * nodes_.size());
    while (level < kParts && 2 * level < nodes_.size()) level *= 2;
    for_each_block(level, 1, threads, progress,
                   [&](std::size_t, std::size_t first, std::size_t) { build(level + first, range_of(level + first)); });
    build(1, all, level);
  }

  /// Calls visit(simplex) for every simplex whose box is within `reach` of the box along every axis.
  template <class Visit>
  void visit_near(const Box<N>& box, double reach, const Visit& visit) const {
    if (!nodes_.empty()) visit_node(1, all(), box, local(box), reach, visit);
  }

  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    Index simplex = 0;
  };
  /// The nearest simplex; the distance is infinite if there is none.
  [[nodiscard]] Nearest nearest(const PointN<N>& p) const {
    Found best;
    if (!nodes_.empty()) find_nearest(1, all(), {p, minus(p, origin_)}, best);
    return best.nearest;
  }
  /// The nearest simplex, found faster if `guess` is near. Among equally near simplices the result may depend on the
  /// guess.
  [[nodiscard]] Nearest nearest(const PointN<N>& p, Index guess) const { return within_factor(p, guess, 1.0); }
  /// A simplex at no more than `factor` times the distance of the nearest one.
  [[nodiscard]] Nearest within_factor(const PointN<N>& p, Index guess, double factor) const {
    Found best;
    best.factor = factor;
    try_simplex(guess, p, best);
    find_nearest(1, all(), {p, minus(p, origin_)}, best);
    return best.nearest;
  }

 private:
  static constexpr Index kLeafSize = 4;
  static constexpr std::size_t kParts = 256;

  /// The simplices of a node; each of its two children has one half of them. A node with at most kLeafSize is a leaf.
  struct Range {
    Index first, end;
    [[nodiscard]] bool is_leaf() const { return end - first <= kLeafSize; }
    [[nodiscard]] Range half(unsigned second) const {
      const Index middle = first + (end - first) / 2;
      return second == 0 ? Range{first, middle} : Range{middle, end};
    }
  };
  [[nodiscard]] Range all() const { return {0, static_cast<Index>(simplices_.size())}; }
  /// The children of node i are 2 i and 2 i + 1; node 1 is the root.
  [[nodiscard]] Range range_of(std::size_t node) const {
    Range range = all();
    for (int bit = static_cast<int>(std::bit_width(node)) - 2; bit >= 0 && !range.is_leaf(); --bit)
      range = range.half(node >> bit & 1u);
    return range;
  }

  /// A box in single precision, relative to the origin; never too small. The boxes of two children are in one cache
  /// line.
  struct Node {
    std::array<float, N> low, high;

    void set(const Box<N>& box) {
      constexpr float kInfinity = std::numeric_limits<float>::infinity();
      for (int a = 0; a < N; ++a) {  // rounded by at most half of a step; one step is more
        low[a] = std::nextafter(static_cast<float>(box.low[a]), -kInfinity);
        high[a] = std::nextafter(static_cast<float>(box.high[a]), kInfinity);
      }
    }
    void add(const Node& other) {
      for (int a = 0; a < N; ++a) {
        low[a] = std::min(low[a], other.low[a]);
        high[a] = std::max(high[a], other.high[a]);
      }
    }
    [[nodiscard]] bool meets(const Box<N>& box, double reach) const {
      for (int a = 0; a < N; ++a)
        if (static_cast<double>(low[a]) > box.high[a] + reach || box.low[a] > static_cast<double>(high[a]) + reach)
          return false;
      return true;
    }
    [[nodiscard]] double square_distance(const PointN<N>& p) const {
      double sum = 0.0;
      for (int a = 0; a < N; ++a) {
        const double away = std::max({0.0, static_cast<double>(low[a]) - p[a], p[a] - static_cast<double>(high[a])});
        sum += away * away;
      }
      return sum;
    }
  };

  /// A point, and the same relative to the origin.
  struct Place {
    PointN<N> point, local;
  };

  /// The nearest simplex so far, and the vector from its nearest point to the point searched for.
  struct Found {
    Nearest nearest;
    PointN<N> way{};
    double factor = 1.0;  ///< simplices that are not nearer by this factor are not searched
  };

  [[nodiscard]] Box<N> box_of(Index s) const {
    Box<N> box;
    for (const PointN<N>& corner : simplices_[s]) box.add(corner);
    return box;
  }

  [[nodiscard]] Box<N> local(const Box<N>& box) const { return {minus(box.low, origin_), minus(box.high, origin_)}; }

  /// Sets the boxes of a node and of all nodes below it. `known`: the first of the nodes that are set already, with
  /// those below them.
  void build(std::size_t node, const Range& range, std::size_t known = std::numeric_limits<std::size_t>::max()) {
    if (node >= known) return;
    if (range.is_leaf()) {
      Box<N> box;
      for (Index i = range.first; i < range.end; ++i) box.add(box_of(i));
      nodes_[node].set(local(box));
      return;
    }
    build(2 * node, range.half(0), known);
    build(2 * node + 1, range.half(1), known);
    nodes_[node] = nodes_[2 * node];
    nodes_[node].add(nodes_[2 * node + 1]);
  }

  template <class Visit>
  void visit_node(std::size_t node, const Range& range, const Box<N>& box, const Box<N>& local_box, double reach,
                  const Visit& visit) const {
    if (!nodes_[node].meets(local_box, reach)) return;
    if (!range.is_leaf()) {
      for (const unsigned second : {0u, 1u})
        visit_node(2 * node + second, range.half(second), box, local_box, reach, visit);
      return;
    }
    for (Index i = range.first; i < range.end; ++i)
      if (box_of(i).meets(box, reach)) visit(i);
  }

  void find_nearest(std::size_t node, const Range& range, const Place& p, Found& best) const {
    const auto is_nearer = [&](double square) {
      return best.factor * best.factor * square < best.nearest.distance * best.nearest.distance;
    };
    if (range.is_leaf()) {
      for (Index i = range.first; i < range.end; ++i)
        if (is_nearer(box_of(i).square_distance(p.point))) try_simplex(i, p.point, best);
      return;
    }
    const std::array<double, 2> squares = {nodes_[2 * node].square_distance(p.local),
                                           nodes_[2 * node + 1].square_distance(p.local)};
    const unsigned nearer = squares[1] < squares[0] ? 1 : 0;
    for (const unsigned child : {nearer, 1 - nearer})
      if (is_nearer(squares[child])) find_nearest(2 * node + child, range.half(child), p, best);
  }

  void try_simplex(Index s, const PointN<N>& p, Found& best) const {
    const CornersN<N> corners = simplices_[s];
    if (is_beyond(corners, p, best)) return;
    const PointN<N> way = way_from_simplex<N>(p, corners, N, best.nearest.distance);
    const double distance = norm(way);
    if (distance < best.nearest.distance) best = {{distance, s}, way, best.factor};
  }

  /// Whether all corners are beyond the hyperplane at right angles to the way, through the nearest point so far (up to
  /// rounding): then the simplex is not nearer. That decides most simplices around the nearest point.
  static bool is_beyond(const CornersN<N>& corners, const PointN<N>& p, const Found& best) {
    if (!(best.nearest.distance < std::numeric_limits<double>::infinity())) return false;
    constexpr double kRoundingShare = 1e-12;
    const double least = (1.0 - kRoundingShare) * dot(best.way, best.way);
    return std::all_of(corners.begin(), corners.end(),
                       [&](const PointN<N>& corner) { return dot(best.way, minus(p, corner)) >= least; });
  }

  SimplexCorners<N> simplices_;
  PointN<N> origin_{};
  Buffer<Node> nodes_;
};

}  // namespace tegl::detail
