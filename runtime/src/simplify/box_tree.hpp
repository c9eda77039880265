// SPDX-License-Identifier: BSD-3-Clause
//
// A bounding volume hierarchy of simplices for range and nearest-neighbour queries: a binary tree of boxes over
// simplices in the order of a space-filling curve (C. Lauterbach et al., Fast BVH construction on GPUs, 2009).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "mesh/simplex_shapes.hpp"
#include "simplify/simplex_corners.hpp"
#include "tegl/contour.hpp"

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
  explicit BoxTree(const SimplexCorners<N>& simplices) : simplices_(simplices) {
    nodes_.reserve(simplices.size());
    if (simplices.size() != 0) build(0, static_cast<Index>(simplices.size()));
  }

  /// Calls visit(simplex) for every simplex whose box is within `reach` of the box along every axis.
  template <class Visit>
  void visit_near(const Box<N>& box, double reach, const Visit& visit) const {
    if (!nodes_.empty()) visit_node(0, box, reach, visit);
  }

  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    Index simplex = 0;
  };
  /// The nearest simplex; the distance is infinite if there is none.
  [[nodiscard]] Nearest nearest(const PointN<N>& p) const {
    Found best;
    if (!nodes_.empty()) find_nearest(0, p, best);
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
    find_nearest(0, p, best);
    return best.nearest;
  }

 private:
  static constexpr Index kLeafSize = 4;
  struct Node {
    Box<N> box;
    Index first = 0, end = 0;  ///< simplices of a leaf; 0, 0 for inner nodes
    Index right = 0;           ///< right child; the left child is the next node
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

  Index build(Index first, Index end) {
    const auto number = static_cast<Index>(nodes_.size());
    nodes_.emplace_back();
    if (end - first <= kLeafSize) {
      Box<N> box;
      for (Index i = first; i < end; ++i) box.add(box_of(i));
      nodes_[number] = {box, first, end, 0};
      return number;
    }
    const Index middle = first + (end - first) / 2;
    build(first, middle);
    const Index right = build(middle, end);
    Box<N> box = nodes_[number + 1].box;
    box.add(nodes_[right].box);
    nodes_[number] = {box, 0, 0, right};
    return number;
  }

  template <class Visit>
  void visit_node(Index number, const Box<N>& box, double reach, const Visit& visit) const {
    const Node& node = nodes_[number];
    if (!node.box.meets(box, reach)) return;
    for (Index i = node.first; i < node.end; ++i)
      if (box_of(i).meets(box, reach)) visit(i);
    if (node.end != 0) return;
    visit_node(number + 1, box, reach, visit);
    visit_node(node.right, box, reach, visit);
  }

  void find_nearest(Index number, const PointN<N>& p, Found& best) const {
    const auto is_nearer = [&](double square) {
      return best.factor * best.factor * square < best.nearest.distance * best.nearest.distance;
    };
    const Node& node = nodes_[number];
    for (Index i = node.first; i < node.end; ++i)
      if (is_nearer(box_of(i).square_distance(p))) try_simplex(i, p, best);
    if (node.end != 0) return;
    std::array<std::pair<double, Index>, 2> next = {{{nodes_[number + 1].box.square_distance(p), number + 1},
                                                     {nodes_[node.right].box.square_distance(p), node.right}}};
    if (next[1].first < next[0].first) std::swap(next[0], next[1]);
    for (const auto& [square, child] : next)
      if (is_nearer(square)) find_nearest(child, p, best);
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
    constexpr double kRounding = 1e-12;
    const double least = (1.0 - kRounding) * dot(best.way, best.way);
    return std::all_of(corners.begin(), corners.end(),
                       [&](const PointN<N>& corner) { return dot(best.way, minus(p, corner)) >= least; });
  }

  SimplexCorners<N> simplices_;
  Buffer<Node> nodes_;
};

}  // namespace tegl::detail
