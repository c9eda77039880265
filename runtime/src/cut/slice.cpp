// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of whole contours, one or many in one pass: finds the simplices that touch each hyperplane.
#include "tegl/slice.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <vector>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "cut/closed_cut.hpp"
#include "cut/crossed_periods.hpp"
#include "cut/each_cut.hpp"
#include "cut/periodic_cut.hpp"
#include "cut/vertex_range.hpp"
#include "mesh/validate.hpp"

namespace tegl {
namespace {

using detail::HyperplaneFamily;
using detail::Side;

constexpr std::size_t kBlock = std::size_t{1} << 14;  ///< vertices or simplices of a part of the work
constexpr std::size_t kNeighbours = 256;              ///< simplices that are skipped together

/// The sides of all vertices, and of ranges of them.
class VertexSides {
 public:
  /// Throws InvalidArgument unless all coordinates are finite.
  template <int N, class Real>
  VertexSides(const Contour<N, Real>& contour, const HyperplaneFamily<N>& family, double level, const WorkOptions& work)
      : sides_(contour.vertices.size()), of_groups_(detail::block_count(sides_.size(), kGroup)) {
    static_assert(kBlock % kGroup == 0);
    std::atomic<bool> finite = true;
    detail::for_each_block(sides_.size(), kBlock, work.threads, work.progress,
                           [&](std::size_t, std::size_t from, std::size_t to) {
                             // copies, because the compiler must assume that writing a char changes anything that it
                             // cannot see
                             const HyperplaneFamily<N> heights = family;
                             const auto* const points = contour.vertices.data();
                             const double at = level;
                             Side* const side = sides_.data();
                             const std::span block_points(points + from, to - from);
                             if (!detail::are_finite(detail::flat_rows<Real, N>(block_points))) finite = false;
                             for (std::size_t v = from; v < to; ++v) {
                               const double height = heights.height(points[v]);
                               side[v] = height < at ? Side::below : height > at ? Side::above : Side::on;
                             }
                             for (std::size_t first = from; first < to; first += kGroup) {
                               unsigned char all = 0;
                               for (std::size_t v = first; v < std::min(first + kGroup, to); ++v)
                                 all |= static_cast<unsigned char>(side[v]);
                               of_groups_[first / kGroup] = static_cast<Side>(all);
                             }
                           });
    if (!finite) detail::require_finite(contour);
    find_runs();
  }

  [[nodiscard]] std::span<const Side> by_vertex() const noexcept { return sides_; }
  /// Whether all vertices of the range are certainly on the same side, and none is on the level.
  [[nodiscard]] bool are_alike(const detail::VertexRange& range) const {
    const std::size_t first = range.least / kGroup;
    return of_groups_[first] != Side::on && range.most / kGroup < run_ends_[first];
  }

 private:
  static constexpr std::size_t kGroup = 128;  ///< vertices

  /// The groups after each one that are alike with it end there.
  void find_runs() {
    run_ends_.resize(of_groups_.size());
    for (std::size_t g = of_groups_.size(); g-- > 0;) {
      const bool goes_on = g + 1 < of_groups_.size() && of_groups_[g + 1] == of_groups_[g];
      run_ends_[g] = goes_on ? run_ends_[g + 1] : g + 1;
    }
  }

  Buffer<Side> sides_;
  std::vector<Side> of_groups_;        ///< by group of vertices: all their sides
  std::vector<std::size_t> run_ends_;  ///< by group
};

/// The simplices that touch the level, ascending. Throws InvalidArgument unless all vertex numbers are below the number
/// of vertices.
template <int N, class Real>
std::vector<Index> touching_simplices(const Contour<N, Real>& contour, const VertexSides& sides,
                                      const WorkOptions& work) {
  // by block, then in a row
  const std::size_t count = contour.simplices.size();
  std::vector<std::vector<Index>> parts(detail::block_count(count, kBlock));
  std::atomic<bool> sound = true;
  detail::for_each_block(
      count, kBlock, work.threads, work.progress, [&](std::size_t block, std::size_t from, std::size_t to) {
        const auto* const simplices = contour.simplices.data();
        const Side* const side = sides.by_vertex().data();
        std::array<Index, kBlock> found;
        std::size_t size = 0;
        // Most simplices have all vertices on one side, and so have those around them.
        for (std::size_t first = from; first < to; first += kNeighbours) {
          const std::size_t end = std::min(first + kNeighbours, to);
          const std::span neighbours(simplices + first, end - first);
          const detail::VertexRange range = detail::vertex_range(detail::flat_rows<Index, N>(neighbours));
          if (range.most >= contour.vertices.size()) {
            sound = false;
            return;
          }
          if (sides.are_alike(range)) continue;
          for (std::size_t s = first; s < end; ++s) {
            unsigned met = 0;
            for (const Index v : simplices[s]) met |= static_cast<unsigned>(side[v]);
            found[size] = static_cast<Index>(s);
            size += met == static_cast<unsigned>(Side::on) ? 1 : 0;
          }
        }
        parts[block].assign(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(size));
      });
  if (!sound) detail::require_vertices(contour);
  std::vector<Index> touching;
  std::size_t all = 0;
  for (const auto& part : parts) all += part.size();
  touching.reserve(all);
  for (const auto& part : parts) touching.insert(touching.end(), part.begin(), part.end());
  return touching;
}

/// Simplices by level, ascending.
struct TouchingSimplices {
  std::vector<std::size_t> first;  ///< by level, and the end
  Buffer<Index> simplices;

