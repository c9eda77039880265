// SPDX-License-Identifier: BSD-3-Clause
//
// Measures of a contour, and measures of its cuts without constructing them (measure_cuts is in cut/measure_cuts.cpp).
// The sums over the cuts of simplices are in cut_sums.cpp.
#include "tegl/measure.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "base/slice_at.hpp"
#include "base/workers.hpp"
#include "mesh/cut_sums.hpp"
#include "mesh/incidence_data.hpp"
#include "mesh/measure_pieces.hpp"
#include "mesh/open_ridges.hpp"

namespace tegl {
namespace {

using detail::CompensatedSum;
using detail::kBlock;
using detail::PointOf;

/// The requested values in ascending order, with lookup of those that cut a range from `low` to `high`.
class CutValues {
 public:
  /// `first`: the minimum of the contour, at which limits are from above.
  CutValues(std::span<const double> at, double first) : at_(at.size()), order_(at.size()), first_(first) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) { return at[a] < at[b]; });
    for (std::size_t i = 0; i < at.size(); ++i) at_[i] = at[order_[i]];
  }
  [[nodiscard]] std::size_t size() const noexcept { return at_.size(); }
  /// Ascending.
  [[nodiscard]] std::span<const double> all() const noexcept { return at_; }
  /// Index in the caller's list.
  [[nodiscard]] std::size_t place(std::size_t i) const noexcept { return order_[i]; }
  /// The number of values at most t; at the minimum of the contour, below t. The values that cut a simplex between two
  /// of its vertices, as in `between`, are those from the number of the lower to that of the higher one.
  [[nodiscard]] Index count_to(double t) const noexcept {
    const auto end =
        t == first_ ? std::lower_bound(at_.begin(), at_.end(), t) : std::upper_bound(at_.begin(), at_.end(), t);
    return static_cast<Index>(end - at_.begin());
  }

  /// The indices [from, to) of the values that cut a simplex from `low` to `high`: those in (low, high], as cuts are
  /// limits from below. A value at which one simplex ends and the next one begins cuts only the first of them. At the
  /// minimum of the contour the limit is from above: no simplex ends there, so those that begin there are cut at `low`,
  /// too.
  [[nodiscard]] std::pair<std::size_t, std::size_t> between(double low, double high) const noexcept {
    if (!(low < high)) return {0, 0};
    return {count_to(low), count_to(high)};
  }

 private:
  std::vector<double> at_;
  std::vector<std::size_t> order_;
  double first_;
};

/// By value, whether the cut is open: an (N-2)-face whose orientations do not cancel is cut there.
template <int N>
std::vector<bool> find_open_cuts(const detail::SimplexView<N>& contour, const CutValues& values,
                                 const WorkOptions& work) {
  std::vector<std::pair<double, double>> spans;
  detail::find_open_ridges<N>(contour.rows(), contour.vertex_count(), work.threads,
                              detail::part_of(work.progress, 0.0, 0.6), [&](const std::array<Index, N - 1>& ridge) {
                                const auto time = [&](Index v) { return contour.coordinate(v, N - 1); };
                                std::pair<double, double> span(time(ridge[0]), time(ridge[0]));
                                for (const Index v : ridge) {
                                  span.first = std::min(span.first, time(v));
                                  span.second = std::max(span.second, time(v));
                                }
                                spans.push_back(span);
                              });
  // count open faces by value, from the changes at their ends
  std::vector<std::int64_t> changes(values.size() + 1, 0);
  for (const auto& [low, high] : spans) {
    const auto [from, to] = values.between(low, high);
    ++changes[from];
    --changes[to];
  }
  std::vector<bool> open(values.size());
  std::int64_t faces = 0;
  for (std::size_t i = 0; i < open.size(); ++i) open[i] = (faces += changes[i]) > 0;
  return open;
}

/// Bounding box of the simplices; 0 if there are none.
template <int N>
std::pair<PointOf<N>, PointOf<N>> bounding_box(const detail::SimplexView<N>& contour) {
  if (contour.simplices().empty()) return {};
  PointOf<N> low = contour.corners(0)[0];
  PointOf<N> high = low;
  for (std::size_t s = 0; s < contour.simplices().size(); ++s)
    for (const PointOf<N>& corner : contour.corners(s))
      for (int a = 0; a < N; ++a) {
        low[a] = std::min(low[a], corner[a]);
        high[a] = std::max(high[a], corner[a]);
      }
  return {low, high};
}

