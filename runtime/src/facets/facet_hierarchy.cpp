// SPDX-License-Identifier: BSD-3-Clause
//
// Queries and checks of a hierarchy of facets, and the public function `extract_facets`, instantiated for all value
// types.
#include "tegl/facet_hierarchy.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/progress.hpp"
#include "facets/facet_extraction.hpp"
#include "image/row_source.hpp"
#include "kernel/extract_kernel.hpp"
#include "periodic/periodic_layers.hpp"
#include "periodic/periods.hpp"

namespace tegl {

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void FacetHierarchy<N, Real>::connect_up(const WorkOptions& work) {
  for (int k = 0; k + 1 < N; ++k) {
    const Progress progress = detail::part_of(work.progress, k / (N - 1.0), (k + 1) / (N - 1.0));
    Level& level = levels[k];
    const Level& above = levels[k + 1];
    level.up_first.assign(count(k) + 1, 0);
    for (const Index f : above.down) ++level.up_first[f + 1];
    std::partial_sum(level.up_first.begin(), level.up_first.end(), level.up_first.begin());
    level.up.resize(above.down.size());
    level.up_signs.resize(above.down.size());
    detail::in_parts(count(k + 1), progress, [&](std::size_t from, std::size_t to) {
      for (std::size_t g = from; g < to; ++g)
        for (Index e = above.down_first[g]; e < above.down_first[g + 1]; ++e) {
          const Index at = level.up_first[above.down[e]]++;
          level.up[at] = static_cast<Index>(g);
          level.up_signs[at] = above.down_signs[e];
        }
    });
    // Filling moved each offset to the next one: shift them back.
    std::copy_backward(level.up_first.begin(), level.up_first.end() - 1, level.up_first.end());
    level.up_first.front() = 0;
  }
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> std::vector<Index> FacetHierarchy<N, Real>::points_of(int k, std::size_t f)
const {
  if (k == 0) return {static_cast<Index>(f)};
  const auto below = down(k, f);
  const auto signs = down_signs(k, f);
  if (k == 1) return {below.begin(), below.end()};
  std::vector<Index> result;
  if (k == 2) {
    for (std::size_t i = 0; i < below.size(); ++i) result.push_back(down(1, below[i])[signs[i] > 0 ? 0 : 1]);
    return result;
  }
  for (const Index polygon : below) {
    const auto segments = down(2, polygon);
    const auto directions = down_signs(2, polygon);
    for (std::size_t i = 0; i < segments.size(); ++i) result.push_back(down(1, segments[i])[directions[i] > 0 ? 0 : 1]);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
int facet_euler(const FacetHierarchy<N, Real>& facets, int k, std::size_t f) {
  if (k < 3) return 1;
  // Half of the Euler characteristic of the boundary, as for any compact 3-manifold. Each segment of the boundary is in
  // two polygons.
  int twice_segments = 0;
  for (const Index polygon : facets.down(k, f)) twice_segments += static_cast<int>(facets.down(2, polygon).size());
  const int points = static_cast<int>(facets.points_of(k, f).size());
  return (points - twice_segments / 2 + static_cast<int>(facets.down(k, f).size())) / 2;
}

namespace {

/// Whether the boundary of the boundary of a facet is zero.
template <int N, class Real>
bool has_closed_boundary(const FacetHierarchy<N, Real>& facets, int k, std::size_t f,
                         std::vector<std::pair<Index, int>>& sum) {
  sum.clear();
  const auto below = facets.down(k, f);
  const auto signs = facets.down_signs(k, f);
  if (k == 1) return below.size() == 2 && signs[0] == -1 && signs[1] == 1;
  for (std::size_t i = 0; i < below.size(); ++i) {
    const auto bounds = facets.down(k - 1, below[i]);
    const auto bound_signs = facets.down_signs(k - 1, below[i]);
    for (std::size_t j = 0; j < bounds.size(); ++j) sum.push_back({bounds[j], signs[i] * bound_signs[j]});
  }
  std::sort(sum.begin(), sum.end());
  // Each face occurs twice with opposite signs, because the boundary of a facet is a manifold, in which two facets
  // meet.
  if (sum.empty() || sum.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < sum.size(); i += 2)
    if (sum[i].first != sum[i + 1].first || sum[i].second != -1 || sum[i + 1].second != 1) return false;
  return true;
}

/// A point of a polygon.
template <int N, class Real>
Index a_point(const FacetHierarchy<N, Real>& facets, Index polygon) noexcept {
  return facets.down(1, facets.down(2, polygon)[0])[0];
}

template <int N, class Real>
void check_ridges(const FacetHierarchy<N, Real>& facets, FacetReport& report) {
  std::vector<std::int8_t> signs(facets.count(N - 2), 0);
  std::vector<std::uint8_t> uses(facets.count(N - 2), 0);
  const auto& tops = facets.levels[N - 1];
  for (std::size_t e = 0; e < tops.down.size(); ++e) {
    std::uint8_t& count = uses[tops.down[e]];
    if (count < 3) ++count;
    if (count == 2 && signs[tops.down[e]] == tops.down_signs[e]) ++report.conflicts;
    signs[tops.down[e]] = tops.down_signs[e];
  }
  for (const std::uint8_t count : uses) {
    if (count == 1) ++report.border;
    if (count == 0 || count > 2) ++report.branching;
  }
}

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> FacetReport check(const FacetHierarchy<N, Real>& facets, const WorkOptions& work) {
  FacetReport report;
  std::vector<std::pair<Index, int>> sum;
  detail::DisjointSets components;
  components.reset(facets.count(0));
  report.components = facets.count(0);
  for (int k = 0; k < N; ++k) {
    report.facets[k] = facets.count(k);
    const int sign = k % 2 == 0 ? 1 : -1;
    const Progress progress = detail::part_of(work.progress, static_cast<double>(k) / N, (k + 1.0) / N);
    const auto check_one = [&](std::size_t f) {
      const int euler = facet_euler(facets, k, f);
      report.euler += sign * euler;
      if (euler == 0) ++report.tori;
      if (euler < 0) ++report.below_zero;
      if (euler > 1) ++report.above_one;
      if (k > 0 && !has_closed_boundary(facets, k, f, sum)) ++report.open_boundaries;
      // The points of a component are connected by segments, or by a polyhedron whose boundary has several components.
      if (k == 1 && components.join(facets.down(1, f)[0], facets.down(1, f)[1])) --report.components;
      if (k == 3)
        for (const Index polygon : facets.down(3, f))
          if (components.join(a_point(facets, facets.down(3, f)[0]), a_point(facets, polygon))) --report.components;
    };
    detail::in_parts(facets.count(k), progress, [&](std::size_t from, std::size_t to) {
      for (std::size_t f = from; f < to; ++f) check_one(f);
    });
  }
  check_ridges(facets, report);
  return report;
}

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> FacetHierarchy<N, Real> extract_facets(const Image<T, N>& image, double isovalue,
                                                                          const ExtractOptions& options,
                                                                          const AxisPeriods<N>& periods) {
  detail::check_arguments(isovalue, options);
  unsigned axes = 0;
  for (int a = 0; a < N; ++a) axes |= periods[a] != 0.0 ? 1u << a : 0u;
  if (axes == 0) {
    detail::ImageSource<T, N> source(image, isovalue, options.epsilon);
    return detail::extract_facets<N, Real>(source, image.grid(), options);
  }
  detail::check_periods(image.grid(), periods, options);
  const Grid<N> longer = detail::longer_grid(image.grid(), periods);
  detail::CopiedSource<T, N> source(image, periods, longer, options, isovalue);
  auto facets = detail::extract_facets<N, Real>(source, longer, options, axes);
  facets.periods = detail::world_periods(image.grid(), periods);
  return facets;
}

#define TEGL_INSTANTIATE_CONTOURS(N, Real)                                             \
  template struct FacetHierarchy<N, Real>;                                             \
  template int facet_euler<N, Real>(const FacetHierarchy<N, Real>&, int, std::size_t); \
  template FacetReport check<N, Real>(const FacetHierarchy<N, Real>&, const WorkOptions&);
#include "base/instantiate.hpp"

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                                                       \
  template FacetHierarchy<N, Real> extract_facets<Real, T, N>(const Image<T, N>&, double, const ExtractOptions&, \
                                                              const AxisPeriods<N>&);
#include "base/instantiate.hpp"

}  // namespace tegl
