// SPDX-License-Identifier: BSD-3-Clause
//
// A bounding volume hierarchy of simplices for range and nearest-neighbour queries: a binary tree of boxes, split at
// the median along the longest axis.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "mesh/simplex_shapes.hpp"
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

/// Bounding volume hierarchy of simplices with N corners each. The simplices must outlive it.
template <int N>
class BoxTree {
 public:
  explicit BoxTree(std::span<const CornersN<N>> simplices) : simplices_(simplices), order_(simplices.size()) {
    std::iota(order_.begin(), order_.end(), Index{0});
    boxes_.resize(simplices.size());
    for (std::size_t s = 0; s < simplices.size(); ++s)
      for (const PointN<N>& corner : simplices[s]) boxes_[s].add(corner);
    if (!order_.empty()) build(0, static_cast<Index>(order_.size()));
    std::vector<Box<N>> in_order;  // in the order of the leaves
    in_order.reserve(boxes_.size());
    for (const Index s : order_) in_order.push_back(boxes_[s]);
    boxes_.swap(in_order);
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
    Nearest best;
    if (!nodes_.empty()) find_nearest(0, p, best);
    return best;
  }
  /// The nearest simplex, found faster if `guess` is near. Among equally near simplices the result may depend on the
  /// guess.
  [[nodiscard]] Nearest nearest(const PointN<N>& p, Index guess) const {
    Nearest best = {distance_to_simplex<N>(p, simplices_[guess], N), guess};
    find_nearest(0, p, best);
    return best;
  }

 private:
  static constexpr Index kLeafSize = 4;
  struct Node {
    Box<N> box;
    Index first = 0, end = 0;  ///< simplices of a leaf in order_; 0, 0 for inner nodes
    Index right = 0;           ///< right child; the left child is the next node
  };

  Index build(Index first, Index end) {
    const auto number = static_cast<Index>(nodes_.size());
    nodes_.emplace_back();
    Box<N> box;
    for (Index i = first; i < end; ++i) box.add(boxes_[order_[i]]);
    nodes_[number].box = box;
    if (end - first <= kLeafSize) {
      nodes_[number].first = first;
      nodes_[number].end = end;
      return number;
    }
    int axis = 0;
    for (int a = 1; a < N; ++a)
      if (box.high[a] - box.low[a] > box.high[axis] - box.low[axis]) axis = a;
    const Index middle = first + (end - first) / 2;
    const auto key = [&](Index s) { return boxes_[s].low[axis] + boxes_[s].high[axis]; };
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + end,
                     [&](Index a, Index b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
    build(first, middle);
    const Index right = build(middle, end);
    nodes_[number].right = right;
    return number;
  }

  template <class Visit>
  void visit_node(Index number, const Box<N>& box, double reach, const Visit& visit) const {
    const Node& node = nodes_[number];
    if (!node.box.meets(box, reach)) return;
    for (Index i = node.first; i < node.end; ++i)
      if (boxes_[i].meets(box, reach)) visit(order_[i]);
    if (node.end != 0) return;
    visit_node(number + 1, box, reach, visit);
    visit_node(node.right, box, reach, visit);
  }

  void find_nearest(Index number, const PointN<N>& p, Nearest& best) const {
    const Node& node = nodes_[number];
    for (Index i = node.first; i < node.end; ++i) {
      const Index s = order_[i];
      if (boxes_[i].square_distance(p) >= best.distance * best.distance) continue;
      const double distance = distance_to_simplex<N>(p, simplices_[s], N, best.distance);
      if (distance < best.distance) best = {distance, s};
    }
    if (node.end != 0) return;
    std::array<std::pair<double, Index>, 2> next = {{{nodes_[number + 1].box.square_distance(p), number + 1},
                                                     {nodes_[node.right].box.square_distance(p), node.right}}};
    if (next[1].first < next[0].first) std::swap(next[0], next[1]);
    for (const auto& [square, child] : next)
      if (square < best.distance * best.distance) find_nearest(child, p, best);
  }

  std::span<const CornersN<N>> simplices_;
  std::vector<Index> order_;
  std::vector<Box<N>> boxes_;  ///< in the order of order_, after the build
  std::vector<Node> nodes_;
};

}  // namespace tegl::detail
