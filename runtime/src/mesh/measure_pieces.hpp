// SPDX-License-Identifier: BSD-3-Clause
//
// Sums over a whole contour or over groups of simplices, shared by `measure` and `components`.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/exact_sum.hpp"
#include "base/progress.hpp"
#include "mesh/faces_of_stars.hpp"
#include "mesh/simplex_geometry.hpp"
#include "mesh/validate.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Items sorted by group: group g has members[first[g] … first[g + 1]), ascending.
struct Groups {
  std::vector<std::size_t> first;
  Buffer<Index> members;  ///< empty: all items in their own order

  [[nodiscard]] Index member(std::size_t i) const noexcept {
    return members.empty() ? static_cast<Index>(i) : members[i];
  }
  [[nodiscard]] std::span<const Index> of(std::size_t g) const noexcept {
    return std::span(members).subspan(first[g], first[g + 1] - first[g]);
  }
};

/// All items in one group.
inline Groups one_group(std::size_t count) { return {{0, count}, {}}; }

/// Groups the items by their labels 0 … count - 1. Items with other labels are in no group.
inline Groups group_by(std::span<const Index> labels, Index count, const Progress& progress = {}) {
  Groups groups;
  groups.first.assign(std::size_t{count} + 2, 0);  // counts are two places up, so that filling turns them into offsets
  in_parts(labels.size(), part_of(progress, 0.0, 0.4), [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      if (labels[i] < count) ++groups.first[labels[i] + std::size_t{2}];
  });
  for (std::size_t g = 1; g < groups.first.size(); ++g) groups.first[g] += groups.first[g - 1];
  groups.members.resize(groups.first.back());
  in_parts(labels.size(), part_of(progress, 0.4, 1.0), [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      if (labels[i] < count) groups.members[groups.first[labels[i] + std::size_t{1}]++] = static_cast<Index>(i);
  });
  groups.first.pop_back();
  return groups;
}

/// Sums over simplices. Coordinates are relative to a reference point near them, so that the terms are small.
template <int N>
struct PieceSums {
  CompensatedSum size;
  CompensatedSum content;  ///< N times the volume of the cone over the simplices with its apex at the reference point
  std::array<CompensatedSum, N> moment;
  PointOf<N> reference{};
  PointOf<N> lowest{};
  PointOf<N> highest{};

  explicit PieceSums(const PointOf<N>& at) : reference(at), lowest(at), highest(at) {}

  void add(const std::array<PointOf<N>, N>& corners) noexcept {
    const PointOf<N> normal = normal_vector_of<N>(corners);
    const double measure = length_of<N>(normal);
    size.add(measure);
    double flux = 0.0;
    for (int a = 0; a < N; ++a) {
      double middle = 0.0;
      for (const PointOf<N>& corner : corners) {
        middle += corner[a] - reference[a];
        lowest[a] = std::min(lowest[a], corner[a]);
        highest[a] = std::max(highest[a], corner[a]);
      }
      moment[a].add(measure * (middle / N));
      flux += normal[a] * (corners[0][a] - reference[a]);
    }
    content.add(flux);
  }
  /// Adds sums with the same reference point.
  void add(const PieceSums& other) noexcept {
    size.add(other.size.value());
    content.add(other.content.value());
    for (int a = 0; a < N; ++a) {
      moment[a].add(other.moment[a].value());
      lowest[a] = std::min(lowest[a], other.lowest[a]);
      highest[a] = std::max(highest[a], other.highest[a]);
    }
  }
  [[nodiscard]] PointOf<N> centroid() const noexcept {
    PointOf<N> middle;
    for (int a = 0; a < N; ++a)
      middle[a] = size.value() > 0 ? reference[a] + moment[a].value() / size.value()
                                   : lowest[a] + 0.5 * (highest[a] - lowest[a]);
    return middle;
  }
};

/// The sums of each group of simplices. No group may be empty.
template <int N>
std::vector<PieceSums<N>> sum_groups(const SimplexView<N>& contour, const Groups& groups, unsigned threads,
                                     const Progress& progress);

/// The enclosed content from the sums of a contour; empty if the contour is open.
template <int N>
std::optional<double> content_of(const PieceSums<N>& sums, const FaceCounts& faces, GradientDirection direction) {
  if (faces.open > 0) return std::nullopt;
  const double content = sums.content.value() / N;
  return direction == GradientDirection::descent ? content : -content;
}

}  // namespace tegl::detail
