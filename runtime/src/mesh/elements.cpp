// SPDX-License-Identifier: BSD-3-Clause
//
// Elements of contours (centroid, normal, measure, attributes), by simplex and by tile; see tegl/elements.hpp.
#include "tegl/elements.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/disjoint_sets.hpp"
#include "base/exact_sum.hpp"
#include "base/progress.hpp"
#include "base/workers.hpp"
#include "image/locate.hpp"
#include "mesh/simplex_geometry.hpp"
#include "mesh/validate.hpp"

namespace tegl {

namespace {

/// A contour with coordinates of either type.
template <int N>
struct AnyContour {
  detail::SimplexView<N> simplices;
  std::span<const Attribute> vertex_attributes;
  std::span<const Attribute> simplex_attributes;

  template <class Real>
  explicit AnyContour(const Contour<N, Real>& contour)
      : simplices(contour),
        vertex_attributes(contour.vertex_attributes),
        simplex_attributes(contour.simplex_attributes) {}
};

/// Appends `count` rows of each attribute, without values.
void add_attributes(std::span<const Attribute> from, std::size_t count, std::vector<Attribute>& to) {
  for (const Attribute& attribute : from) {
    to.push_back({attribute.name, attribute.unit, attribute.width, {}});
    to.back().values.resize(count * static_cast<std::size_t>(attribute.width));
  }
}

template <int N>
Elements<N> make_elements(const AnyContour<N>& contour, std::size_t count) {
  Elements<N> result;
  result.centroids.resize(count);
  result.normals.resize(count);
  result.measures.resize(count);
  result.counts.resize(count);
  add_attributes(contour.vertex_attributes, count, result.attributes);
  add_attributes(contour.simplex_attributes, count, result.attributes);
  return result;
}

template <int N, class Real>
Elements<N> with_axes(Elements<N> elements, const Contour<N, Real>& contour) {
  elements.axis_names = contour.axis_names;
  elements.axis_units = contour.axis_units;
  elements.direction = contour.direction;
  return elements;
}

/// Interpolates the attributes of element s from its vertices.
template <int N>
void interpolate(const AnyContour<N>& contour, std::size_t s, std::vector<Attribute>& attributes) noexcept {
  std::size_t next = 0;
  for (const Attribute& from : contour.vertex_attributes) {
    const auto width = static_cast<std::size_t>(from.width);
    double* const to = attributes[next++].values.data() + s * width;
    for (std::size_t i = 0; i < width; ++i) {
      double sum = 0.0;
      for (const Index v : contour.simplices.simplices()[s]) sum += from.values[v * width + i];
      to[i] = sum / N;
    }
  }
  for (const Attribute& from : contour.simplex_attributes) {
    const auto width = static_cast<std::size_t>(from.width);
    std::copy_n(from.values.data() + s * width, width, attributes[next++].values.data() + s * width);
  }
}

/// A simplex and the place of its element: the tile number times 2 N + 1, plus the side of the border that a cap lies
/// in (1 + 2 axis + side; 0: none).
struct Placed {
  std::uint64_t place;
  Index simplex;
  bool operator<(const Placed& other) const { return std::tie(place, simplex) < std::tie(other.place, other.simplex); }
};

/// The place of each simplex, sorted. A tile is convex, so it contains the centroids of all its simplices.
template <int N>
std::vector<Placed> place_simplices(const Elements<N>& simplices, bool is_single, const Grid<N>& grid,
                                    const WorkOptions& work) {
  const double in_border = is_single ? 1e-5 : 1e-9;  // in grid steps: bound of the rounding of vertices
  constexpr std::uint64_t kNowhere = ~std::uint64_t{0};
  const detail::GridLocator<N> locator(grid);
  const std::array<std::size_t, N> sizes = grid.sizes();
  std::vector<Placed> placed(simplices.centroids.size());
  detail::for_each_item(placed.size(), work.threads, work.progress, [&](std::size_t s) {
    placed[s] = {kNowhere, static_cast<Index>(s)};
    detail::CellPlace<N> at;
    if (!locator.find(simplices.centroids[s], at)) return;
    std::uint64_t tile = 0;
    unsigned side = 0;
    for (int a = N - 1; a >= 0; --a) {
      if (sizes[a] < 2) return;
      tile = tile * (sizes[a] - 1) + at.base[a];
      if (at.base[a] == 0 && at.share[a] <= in_border) side = 1 + 2 * static_cast<unsigned>(a);
      if (at.base[a] + 2 == sizes[a] && at.share[a] >= 1.0 - in_border) side = 2 + 2 * static_cast<unsigned>(a);
    }
    placed[s].place = tile * (2 * N + 1) + side;
  });
  std::sort(placed.begin(), placed.end());
  if (!placed.empty() && placed.back().place == kNowhere)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("simplex {} has its centroid at ({}); expected it in a tile of the grid of {} samples",
                            placed.back().simplex, fmt::join(simplices.centroids[placed.back().simplex], ", "),
                            fmt::join(sizes, " x ")));
  return placed;
}

/// Finds the connected components, by shared vertices, of the simplices of one place.
template <int N>
class PieceFinder {
 public:
  explicit PieceFinder(std::span<const std::array<Index, N>> contour) : contour_(contour) {}