  [[nodiscard]] std::span<const Index> of(std::size_t level) const noexcept {
    return std::span(simplices).subspan(first[level], first[level + 1] - first[level]);
  }
};

/// By level, the simplices that touch it; levels ascend. Each simplex is read once.
template <int N, class Real>
TouchingSimplices touching_levels(const Contour<N, Real>& contour, const HyperplaneFamily<N>& family,
                                  const std::vector<double>& levels, unsigned threads) {
  // by vertex: the first level at or above it, and the end of the levels at or below it
  struct Reach {
    Index first, end;
  };
  Buffer<Reach> reach(contour.vertices.size());
  detail::for_each_item(reach.size(), threads, {}, [&](std::size_t v) {
    const double height = family.height(contour.vertices[v]);
    const auto level = std::lower_bound(levels.begin(), levels.end(), height);
    const auto first = static_cast<Index>(level - levels.begin());
    reach[v] = {first, first + (level != levels.end() && *level == height ? 1u : 0u)};
  });
  // count by block and level, then by level and block, then list
  const std::size_t count = contour.simplices.size();
  const std::size_t size = std::max(kBlock, detail::block_count(count, 64));
  const std::size_t blocks = detail::block_count(count, size);
  std::vector<std::vector<std::size_t>> next(blocks, std::vector<std::size_t>(levels.size(), 0));
  const auto for_touching = [&](const auto& visit) {
    detail::for_each_block(count, size, threads, {}, [&](std::size_t block, std::size_t from, std::size_t to) {
      for (std::size_t s = from; s < to; ++s) {
        const auto& simplex = contour.simplices[s];
        Reach all = reach[simplex[0]];
        for (int j = 1; j < N; ++j) {
          all.first = std::min(all.first, reach[simplex[j]].first);
          all.end = std::max(all.end, reach[simplex[j]].end);
        }
        for (Index level = all.first; level < all.end; ++level) visit(next[block][level], s);
      }
    });
  };
  for_touching([](std::size_t& places, std::size_t) { ++places; });
  TouchingSimplices touching;
  touching.first.push_back(0);
  for (std::size_t level = 0; level < levels.size(); ++level) {
    std::size_t place = touching.first.back();
    for (auto& of_block : next) {
      const std::size_t places = of_block[level];
      of_block[level] = place;
      place += places;
    }
    touching.first.push_back(place);
  }
  touching.simplices.resize(touching.first.back());
  for_touching([&](std::size_t& place, std::size_t s) { touching.simplices[place++] = static_cast<Index>(s); });
  return touching;
}

/// The periods that hyperplanes cross. Throws InvalidArgument if wrapped contours have no such cuts.
template <int N>
detail::CrossedPeriods<N> periods_to_cut(const HyperplaneFamily<N>& family, std::span<const Period<N>> periods) {
  detail::CrossedPeriods<N> crossed = detail::crossed_periods<N>(family, periods);
  if (!crossed.has_cuts)
    throw Error(ErrorCode::InvalidArgument,
                "slice of a wrapped contour across one of its periods, along which it does not repeat itself within 32 "
                "periods; expected another hyperplane, or an unrolled contour");
  return crossed;
}

/// The hyperplane <normal, x> = offset, at which the contour is cut: in the first period, if it crosses one.
template <class Real, int N>
detail::MovedLevel level_of(const HyperplaneFamily<N>& family, const detail::CrossedPeriods<N>& crossed,
                            double offset) {
  if (!crossed.any) return {family.template level<Real>(offset), 0.0};
  return detail::level_in_period<Real>(family, crossed, offset);
}

/// Cuts a contour none of whose periods the hyperplane crosses.
template <int N, class Real>
Contour<N - 1, Real> cut_at(const Contour<N, Real>& contour, const HyperplaneFamily<N>& family, double level,
                            const WorkOptions& work) {
  const VertexSides sides(contour, family, level, {work.threads, detail::part_of(work.progress, 0.0, 0.4)});
  detail::require_attributes(contour);
  const Progress finding = detail::part_of(work.progress, 0.4, 0.8);
  return detail::cut_simplices(contour, family, level, touching_simplices(contour, sides, {work.threads, finding}),
                               work.threads, sides.by_vertex());
}

/// The hyperplanes of a stack that have the same normal.
template <int N, class Real>
struct Parallels {
  Vector<N> normal;
  HyperplaneFamily<N> family;
  detail::CrossedPeriods<N> crossed;
  std::vector<double> levels;  ///< ascending, each once
  TouchingSimplices touching;
  Contour<N, Real> moved;  ///< if they cross a period, the simplices that touch them