/// `incidence`: null if it is not known.
template <int N>
Measures<N> measure_view(const detail::SimplexView<N>& contour, GradientDirection direction,
                         const detail::IncidenceData<N>* incidence, const WorkOptions& work) {
  Measures<N> result;
  if (contour.simplices().empty()) {
    result.content = 0.0;  // it has no boundary
    return result;
  }
  // boundary faces; label 0 for vertices of simplices, 1 for others
  const std::span<const Index> rows = contour.rows();
  detail::FaceCounts faces;
  Buffer<Index> of_vertices(contour.vertex_count());
  if (incidence != nullptr) {
    faces = detail::count_faces<N>(*incidence, {}, 1).front();
  } else {
    faces = detail::find_open_ridges<N>(rows, contour.vertex_count(), work.threads,
                                        detail::part_of(work.progress, 0.0, 0.7), [](const auto&) { /* counted */ });
  }
  std::fill(of_vertices.begin(), of_vertices.end(), Index{1});
  Index* const labels = of_vertices.data();  // checked builds do not inline operator[]
  for (const Index v : rows) labels[v] = 0;
  detail::tell(work.progress, 0.75);
  // sums over simplices
  const detail::PieceMeasures<N> all =
      detail::measure_pieces<N>(contour, of_vertices, {}, 1, work.threads, detail::part_of(work.progress, 0.75, 1.0))
          .front();
  result.size = all.size;
  result.content = detail::content_of(all, faces, direction);
  result.centroid = all.centroid;
  result.lowest = all.lowest;
  result.highest = all.highest;
  result.boundary_simplices = faces.boundary;
  result.open_simplices = faces.open;
  return result;
}

}  // namespace

template <int N>
std::vector<CutMeasures> detail::measure_cuts_of_view(const detail::SimplexView<N>& contour,
                                                      GradientDirection direction, std::span<const double> at,
                                                      const WorkOptions& work) {
  const auto [low, high] = bounding_box(contour);
  std::vector<double> levels;  // the values rounded as by `slice`
  for (const double t : at)
    levels.push_back(contour.is_single() ? static_cast<double>(detail::rounded_at<float>(t))
                                         : detail::rounded_at<double>(t));
  const CutValues values(levels, low[N - 1]);
  const std::vector<bool> open = find_open_cuts(contour, values, work);
  PointOf<N> origin;  // near the contour, so that the terms of the contents are small
  for (int a = 0; a < N; ++a) origin[a] = low[a] + 0.5 * (high[a] - low[a]);

  Buffer<Index> counts(contour.vertex_count());
  detail::for_each_item(counts.size(), work.threads, {}, [&](std::size_t v) {
    counts[v] = values.count_to(contour.coordinate(static_cast<Index>(v), N - 1));
  });
  // The partition depends only on the input, so sums are reproducible. Each part has its own sums for all values.
  const std::size_t simplices = contour.simplices().size();
  const std::size_t parts =
      std::clamp<std::size_t>((std::size_t{1} << 20) / std::max<std::size_t>(1, values.size()), 1, 64);
  const std::size_t size = std::max(kBlock, detail::block_count(simplices, parts));
  std::vector<detail::CutSums> sums(detail::block_count(simplices, size));
  detail::for_each_block(simplices, size, work.threads, detail::part_of(work.progress, 0.6, 1.0),
                         [&](std::size_t block, std::size_t from, std::size_t to) {
                           sums[block] = detail::CutSums(values.size());
                           detail::add_cuts<N>({contour, origin, values.all(), counts}, from, to, sums[block]);
                         });
  // add up the parts
  std::vector<CutMeasures> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    CompensatedSum total_size, total_content;
    for (const auto& part : sums) {
      total_size.add(part.size(i));
      total_content.add(part.content(i));
    }
    CutMeasures& cut = result[values.place(i)];
    cut.at = at[values.place(i)];
    cut.size = total_size.value();
    const double content = total_content.value() / (N - 1);
    if (!open[i]) cut.content = direction == GradientDirection::descent ? content : -content;
  }
  return result;
}

template std::vector<CutMeasures> detail::measure_cuts_of_view(const detail::SimplexView<3>&, GradientDirection,
                                                               std::span<const double>, const WorkOptions&);
template std::vector<CutMeasures> detail::measure_cuts_of_view(const detail::SimplexView<4>&, GradientDirection,
                                                               std::span<const double>, const WorkOptions&);
template std::vector<CutMeasures> detail::measure_cuts_of_view(const detail::SimplexView<5>&, GradientDirection,
                                                               std::span<const double>, const WorkOptions&);

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Measures<N> measure(const Contour<N, Real>& contour, const WorkOptions& work) {
  detail::require_vertices(contour);
  detail::require_finite(contour);
  return measure_view<N>(detail::SimplexView<N>(contour), contour.direction, nullptr, work);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Measures<N> measure(const Contour<N, Real>& contour, const Incidence<N>& incidence,
                                                       const WorkOptions& work) {
  const detail::SimplexView<N> view(contour);
  detail::require_incidence<N>(incidence.data(), view.rows(), view.vertex_count());
  detail::require_finite(contour);
  return measure_view<N>(view, contour.direction, &incidence.data(), work);
}

#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real)                              \
  template Measures<N> measure(const Contour<N, Real>&, const WorkOptions&); \
  template Measures<N> measure(const Contour<N, Real>&, const Incidence<N>&, const WorkOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
