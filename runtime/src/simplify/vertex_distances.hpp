// SPDX-License-Identifier: BSD-3-Clause
//
// Distances of a contour's vertices from another contour. Most are found by a walk that begins where the one of a
// neighbouring vertex ended; only those that matter are searched exactly.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "mesh/simplex_shapes.hpp"
#include "simplify/box_tree.hpp"
#include "simplify/simplex_walk.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

template <int N>
class VertexDistances {
 public:
  using Simplices = std::span<const std::array<Index, N>>;

  VertexDistances(Simplices simplices, std::span<const PointN<N>> points, const BoxTree<N>& tree,
                  const SimplexWalk<N>& walk, unsigned threads)
      : points_(points), tree_(tree), walk_(walk), threads_(threads), near_(points.size()), exact_(points.size(), 0) {
    find_parents(simplices);
  }

  /// Finds a point of the other contour near each vertex.
  void approach(const Progress& progress) {
    for_each_block(points_.size(), kGrain, threads_, progress, [&](std::size_t, std::size_t first, std::size_t end) {
      Index last = 0;
      for (std::size_t v = first; v < end; ++v) {
        near_[v] = approached(v, first, last);
        last = near_[v].simplex;
      }
    });
  }

  /// The largest distance of a vertex of a simplex; 0 if there are none. Searches vertices exactly, those that seem
  /// farthest first, until no other one can be farther.
  double find_largest(const Progress& progress) {
    std::vector<Index> order;
    for (Index v = 0; v < points_.size(); ++v)
      if (parents_[v] != kUnused) order.push_back(v);
    const auto is_farther = [&](Index a, Index b) {
      return near_[a].distance != near_[b].distance ? near_[a].distance > near_[b].distance : a < b;
    };
    double largest = 0.0;
    for (std::size_t i = 0; i < order.size();) {
      // a fixed number in each step: the result does not depend on the number of threads
      const std::span<Index> step(order.data() + i, std::min(kStep, order.size() - i));
      // mostly one step is enough, so the others are sorted only if they are needed
      if (i == 0 && step.size() < order.size())
        std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kStep), order.end(), is_farther);
      if (i == 0) std::sort(step.begin(), step.end(), is_farther);
      if (i == kStep) std::sort(order.begin() + static_cast<std::ptrdiff_t>(i), order.end(), is_farther);
      if (!(near_[step.front()].distance > largest)) break;
      search(step, part_of(progress, static_cast<double>(i) / static_cast<double>(order.size()), 1.0));
      for (const Index v : step) largest = std::max(largest, near_[v].distance);
      i += step.size();
    }
    return largest;
  }

  /// Makes all distances above `most` exact.
  void search_above(double most, const Progress& progress) {
    std::vector<Index> left;
    for (Index v = 0; v < points_.size(); ++v)
      if (exact_[v] == 0 && near_[v].distance > most) left.push_back(v);
    search(left, progress);
  }

  [[nodiscard]] const std::vector<NearPoint>& near() const noexcept { return near_; }

 private:
  static constexpr Index kNone = std::numeric_limits<Index>::max();
  static constexpr Index kUnused = kNone - 1;
  static constexpr std::size_t kGrain = 4096;
  static constexpr std::size_t kStep = 2048;
  static constexpr double kRough = 2.0;

  /// By vertex: the neighbour with the largest smaller number. Extraction numbers neighbours one after the other.
  void find_parents(Simplices simplices) {
    parents_.assign(points_.size(), kUnused);
    for (auto simplex : simplices) {
      std::sort(simplex.begin(), simplex.end());
      for (int i = 0; i < N; ++i) {
        Index& parent = parents_[simplex[i]];
        if (parent == kUnused) parent = kNone;
        if (i > 0 && (parent == kNone || parent < simplex[i - 1])) parent = simplex[i - 1];
      }
    }
  }

  NearPoint approached(std::size_t v, std::size_t first, Index last) {
    const PointN<N>& p = points_[v];
    const Index parent = parents_[v];
    if (parent == kUnused) return {};
    const bool known = parent != kNone && parent >= first && parent < v;
    const NearPoint found = walk_.approach_nearly(p, known ? near_[parent].simplex : last);
    // A walk that ends much farther away than the one of the parent has probably missed the nearest point.
    if (known) {
      const double step = norm(minus(p, points_[parent]));
      if (found.distance <= std::max(step, near_[parent].distance + 0.5 * step)) return found;
    }
    // A rough search finds where to begin instead.
    return walk_.approach(p, tree_.within_factor(p, found.simplex, kRough).simplex);
  }

  [[nodiscard]] NearPoint nearest(std::size_t v, Index guess) const {
    const auto [distance, simplex] = tree_.nearest(points_[v], guess);
    return {distance, simplex};
  }

  void search(std::span<const Index> vertices, const Progress& progress) {
    for_each_block(vertices.size(), kSearched, threads_, progress,
                   [&](std::size_t, std::size_t first, std::size_t end) {
                     for (const Index v : vertices.subspan(first, end - first)) {
                       if (exact_[v] == 0) near_[v] = nearest(v, near_[v].simplex);
                       exact_[v] = 1;
                     }
                   });
  }
  static constexpr std::size_t kSearched = 128;

  std::span<const PointN<N>> points_;
  const BoxTree<N>& tree_;
  const SimplexWalk<N>& walk_;
  unsigned threads_;
  std::vector<NearPoint> near_;
  std::vector<std::uint8_t> exact_;
  std::vector<Index> parents_;  ///< kNone: no neighbour with a smaller number; kUnused: in no simplex
};

}  // namespace tegl::detail