  [[nodiscard]] const Contour<N, Real>& of(const Contour<N, Real>& contour) const {
    return crossed.any ? moved : contour;
  }
};

/// A hyperplane of a stack.
struct StackedCut {
  std::size_t parallels;  ///< index of its `Parallels`
  double level;           ///< at which the contour is cut
  double times;           ///< periods across from there to the hyperplane
};

/// Groups the hyperplanes by normal. Throws InvalidArgument as `slice` does.
template <int N, class Real>
std::vector<StackedCut> group_by_normal(const Contour<N, Real>& contour, std::span<const Hyperplane<N>> hyperplanes,
                                        std::vector<Parallels<N, Real>>& groups) {
  std::vector<StackedCut> stack;
  for (const Hyperplane<N>& hyperplane : hyperplanes) {
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const Parallels<N, Real>& other) { return other.normal == hyperplane.normal; });
    if (group == groups.end()) {
      const HyperplaneFamily<N> family(hyperplane.normal);
      group = groups.insert(group, {hyperplane.normal, family, periods_to_cut<N>(family, contour.periods), {}, {}, {}});
    }
    const auto [level, times] = level_of<Real>(group->family, group->crossed, hyperplane.offset);
    group->levels.push_back(level);
    stack.push_back({static_cast<std::size_t>(group - groups.begin()), level, times});
  }
  for (Parallels<N, Real>& group : groups) {
    std::sort(group.levels.begin(), group.levels.end());
    group.levels.erase(std::unique(group.levels.begin(), group.levels.end()), group.levels.end());
  }
  return stack;
}