  /// Reorders the simplices by component: components by their first simplex, and simplices in order within each.
  /// Returns the ends of the components.
  const std::vector<std::size_t>& part(std::span<Placed> simplices) {
    sets_.reset(simplices.size());
    corners_.clear();
    for (std::size_t i = 0; i < simplices.size(); ++i)
      for (const Index v : contour_[simplices[i].simplex]) corners_.emplace_back(v, static_cast<Index>(i));
    std::sort(corners_.begin(), corners_.end());
    for (std::size_t i = 1; i < corners_.size(); ++i)
      if (corners_[i].first == corners_[i - 1].first) sets_.join(corners_[i].second, corners_[i - 1].second);
    order_.clear();
    for (std::size_t i = 0; i < simplices.size(); ++i)
      order_.emplace_back(sets_.find(static_cast<Index>(i)), simplices[i]);
    std::stable_sort(order_.begin(), order_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    ends_.clear();
    for (std::size_t i = 0; i < order_.size(); ++i) {
      simplices[i] = order_[i].second;
      if (i + 1 == order_.size() || order_[i + 1].first != order_[i].first) ends_.push_back(i + 1);
    }
    return ends_;
  }

 private:
  std::span<const std::array<Index, N>> contour_;
  detail::DisjointSets sets_;  ///< of simplices; the first simplex of a component is its root
  std::vector<std::pair<Index, Index>> corners_;
  std::vector<std::pair<Index, Placed>> order_;
  std::vector<std::size_t> ends_;
};

/// Computes element `to` of `result` from the elements of `simplices` in `piece`.
template <int N>
void merge(const Elements<N>& simplices, std::span<const Placed> piece, std::size_t to, Elements<N>& result) noexcept {
  double total = 0.0;
  std::array<double, N> normal{}, centroid{};
  for (const Placed& at : piece) total += simplices.measures[at.simplex];
  const auto weight = [&](Index s) {
    return total > 0.0 ? simplices.measures[s] / total : 1.0 / static_cast<double>(piece.size());
  };
  for (const Placed& at : piece)
    for (int a = 0; a < N; ++a) {
      normal[a] += simplices.normals[at.simplex][a];
      centroid[a] += weight(at.simplex) * simplices.centroids[at.simplex][a];
    }
  result.normals[to] = normal;
  result.centroids[to] = centroid;
  result.measures[to] = total;
  result.counts[to] = static_cast<Index>(piece.size());
  for (std::size_t k = 0; k < result.attributes.size(); ++k) {
    const auto width = static_cast<std::size_t>(result.attributes[k].width);
    const Buffer<double>& from = simplices.attributes[k].values;
    for (std::size_t i = 0; i < width; ++i) {
      double sum = 0.0;
      for (const Placed& at : piece)
        if (const double share = weight(at.simplex); share > 0.0) sum += share * from[at.simplex * width + i];
      result.attributes[k].values[to * width + i] = sum;
    }
  }
}

template <int N>
Elements<N> elements_of(const AnyContour<N>& contour, const WorkOptions& work) {
  Elements<N> result = make_elements(contour, contour.simplices.simplices().size());
  detail::for_each_item(contour.simplices.simplices().size(), work.threads, work.progress, [&](std::size_t s) {
    const auto corners = contour.simplices.corners(s);
    result.centroids[s] = detail::centroid_of<N>(corners);
    result.normals[s] = detail::normal_vector_of<N>(corners);
    result.measures[s] = detail::length_of<N>(result.normals[s]);
    result.counts[s] = 1;
    interpolate(contour, s, result.attributes);
  });
  return result;
}

template <int N>
Elements<N> elements_of_cells(const AnyContour<N>& contour, const Grid<N>& grid, const WorkOptions& work) {
  // Progress: two passes over all simplices and two over the sorted ones; only the last of these reports.
  const Elements<N> simplices = elements_of(contour, {work.threads, detail::part_of(work.progress, 0.0, 0.4)});
  std::vector<Placed> placed = place_simplices<N>(simplices, contour.simplices.is_single(), grid,
                                                  {work.threads, detail::part_of(work.progress, 0.4, 0.6)});
  std::vector<std::size_t> ends;  // of components in `placed`
  PieceFinder<N> finder(contour.simplices.simplices());
  for (std::size_t first = 0, end; first < placed.size(); first = end) {
    end = first;
    while (end < placed.size() && placed[end].place == placed[first].place) ++end;
    for (const std::size_t piece_end : finder.part(std::span(placed).subspan(first, end - first)))
      ends.push_back(first + piece_end);
  }
  // merge each component into an element
  Elements<N> result = make_elements(contour, ends.size());
  detail::for_each_item(ends.size(), work.threads, detail::part_of(work.progress, 0.8, 1.0), [&](std::size_t e) {
    const std::size_t first = e == 0 ? 0 : ends[e - 1];
    merge(simplices, std::span<const Placed>(placed).subspan(first, ends[e] - first), e, result);
  });
  return result;
}

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Elements<N> elements(const Contour<N, Real>& contour, const WorkOptions& work) {
  detail::require_sound(contour);
  return with_axes(elements_of(AnyContour<N>(contour), work), contour);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Elements<N> elements_by_cell(const Contour<N, Real>& contour, const Grid<N>& grid,
                                                                const WorkOptions& work) {
  detail::require_sound(contour);
  return with_axes(elements_of_cells(AnyContour<N>(contour), grid, work), contour);
}

template <int N>
requires DimensionBetween<N, 2, 5>
double ElementSum<N>::closure_error() const noexcept {
  double largest = 0.0;
  for (int a = 0; a < N; ++a)
    if (absolute[a] > 0.0) largest = std::max(largest, std::abs(normal[a]) / absolute[a]);
  return largest;
}

template <int N>
requires DimensionBetween<N, 2, 5> ElementSum<N> sum_of(const Elements<N>& elements) {
  std::array<detail::CompensatedSum, N> normal, absolute;
  detail::CompensatedSum measure;
  for (const auto& element : elements.normals)
    for (int a = 0; a < N; ++a) {
      normal[a].add(element[a]);
      absolute[a].add(std::abs(element[a]));
    }
  for (const double x : elements.measures) measure.add(x);
  ElementSum<N> result;
  for (int a = 0; a < N; ++a) {
    result.normal[a] = normal[a].value();
    result.absolute[a] = absolute[a].value();
  }
  result.measure = measure.value();
  return result;
}

#define TEGL_INSTANTIATE_REAL(N, Real)                                                 \
  template Elements<N> elements<N, Real>(const Contour<N, Real>&, const WorkOptions&); \
  template Elements<N> elements_by_cell<N, Real>(const Contour<N, Real>&, const Grid<N>&, const WorkOptions&);
#define TEGL_INSTANTIATE(N)                                      \
  TEGL_INSTANTIATE_REAL(N, float)                                \
  TEGL_INSTANTIATE_REAL(N, double)                               \
  template double ElementSum<N>::closure_error() const noexcept; \
  template ElementSum<N> sum_of<N>(const Elements<N>&);
TEGL_INSTANTIATE(2)
TEGL_INSTANTIATE(3)
TEGL_INSTANTIATE(4)
TEGL_INSTANTIATE(5)
#undef TEGL_INSTANTIATE
#undef TEGL_INSTANTIATE_REAL

}  // namespace tegl
