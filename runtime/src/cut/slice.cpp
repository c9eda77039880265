// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of whole contours, one or many in one pass: finds the simplices that touch each hyperplane.
#include "tegl/slice.hpp"

#include <algorithm>
#include <vector>

#include "base/progress.hpp"
#include "base/workers.hpp"
#include "cut/cutter.hpp"
#include "mesh/validate.hpp"

namespace tegl {
namespace {

using detail::Section;

template <int N>
using Vector = Eigen::Matrix<double, N, 1>;

/// The simplices that touch the level, ascending.
template <int N, class Real>
std::vector<Index> touching_simplices(const Contour<N, Real>& contour, const Section<N>& section, double level) {
  enum Side : unsigned char { kBelow = 1, kOn = 3, kAbove = 2 };  // on: counts as both
  std::vector<unsigned char> sides(contour.vertices.size());
  for (std::size_t v = 0; v < sides.size(); ++v) {
    const double height = section.height(contour.vertices[v]);
    sides[v] = height < level ? kBelow : height > level ? kAbove : kOn;
  }
  std::vector<Index> touching;
  for (std::size_t s = 0; s < contour.simplices.size(); ++s) {
    unsigned met = 0;
    for (const Index v : contour.simplices[s]) met |= sides[v];
    if (met == kOn) touching.push_back(static_cast<Index>(s));
  }
  return touching;
}

template <int N, class Real>
Contour<N - 1, Real> cut(const Contour<N, Real>& contour, const Section<N>& section, double offset) {
  detail::require_sound(contour);
  const double level = section.template level<Real>(offset);
  return detail::cut_simplices(contour, section, level, touching_simplices(contour, section, level));
}

/// By level, the simplices that touch it, ascending; levels ascend. Each simplex is read once.
template <int N, class Real>
std::vector<std::vector<Index>> touching_levels(const Contour<N, Real>& contour, const Section<N>& section,
                                                const std::vector<double>& levels) {
  std::vector<double> heights(contour.vertices.size());
  for (std::size_t v = 0; v < heights.size(); ++v) heights[v] = section.height(contour.vertices[v]);
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

void report(const Progress& progress, double fraction) { detail::tell(progress, fraction, "cuts cancelled"); }

}  // namespace

template <int N, class Real>
requires DimensionBetween<N, 3, 4> Contour<N - 1, Real> slice(const Contour<N, Real>& contour, double at) {
  return cut(contour, Section<N>(Vector<N>::Unit(N - 1)), at);
}

template <int N, class Real>
requires DimensionBetween<N, 3, 4> Contour<N - 1, Real> slice(const Contour<N, Real>& contour,
                                                              const Hyperplane<N>& hyperplane) {
  return cut(contour, Section<N>(hyperplane.normal), hyperplane.offset);
}

template <int N, class Real>
requires DimensionBetween<N, 3, 4> std::vector<Contour<N - 1, Real>> slice_stack(
    const Contour<N, Real>& contour, const Eigen::Matrix<double, N, 1>& normal, std::span<const double> offsets,
    const WorkOptions& options) {
  const Section<N> section(normal);
  detail::require_sound(contour);
  std::vector<double> levels;
  for (const double offset : offsets) levels.push_back(section.template level<Real>(offset));
  // simplices by distinct level
  std::vector<double> sorted = levels;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  report(options.progress, 0.0);
  const auto touching = touching_levels(contour, section, sorted);
  std::vector<Contour<N - 1, Real>> cuts(levels.size());
  struct Nothing {};
  detail::Workers<Nothing> workers(options.threads, [] { return Nothing(); });
  // One cut per thread at a time, so that progress can be reported between groups.
  for (std::size_t first = 0; first < cuts.size(); first += workers.count()) {
    report(options.progress, (1.0 + static_cast<double>(first)) / (1.0 + static_cast<double>(cuts.size())));
    const std::size_t count = std::min(workers.count(), cuts.size() - first);
    workers.for_range(count, 1, [&](std::size_t from, std::size_t to, Nothing&) {
      for (std::size_t i = first + from; i < first + to; ++i) {
        const auto place = std::lower_bound(sorted.begin(), sorted.end(), levels[i]) - sorted.begin();
        cuts[i] = detail::cut_simplices(contour, section, levels[i], touching[static_cast<std::size_t>(place)]);
      }
    });
  }
  report(options.progress, 1.0);
  return cuts;
}

#define TEGL_INSTANTIATE_SLICE(N, Real)                                                                               \
  template Contour<N - 1, Real> slice(const Contour<N, Real>&, double);                                               \
  template Contour<N - 1, Real> slice(const Contour<N, Real>&, const Hyperplane<N>&);                                 \
  template std::vector<Contour<N - 1, Real>> slice_stack(const Contour<N, Real>&, const Eigen::Matrix<double, N, 1>&, \
                                                         std::span<const double>, const WorkOptions&);
TEGL_INSTANTIATE_SLICE(3, float)
TEGL_INSTANTIATE_SLICE(3, double)
TEGL_INSTANTIATE_SLICE(4, float)
TEGL_INSTANTIATE_SLICE(4, double)

}  // namespace tegl
