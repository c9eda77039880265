// SPDX-License-Identifier: BSD-3-Clause
//
// Bounds of the distances of flat simplices by those of their neighbours. Flat simplices in folds, where a corner of a
// grid's cell is hardly above the isovalue, are in no prism of their own, and halving them hardly lowers their bounds.
//
// Principle. Divide the corners of a simplex into A and B, and let d be the distance of their hulls (0 for Radon's
// partition of a simplex without content). Every point x of the simplex is between a point of A's hull and one of B's.
// B's hull is made up of the hulls of a point q in it and all corners of B but one. If q is the point next to A's hull,
// replacing it by a point of A's hull moves x by at most d, into the facet opposite to the corner left out. So x is
// within d of a facet opposite to a corner of B, and at most so much farther from another contour than the simplices
// across these facets.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/workers.hpp"
#include "mesh/simplex_shapes.hpp"
#include "simplify/facet_neighbours.hpp"
#include "simplify/scaled_simplices.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

template <int N>
class FlatSimplices {
 public:
  /// Finds the flat simplices with bounds above `enough`, and their neighbours. `bounds`: by simplex.
  FlatSimplices(const ScaledSimplices<N>& contour, double enough, const std::vector<double>& bounds, unsigned threads,
                const Progress& progress) {
    std::vector<std::vector<Partition>> parts(block_count(bounds.size(), kBlock));
    for_each_block(bounds.size(), kBlock, threads, part_of(progress, 0.0, 0.5),
                   [&](std::size_t block, std::size_t first, std::size_t end) {
                     for (std::size_t s = first; s < end; ++s)
                       if (bounds[s] > enough) add_partitions(contour.corners[s], static_cast<Index>(s), parts[block]);
                   });
    for (const auto& part : parts) partitions_.insert(partitions_.end(), part.begin(), part.end());
    if (partitions_.empty()) return;
    const FacetNeighbours<N> neighbours(contour.simplices, contour.points.size(), threads, part_of(progress, 0.5, 1.0));
    for (Partition& one : partitions_)
      for (int corner = 0; corner < N; ++corner) one.across[corner] = neighbours.across(one.simplex, corner);
  }

  /// Whether some partition's parts are near each other.
  static bool is_flat(const CornersN<N>& corners) {
    std::vector<Partition> found;
    add_partitions(corners, 0, found);
    return !found.empty();
  }

  /// Lowers bounds to those of the neighbours and the distances from them.
  void lower(std::vector<double>& bounds) const {
    bool is_lower = true;
    for (int sweep = 0; is_lower && sweep < kMostSweeps; ++sweep) {
      is_lower = false;
      for (const Partition& one : partitions_) {
        const double bound = one.bound(bounds);
        if (!(bound < bounds[one.simplex])) continue;
        bounds[one.simplex] = bound;
        is_lower = true;
      }
    }
  }

 private:
  static constexpr Index kNone = FacetNeighbours<N>::kNone;
  static constexpr std::size_t kBlock = 4096;
  /// Distance of the parts, in longest edges. Simplices with larger ones are bounded by their own prisms.
  static constexpr double kNear = 1e-2;
  /// In longest edges: more than the rounding errors of distances.
  static constexpr double kRounding = 1e-14;
  /// Flat simplices are mostly beside others that are not flat, or beside a few flat ones.
  static constexpr int kMostSweeps = 16;

  /// A partition of the corners of a simplex into A and B.
  struct Partition {
    double apart;  ///< distance of the hulls of its two parts
    Index simplex;
    unsigned corners;  ///< bit i: corner i is in B
    std::array<Index, N> across = {};

    [[nodiscard]] double bound(const std::vector<double>& bounds) const {
      double largest = 0.0;
      for (unsigned rest = corners; rest != 0; rest &= rest - 1) {
        const Index next = across[std::countr_zero(rest)];
        if (next == kNone) return std::numeric_limits<double>::infinity();
        largest = std::max(largest, bounds[next]);
      }
      return largest + apart;
    }
  };

  /// Distance of the hull of the corners in `part` from that of the others, at most N pairs of corners.
  static double distance_of_parts(const CornersN<N>& corners, unsigned part) {
    if constexpr (N == 2) return norm(minus(corners[0], corners[1]));
    CornersN<N> ways;
    int count = 0;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j)
        if ((part >> i & 1u) != 0 && (part >> j & 1u) == 0) ways[count++] = minus(corners[i], corners[j]);
    return distance_to_simplex<N>(PointN<N>{}, ways, count);
  }

  static void add_partitions(const CornersN<N>& corners, Index s, std::vector<Partition>& found) {
    // The content is at most the distance times the longest edge to the power N - 2, both without the factor (N - 1)!.
    if (shape_of_simplex<N>(corners, norm(normal_of<N>(corners))) > kNear) return;
    const double edge = longest_edge<N>(corners);
    for (unsigned part = 1; part + 1 < 1u << N; ++part)
      if (const double apart = distance_of_parts(corners, part); apart <= kNear * edge)
        found.push_back({apart + kRounding * edge, s, part});
  }

  std::vector<Partition> partitions_;
};

}  // namespace tegl::detail