constexpr const char* kCancelledSlice = "slices cancelled";

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5> Contour<N - 1, Real> slice(const Contour<N, Real>& contour,
                                                              const Hyperplane<N>& hyperplane,
                                                              const WorkOptions& work) {
  const HyperplaneFamily<N> family(hyperplane.normal);
  const detail::CrossedPeriods<N> crossed = periods_to_cut<N>(family, contour.periods);
  detail::require_near(family, crossed, contour.axis_names, hyperplane.offset);
  const auto [level, times] = level_of<Real>(family, crossed, hyperplane.offset);
  Contour<N - 1, Real> cut;
  if (crossed.any) {
    detail::require_sound(contour);
    cut = cut_at(detail::moved_to_levels(contour, family, crossed, std::span(&level, 1),
                                         {work.threads, detail::part_of(work.progress, 0.0, 0.6)}),
                 family, level, {work.threads, detail::part_of(work.progress, 0.6, 1.0)});
    detail::move_within(cut, family, crossed, times, work.threads);
  } else {
    cut = cut_at(contour, family, level, work);
  }
  detail::tell(work.progress, 1.0, kCancelledSlice);
  return cut;
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 3, 5> std::vector<Contour<N - 1, Real>> slice_stack(
    const Contour<N, Real>& contour, std::type_identity_t<std::span<const Hyperplane<N>>> hyperplanes,
    const WorkOptions& work) {
  std::vector<Parallels<N, Real>> groups;
  const std::vector<StackedCut> stack = group_by_normal<N, Real>(contour, hyperplanes, groups);
  for (std::size_t i = 0; i < stack.size(); ++i)
    detail::require_near(groups[stack[i].parallels].family, groups[stack[i].parallels].crossed, contour.axis_names,
                         hyperplanes[i].offset);
  detail::require_sound(contour);
  const auto steps = static_cast<double>(groups.size() + stack.size());
  // one pass over the contour for each normal
  for (std::size_t i = 0; i < groups.size(); ++i) {
    detail::tell(work.progress, static_cast<double>(i) / steps, kCancelledSlice);
    if (groups[i].crossed.any)
      groups[i].moved = detail::moved_to_levels<N, Real>(
          contour, groups[i].family, groups[i].crossed, groups[i].levels,
          {work.threads,
           detail::part_of(work.progress, static_cast<double>(i) / steps, static_cast<double>(i + 1) / steps)});
    groups[i].touching = touching_levels(groups[i].of(contour), groups[i].family, groups[i].levels, work.threads);
  }
  const auto cut_of = [&](const StackedCut& cut) {
    const Parallels<N, Real>& group = groups[cut.parallels];
    const auto place = std::lower_bound(group.levels.begin(), group.levels.end(), cut.level) - group.levels.begin();
    Contour<N - 1, Real> moved = detail::cut_simplices(group.of(contour), group.family, cut.level,
                                                       group.touching.of(static_cast<std::size_t>(place)));
    detail::move_within(moved, group.family, group.crossed, cut.times, 1);
    return moved;
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

template <int N, class Real>
void detail::for_each_cut(const Contour<N, Real>& contour, std::span<const double> at, const WorkOptions& work,
                          UseCut<N, Real> use) {
  constexpr std::size_t kTogether = 256;  // levels whose simplices are listed at a time
  std::vector<Hyperplane<N>> hyperplanes;
  for (const double t : at) hyperplanes.push_back(Hyperplane<N>::across(N - 1, t));
  std::vector<Parallels<N, Real>> groups;
  const std::vector<StackedCut> stack = group_by_normal<N, Real>(contour, hyperplanes, groups);
  detail::require_sound(contour);
  if (groups.empty()) return;
  Parallels<N, Real>& group = groups.front();
  const std::vector<double>& all = group.levels;
  std::vector<std::vector<std::size_t>> places(all.size());
  for (std::size_t i = 0; i < stack.size(); ++i)
    places[static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), stack[i].level) - all.begin())].push_back(
        i);
  if (group.crossed.any)
    group.moved = detail::moved_to_levels<N, Real>(contour, group.family, group.crossed, group.levels,
                                                   {work.threads, detail::part_of(work.progress, 0.0, 0.1)});
  detail::tell(work.progress, 0.1, kCancelledSlice);
  const Contour<N, Real>& moved = group.of(contour);
  struct Nothing {};
  const std::size_t threads = detail::Workers<Nothing>(work.threads, [] { return Nothing(); }).count();
  for (std::size_t first = 0; first < all.size(); first += kTogether) {
    const std::size_t count = std::min(all.size() - first, kTogether);
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(first);
    const TouchingSimplices touching =
        touching_levels(moved, group.family, {begin, begin + static_cast<std::ptrdiff_t>(count)}, work.threads);
    const auto done = [&](std::size_t i) {
      return 0.1 + 0.9 * static_cast<double>(i) / static_cast<double>(all.size());
    };
    const unsigned inside = count < threads ? work.threads : 1;
    detail::for_each_block(
        count, 1, count < threads ? 1 : work.threads, detail::part_of(work.progress, done(first), done(first + count)),
        [&](std::size_t i, std::size_t, std::size_t) {
          use(places[first + i], detail::cut_simplices(moved, group.family, all[first + i], touching.of(i), inside),
              inside);
        });
  }
}

#define TEGL_INSTANTIATE_SLICE(N, Real)                                                                           \
  template Contour<N - 1, Real> slice(const Contour<N, Real>&, const Hyperplane<N>&, const WorkOptions&);         \
  template std::vector<Contour<N - 1, Real>> slice_stack(const Contour<N, Real>&, std::span<const Hyperplane<N>>, \
                                                         const WorkOptions&);                                     \
  template void detail::for_each_cut(const Contour<N, Real>&, std::span<const double>, const WorkOptions&,        \
                                     UseCut<N, Real>);
TEGL_INSTANTIATE_SLICE(3, float)
TEGL_INSTANTIATE_SLICE(3, double)
TEGL_INSTANTIATE_SLICE(4, float)
TEGL_INSTANTIATE_SLICE(4, double)
TEGL_INSTANTIATE_SLICE(5, float)
TEGL_INSTANTIATE_SLICE(5, double)
#undef TEGL_INSTANTIATE_SLICE

}  // namespace tegl
