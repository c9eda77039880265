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

#include <fmt/format.h>

#include "base/exact_sum.hpp"
#include "base/workers.hpp"
#include "mesh/faces_of_stars.hpp"
#include "mesh/simplex_geometry.hpp"
#include "mesh/validate.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Items per block: large enough to amortize the cost of a block, small enough to occupy all threads.
inline constexpr std::size_t kBlock = 4096;

template <int N, class Real>
std::span<const Index> rows_of(const Contour<N, Real>& contour) noexcept {
  return {contour.simplices.empty() ? nullptr : contour.simplices.data()->data(), contour.simplices.size() * N};
}

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
template <int N, class Real>
std::vector<PieceSums<N>> sum_groups(const Contour<N, Real>& contour, const Groups& groups, unsigned threads,
                                     const Progress& progress) {
  const std::size_t count = groups.first.back();
  const auto reference_of = [&](std::size_t g) { return corners_of(contour, groups.member(groups.first[g]))[0]; };
  std::vector<std::vector<std::pair<std::size_t, PieceSums<N>>>> parts(block_count(count, kBlock));
  for_each_block(count, kBlock, threads, progress, [&](std::size_t block, std::size_t from, std::size_t to) {
    auto g = static_cast<std::size_t>(std::upper_bound(groups.first.begin(), groups.first.end(), from) -
                                      groups.first.begin()) -
             1;
    for (std::size_t i = from; i < to; ++g) {
      PieceSums<N> sums(reference_of(g));
      const std::size_t end = std::min(to, groups.first[g + 1]);
      for (; i < end; ++i) sums.add(corners_of(contour, groups.member(i)));
      parts[block].emplace_back(g, sums);
    }
  });
  std::vector<PieceSums<N>> result;
  for (std::size_t g = 0; g + 1 < groups.first.size(); ++g) result.emplace_back(reference_of(g));
  for (const auto& part : parts)
    for (const auto& [g, sums] : part) result[g].add(sums);
  return result;
}

/// Counts the faces of a complex by the label of their vertices (without labels: one label for all). Calls
/// on_open(block, ridge) for each (N-2)-face whose orientations do not cancel. Blocks run in parallel; the calls of one
/// block are sequential.
template <int N, class OnOpen>
std::vector<FaceCounts> count_faces(std::span<const Index> rows, const Stars& stars, std::span<const Index> labels,
                                    std::size_t label_count, bool with_euler, unsigned threads,
                                    const Progress& progress, const OnOpen& on_open) {
  const std::size_t vertices = stars.first.size() - 1;
  std::vector<std::vector<std::pair<Index, FaceCounts>>> parts(block_count(vertices, kBlock));
  for_each_block(
      vertices, kBlock, threads, progress, [&] { return FacesOfStars<N>(rows.data(), with_euler); },
      [&](std::size_t block, std::size_t from, std::size_t to, FacesOfStars<N>& faces) {
        auto& part = parts[block];
        for (std::size_t v = from; v < to; ++v) {
          const std::span<const Index> star = stars.of(v);
          if (star.empty()) continue;
          const Index label = labels.empty() ? 0 : labels[v];
          if (part.empty() || part.back().first != label) part.emplace_back(label, FaceCounts{});
          part.back().second +=
              faces.visit(static_cast<Index>(v), star, [&](const auto& ridge) { on_open(block, ridge); });
        }
      });
  std::vector<FaceCounts> result(label_count);
  for (const auto& part : parts)
    for (const auto& [label, counts] : part) result[label] += counts;
  return result;
}

/// The enclosed content from the sums of a contour; empty if the contour is open.
template <int N>
std::optional<double> content_of(const PieceSums<N>& sums, const FaceCounts& faces, GradientDirection direction) {
  if (faces.open > 0) return std::nullopt;
  const double content = sums.content.value() / N;
  return direction == GradientDirection::descent ? content : -content;
}

}  // namespace tegl::detail
