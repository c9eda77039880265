// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of whole contours, one or many in one pass: finds the simplices that touch each hyperplane.
#include "tegl/slice.hpp"

#include <algorithm>
#include <vector>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "cut/closed_cut.hpp"
#include "mesh/validate.hpp"

namespace tegl {
namespace {

using detail::HyperplaneFamily;

/// The simplices that touch the level, ascending.
template <int N, class Real>
std::vector<Index> touching_simplices(const Contour<N, Real>& contour, const HyperplaneFamily<N>& family, double level,
                                      const Progress& progress) {
  enum Side : unsigned char { kBelow = 1, kOn = 3, kAbove = 2 };  // on: counts as both
  std::vector<unsigned char> sides(contour.vertices.size());
  detail::in_parts(sides.size(), detail::part_of(progress, 0.0, 0.5), [&](std::size_t from, std::size_t to) {
    // copies, because the compiler must assume that writing a char changes anything that it cannot see
    const HyperplaneFamily<N> heights = family;
    const auto* const points = contour.vertices.data();
    const double at = level;
    unsigned char* const side = sides.data();
    for (std::size_t v = from; v < to; ++v) {
      const double height = heights.height(points[v]);
      side[v] = height < at ? kBelow : height > at ? kAbove : kOn;
    }
  });
  std::vector<Index> touching;
  detail::in_parts(contour.simplices.size(), detail::part_of(progress, 0.5, 1.0),
                   [&](std::size_t from, std::size_t to) {
                     const auto* const simplices = contour.simplices.data();
                     const unsigned char* const side = sides.data();
                     for (std::size_t s = from; s < to; ++s) {
                       unsigned met = 0;
                       for (const Index v : simplices[s]) met |= side[v];
                       if (met == kOn) touching.push_back(static_cast<Index>(s));
                     }
                   });
  return touching;
}

/// By level, the simplices that touch it, ascending; levels ascend. Each simplex is read once.
template <int N, class Real>
std::vector<std::vector<Index>> touching_levels(const Contour<N, Real>& contour, const HyperplaneFamily<N>& family,
                                                const std::vector<double>& levels) {
  std::vector<double> heights(contour.vertices.size());
  for (std::size_t v = 0; v < heights.size(); ++v) heights[v] = family.height(contour.vertices[v]);
  std::vector<std::vector<Index>> touching(levels.size());
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) {
    const auto& simplex = contour.simplices[s];
    double least = heights[simplex[0]];
    double most = least;
    for (int j = 1; j < N; ++j) {
      least = std::min(least, heights[simplex[j]]);
      most = std::max(most, heights[simplex[j]]);
    }
    auto level = std::lower_bound(levels.begin(), levels.end(), least);
    for (; level != levels.end() && *level <= most; ++level)
      touching[static_cast<std::size_t>(level - levels.begin())].push_back(static_cast<Index>(s));
  }
  return touching;
}

/// The hyperplanes of a stack that have the same normal.
template <int N>
struct Parallels {
  Vector<N> normal;
  HyperplaneFamily<N> family;
  std::vector<double> levels;                ///< ascending, each once
  std::vector<std::vector<Index>> touching;  ///< by level, the simplices that touch it
};

/// A hyperplane of a stack.
struct StackedCut {
  std::size_t parallels;  ///< index of its `Parallels`
  double level;
};

/// Groups the hyperplanes by normal. Throws InvalidArgument as `slice` does.
template <int N, class Real>
std::vector<StackedCut> group_by_normal(std::span<const Hyperplane<N>> hyperplanes, std::vector<Parallels<N>>& groups) {
  std::vector<StackedCut> stack;
  for (const Hyperplane<N>& hyperplane : hyperplanes) {
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const Parallels<N>& other) { return other.normal == hyperplane.normal; });
    if (group == groups.end())
      group = groups.insert(group, {hyperplane.normal, HyperplaneFamily<N>(hyperplane.normal), {}, {}});
    const double level = group->family.template level<Real>(hyperplane.offset);
    group->levels.push_back(level);
    stack.push_back({static_cast<std::size_t>(group - groups.begin()), level});
  }
  for (Parallels<N>& group : groups) {
    std::sort(group.levels.begin(), group.levels.end());
    group.levels.erase(std::unique(group.levels.begin(), group.levels.end()), group.levels.end());
  }
  return stack;
}

constexpr const char* kCancelledSlice = "cuts cancelled";

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 4> Contour<N - 1, Real> slice(const Contour<N, Real>& contour,
                                                              const Hyperplane<N>& hyperplane,
                                                              const WorkOptions& work) {
  const HyperplaneFamily<N> family(hyperplane.normal);
  detail::require_sound(contour);
  const double level = family.template level<Real>(hyperplane.offset);
  const Progress finding = detail::part_of(work.progress, 0.0, 0.8);
  Contour<N - 1, Real> cut =
      detail::cut_simplices(contour, family, level, touching_simplices(contour, family, level, finding));
  detail::tell(work.progress, 1.0, kCancelledSlice);
  return cut;
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 4> std::vector<Contour<N - 1, Real>> slice_stack(
    const Contour<N, Real>& contour, std::type_identity_t<std::span<const Hyperplane<N>>> hyperplanes,
    const WorkOptions& work) {
  std::vector<Parallels<N>> groups;
  const std::vector<StackedCut> stack = group_by_normal<N, Real>(hyperplanes, groups);
  detail::require_sound(contour);
  const auto steps = static_cast<double>(groups.size() + stack.size());
  // one pass over the contour for each normal
  for (std::size_t i = 0; i < groups.size(); ++i) {
    detail::tell(work.progress, static_cast<double>(i) / steps, kCancelledSlice);
    groups[i].touching = touching_levels(contour, groups[i].family, groups[i].levels);
  }
  const auto cut_of = [&](const StackedCut& cut) {
    const Parallels<N>& group = groups[cut.parallels];
    const auto place = std::lower_bound(group.levels.begin(), group.levels.end(), cut.level) - group.levels.begin();
    return detail::cut_simplices(contour, group.family, cut.level, group.touching[static_cast<std::size_t>(place)]);
  };
  // the cuts: one per thread at a time, so that progress can be reported between them
  std::vector<Contour<N - 1, Real>> cuts(stack.size());
  struct Nothing {};
  detail::Workers<Nothing> workers(work.threads, [] { return Nothing(); });
  for (std::size_t first = 0; first < cuts.size(); first += workers.count()) {
    detail::tell(work.progress, static_cast<double>(groups.size() + first) / steps, kCancelledSlice);
    const std::size_t count = std::min(workers.count(), cuts.size() - first);
    workers.for_range(count, 1, [&](std::size_t from, std::size_t to, Nothing&) {
      for (std::size_t i = first + from; i < first + to; ++i) cuts[i] = cut_of(stack[i]);
    });
  }
  detail::tell(work.progress, 1.0, kCancelledSlice);
  return cuts;
}

#define TEGL_INSTANTIATE_SLICE(N, Real)                                                                           \
  template Contour<N - 1, Real> slice(const Contour<N, Real>&, const Hyperplane<N>&, const WorkOptions&);         \
  template std::vector<Contour<N - 1, Real>> slice_stack(const Contour<N, Real>&, std::span<const Hyperplane<N>>, \
                                                         const WorkOptions&);
TEGL_INSTANTIATE_SLICE(3, float)
TEGL_INSTANTIATE_SLICE(3, double)
TEGL_INSTANTIATE_SLICE(4, float)
TEGL_INSTANTIATE_SLICE(4, double)
#undef TEGL_INSTANTIATE_SLICE

}  // namespace tegl
