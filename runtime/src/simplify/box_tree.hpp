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

#include "base/radix_sort.hpp"
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
    boxes_.resize(simplices.size());
    for (std::size_t s = 0; s < simplices.size(); ++s)
      for (const PointN<N>& corner : simplices[s]) boxes_[s].add(corner);
    sort_along_curve();
    std::vector<Box<N>> in_order;  // in the order of the leaves
    in_order.reserve(boxes_.size());
    for (const Index s : order_) in_order.push_back(boxes_[s]);
    boxes_.swap(in_order);
    nodes_.reserve(boxes_.size());
    if (!order_.empty()) build(0, static_cast<Index>(order_.size()));
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
    if (end - first <= kLeafSize) {
      Box<N> box;
      for (Index i = first; i < end; ++i) box.add(boxes_[i]);
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

  /// Orders the simplices by the middles of their boxes, along the curve that interleaves the bits of the coordinates.
  void sort_along_curve() {
    constexpr unsigned kBits = std::min(16, 64 / N);
    constexpr double kMostCells = (1u << kBits) - 1;
    Box<N> all;
    for (const Box<N>& box : boxes_) all.add(box);
    struct Keyed {
      std::uint64_t key;
      Index simplex;
    };
    std::vector<Keyed> keyed(boxes_.size());
    for (Index s = 0; s < boxes_.size(); ++s) {
      std::array<std::uint64_t, N> cell{};
      for (int a = 0; a < N; ++a) {
        const double share = (0.5 * (boxes_[s].low[a] + boxes_[s].high[a]) - all.low[a]) / (all.high[a] - all.low[a]);
        if (share > 0.0) cell[a] = static_cast<std::uint64_t>(std::min(1.0, share) * kMostCells);
      }
      std::uint64_t key = 0;
      for (unsigned bit = kBits; bit-- > 0;)
        for (int a = 0; a < N; ++a) key = key << 1 | (cell[a] >> bit & 1u);
      keyed[s] = {key, s};
    }
    sort_by_bits(keyed, kBits * N, [](const Keyed& one) { return one.key; });
    for (std::size_t i = 0; i < keyed.size(); ++i) order_[i] = keyed[i].simplex;
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
