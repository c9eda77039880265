// SPDX-License-Identifier: BSD-3-Clause
//
// Parts of a contour whose edges are contracted at the same time.
//
// Principle. Cuts along the axes assign each vertex to a part. Vertices next to a part of a smaller number belong to no
// part. So no simplex has vertices of two parts. A contraction of an edge between two vertices of a part changes only
// these vertices and the simplices at them, and reads only their neighbours, which are of the same part or of none. So
// it neither changes nor reads anything that a contraction in another part changes. Contractions keep this property if
// a vertex that was merged from vertices of different parts, or of none, belongs to none.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/simplex_shapes.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

template <int N>
class ContourParts {
 public:
  static constexpr std::size_t kCount = 8;
  /// The number of no part.
  static constexpr std::size_t kNone = kCount;

  /// `visit_simplices(visit)`: calls visit(simplex) for all. Coordinates are finite.
  template <class VisitSimplices>
  ContourParts(std::span<const PointN<N>> points, const VisitSimplices& visit_simplices) : part_(points.size()) {
    std::vector<PointN<N>> sample;
    const std::size_t step = 1 + points.size() / kMostSamples;
    for (std::size_t v = 0; v < points.size(); v += step) sample.push_back(points[v]);
    cut(1, sample);
    for (std::size_t v = 0; v < points.size(); ++v) part_[v] = part_at(points[v]);
    visit_simplices([&](const std::array<Index, N>& simplex) {
      std::uint8_t first = kCount;
      for (const Index v : simplex) first = std::min<std::uint8_t>(first, part_[v] & kNumber);
      for (const Index v : simplex)
        if ((part_[v] & kNumber) != first) part_[v] |= kNextToAnother;
    });
    for (std::uint8_t& part : part_)
      if ((part & kNextToAnother) != 0) part = kNone;
  }

  /// The part of both vertices; kNone if there is none.
  [[nodiscard]] std::size_t of(Index a, Index b) const { return part_[a] == part_[b] ? part_[a] : kNone; }
  /// Call it when the two vertices are merged into u.
  void merge(Index u, Index v) { part_[u] = static_cast<std::uint8_t>(of(u, v)); }

 private:
  static constexpr std::size_t kMostSamples = 4096;
  static constexpr std::uint8_t kNumber = 0x7f;
  static constexpr std::uint8_t kNextToAnother = 0x80;

  struct Cut {
    int axis;
    double at;
  };

  /// Cuts at the median of the longest axis.
  void cut(std::size_t node, std::span<PointN<N>> sample) {
    if (node >= kCount || sample.empty()) return;
    int axis = 0;
    double longest = -1.0;
    for (int a = 0; a < N; ++a) {
      const auto [low, high] =
          std::minmax_element(sample.begin(), sample.end(), [&](const auto& p, const auto& q) { return p[a] < q[a]; });
      if ((*high)[a] - (*low)[a] <= longest) continue;
      longest = (*high)[a] - (*low)[a];
      axis = a;
    }
    const std::size_t middle = sample.size() / 2;
    std::nth_element(sample.begin(), sample.begin() + static_cast<std::ptrdiff_t>(middle), sample.end(),
                     [&](const auto& p, const auto& q) { return p[axis] < q[axis]; });
    const double at = sample[middle][axis];
    cuts_[node] = {axis, at};
    // as part_at: which of several points at the median come first is not specified
    const auto right = std::partition(sample.begin(), sample.end(), [&](const auto& p) { return p[axis] < at; });
    const auto left = static_cast<std::size_t>(right - sample.begin());
    cut(2 * node, sample.first(left));
    cut(2 * node + 1, sample.subspan(left));
  }

  [[nodiscard]] std::uint8_t part_at(const PointN<N>& p) const {
    std::size_t node = 1;
    while (node < kCount) node = 2 * node + (p[cuts_[node].axis] >= cuts_[node].at ? 1 : 0);
    return static_cast<std::uint8_t>(node - kCount);
  }

  std::array<Cut, kCount> cuts_{};  ///< a binary tree: the cuts after cut i are 2 i and 2 i + 1
  std::vector<std::uint8_t> part_;  ///< by vertex
};

}  // namespace tegl::detail
