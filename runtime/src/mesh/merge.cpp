// SPDX-License-Identifier: BSD-3-Clause
//
// Merges coincident vertices. Dropping the simplices that then repeat a vertex opens no gap: replacing vertices is a
// simplicial map, which commutes with taking the boundary.
//
// Based on: M. Liversage, thesis, 1994, remark 7.8.4 (there by the index of the sample at which vertices coincide).
#include "tegl/merge.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>

#include <fmt/format.h>

#include "base/periods.hpp"
#include "base/progress.hpp"
#include "base/workers.hpp"
#include "mesh/coincident_vertices.hpp"
#include "mesh/contour_part.hpp"
#include "mesh/faces_of_stars.hpp"
#include "mesh/flat_division.hpp"
#include "mesh/link_checker.hpp"
#include "mesh/shrunk_places.hpp"
#include "mesh/simplex_geometry.hpp"
#include "mesh/validate.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/components.hpp"
#include "tegl/error.hpp"

namespace tegl {
namespace {

using detail::part_of;

/// Links between two progress calls.
constexpr std::size_t kLinksAtOnce = 1024;

/// The Euler characteristic.
template <int N>
std::int64_t euler_of(std::span<const Index> rows, const detail::Stars& stars, const WorkOptions& work) {
  const auto ignore = [](std::size_t, const typename detail::FacesOfStars<N>::Ridge&) {};
  const auto counts = detail::count_faces<N>(rows, stars, {}, 1, true, work.threads, work.progress, ignore);
  return counts.front().euler;
}

template <int N, class Real>
std::span<const Index> simplex_rows(const Contour<N, Real>& contour) {
  return detail::flat_rows(std::span<const std::array<Index, N>>(contour.simplices));
}

/// One merging.
template <int N, class Real>
class Merger {
 public:
  using Simplex = std::array<Index, N>;
  using Part = typename detail::FlatDivision<N, Real>::Part;

  Merger(const Contour<N, Real>& contour, const MergeOptions& options) : contour_(contour), options_(options) {}

  Merging<N, Real> run() {
    detail::CoincidentVertices<N, Real> coincident(contour_.vertices, least_tolerance());
    kept_ = coincident.find(progress(0.0, 0.3));
    result_.report.counts.before = {contour_.vertices.size(), contour_.simplices.size()};
    const detail::Stars before = detail::make_stars<N>(simplex_rows(contour_), contour_.vertices.size(),
                                                       options_.work.threads, progress(0.3, 0.4));
    result_.report.counts.euler_before = euler_of<N>(simplex_rows(contour_), before, work(0.4, 0.5));
    collapse();
    list_vanished();
    const Buffer<std::uint8_t> is_changed = make_contour();
    find_pinches(is_changed);
    return std::move(result_);
  }

 private:
  [[nodiscard]] Progress progress(double first, double last) const {
    return part_of(options_.work.progress, first, last);
  }
  [[nodiscard]] WorkOptions work(double first, double last) const {
    return {options_.work.threads, progress(first, last)};
  }

  /// The tolerance; from 4D on at least the step by which `extract` keeps vertices off layers (in 5D of two axes).
  [[nodiscard]] double least_tolerance() const {
    if (N < 4 || options_.tolerance > 0.0) return options_.tolerance;
    double largest = 0.0;
    for (const auto& vertex : contour_.vertices)
      for (int a = N == 5 ? N - 2 : N - 1; a < N; ++a)
        largest = std::max(largest, std::abs(static_cast<double>(vertex[a])));
    return 4.0 * static_cast<double>(std::numeric_limits<Real>::epsilon()) * largest;
  }

  /// Makes the list of simplices that stay.
  void collapse() {
    MergeReport<N>& report = result_.report;
    for (std::size_t v = 0; v < kept_.size(); ++v) report.counts.merged_vertices += kept_[v] != v ? 1 : 0;
    parts_.reserve(contour_.simplices.size());
    for (std::size_t s = 0; s < contour_.simplices.size(); ++s) {
      Simplex simplex = contour_.simplices[s];
      for (Index& v : simplex) v = kept_[v];
      if (detail::is_collapsed<N>(simplex.data())) {
        ++report.counts.collapsed_simplices;
        continue;
      }
      if (has_turned(contour_.simplices[s], simplex)) ++report.counts.turned_simplices;
      parts_.push_back({simplex, static_cast<Index>(s)});
    }
    shrunk_ = detail::ShrunkPlaces<N>(contour_.simplices, kept_).find();
    if constexpr (N == 2) return;  // segments of zero length repeat a vertex
    detail::FlatDivision<N, Real> division(parts_, contour_.vertices);
    division.run();
    report.counts.flat_simplices = division.dropped();
    report.counts.kept_flat_simplices = division.left();
    report.counts.divided_simplices = division.divided();
    std::erase_if(parts_, [](const Part& part) { return part.is_dropped; });
    std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) { return a.origin < b.origin; });
  }

  [[nodiscard]] bool has_turned(const Simplex& before, const Simplex& after) const {
    if (options_.tolerance == 0.0 || before == after) return false;
    const auto corners = [&](const Simplex& simplex) {
      std::array<detail::PointOf<N>, N> points;
      for (int j = 0; j < N; ++j)
        for (int a = 0; a < N; ++a) points[j][a] = static_cast<double>(contour_.vertices[simplex[j]][a]);
      return points;
    };
    const auto first = detail::normal_vector_of<N>(corners(before)),
               second = detail::normal_vector_of<N>(corners(after));
    double product = 0.0;
    for (int a = 0; a < N; ++a) product += first[a] * second[a];
    return product < 0.0;
  }

  /// Lists the components of which nothing is left, and the places in others that shrank.
  void list_vanished() {
    const ComponentLabels labels = label_components(contour_, work(0.5, 0.55));
    result_.report.counts.components_before = labels.count;
    std::vector<std::uint8_t> is_left(labels.count, 0), is_listed(labels.count, 0);
    for (const Part& part : parts_) is_left[labels.simplices[part.origin]] = 1;
    for (std::size_t v = 0; v < contour_.vertices.size(); ++v) {
      const Index label = labels.vertices[v];
      if (label == kNoComponent || is_left[label] != 0 || is_listed[label] != 0) continue;
      is_listed[label] = 1;
      ++result_.report.counts.vanished_components;
      list_place(v, result_.report.vanished);
    }
    std::optional<Index> last;
    for (const Index v : shrunk_) {
      if (is_left[labels.vertices[v]] == 0 || last == kept_[v]) continue;
      last = kept_[v];
      ++result_.report.counts.shrunk_places;
      list_place(kept_[v], result_.report.shrunk);
    }
  }
  /// Appends the place of a vertex, unless the list is full.
  void list_place(std::size_t v, std::vector<std::array<double, N>>& places) const {
    if (places.size() >= options_.most_listed) return;
    auto& place = places.emplace_back();
    for (int a = 0; a < N; ++a) place[a] = static_cast<double>(contour_.vertices[v][a]);
  }

  /// Copies what stays to the result. Returns by vertex whether its link may have changed.
  Buffer<std::uint8_t> make_contour() {
    const std::size_t count = contour_.vertices.size();
    constexpr Index kUnused = std::numeric_limits<Index>::max();
    Buffer<Index> number(count);
    std::fill(number.begin(), number.end(), kUnused);
    for (const Part& part : parts_)
      for (const Index v : part.simplex) number[v] = 0;
    std::vector<Index> vertices, simplices;
    for (std::size_t v = 0; v < count; ++v)
      if (number[v] != kUnused) {
        number[v] = static_cast<Index>(vertices.size());
        vertices.push_back(static_cast<Index>(v));
      }
    simplices.reserve(parts_.size());
    for (const Part& part : parts_) simplices.push_back(part.origin);
    detail::CountedProgress copied(copying_ = progress(0.55, 0.65),
                                   vertices.size() * (2 + contour_.vertex_attributes.size()) +
                                       simplices.size() * (1 + contour_.simplex_attributes.size()));
    result_.contour = detail::part_of_contour(contour_, std::span<const Index>(vertices),
                                              std::span<const Index>(simplices), kept_, copied);
    // merged vertices, and vertices of simplices with one
    Buffer<std::uint8_t> is_merged(count), is_changed(vertices.size());
    std::fill(is_merged.begin(), is_merged.end(), std::uint8_t{0});
    std::fill(is_changed.begin(), is_changed.end(), std::uint8_t{0});
    for (std::size_t v = 0; v < count; ++v)
      if (kept_[v] != v) is_merged[kept_[v]] = 1;
    for (std::size_t s = 0; s < parts_.size(); ++s) {
      bool changes = parts_[s].is_divided;
      for (int j = 0; j < N; ++j) {
        const Index v = parts_[s].simplex[j];
        result_.contour.simplices[s][j] = number[v];
        changes = changes || is_merged[v] != 0;
      }
      if (changes)
        for (const Index v : result_.contour.simplices[s]) is_changed[v] = 1;
    }
    result_.report.counts.after = {vertices.size(), simplices.size()};
    parts_ = {};
    return is_changed;
  }

  void find_pinches(const Buffer<std::uint8_t>& is_changed) {
    MergeReport<N>& report = result_.report;
    const std::span<const Index> rows = simplex_rows(result_.contour);
    const std::size_t count = result_.contour.vertices.size();
    const detail::Stars stars = detail::make_stars<N>(rows, count, options_.work.threads, progress(0.65, 0.7));
    report.counts.euler_after = euler_of<N>(rows, stars, work(0.7, 0.77));
    report.counts.components_after = label_components(result_.contour, work(0.77, 0.8)).count;
    const detail::SimplexComplex<N - 1> complex{rows, count};
    std::vector<Index> bad;
    std::mutex mutex;
    detail::for_each_block(
        count, kLinksAtOnce, options_.work.threads, progress(0.8, 1.0),
        [&] { return detail::LinkChecker<N - 1>(complex); },
        [&](std::size_t, std::size_t from, std::size_t to, detail::LinkChecker<N - 1>& links) {
          for (std::size_t v = from; v < to; ++v) {
            if (is_changed[v] == 0) continue;
            MeshReport found;
            links.visit(static_cast<Index>(v), stars.of(v), found);
            if (found.bad_links == 0) continue;
            const std::lock_guard lock(mutex);
            bad.push_back(static_cast<Index>(v));
          }
        });
    std::sort(bad.begin(), bad.end());
    report.counts.pinched_vertices = bad.size();
    for (const Index v : bad) count_faces_at(v, stars.of(v));
    bad.resize(std::min(bad.size(), options_.most_listed));
    report.vertices = std::move(bad);
  }

  /// Counts the (N-2)-faces in more than two simplices whose smallest vertex is v.
  void count_faces_at(Index v, std::span<const Index> star) {
    std::vector<std::array<Index, N - 1>> faces;
    for (const Index s : star) {
      const Simplex& simplex = result_.contour.simplices[s];
      for (int omitted = 0; omitted < N; ++omitted) {
        std::array<Index, N - 1> face;
        for (int j = 0, k = 0; j < N; ++j)
          if (j != omitted) face[k++] = simplex[j];
        std::sort(face.begin(), face.end());
        if (face[0] == v) faces.push_back(face);
      }
    }
    std::sort(faces.begin(), faces.end());
    for (std::size_t i = 0, j = 0; i < faces.size(); i = j) {
      while (j < faces.size() && faces[j] == faces[i]) ++j;
      if (j - i <= 2) continue;
      ++result_.report.counts.pinched_faces;
      if (result_.report.faces.size() < options_.most_listed) result_.report.faces.push_back(faces[i]);
    }
  }

  const Contour<N, Real>& contour_;
  const MergeOptions& options_;
  Buffer<Index> kept_;         ///< by vertex: the vertex that replaces it
  std::vector<Index> shrunk_;  ///< vertices at places that shrank, by replacement
  std::vector<Part> parts_;
  Progress copying_;
  Merging<N, Real> result_;
};

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> Merging<N, Real> merge_vertices(const Contour<N, Real>& contour,
                                                                   const MergeOptions& options) {
  if (!(options.tolerance >= 0.0) || std::isinf(options.tolerance))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("the tolerance is {}; expected a finite number, 0 or more", options.tolerance));
  detail::require_unwrapped(contour, "merge_vertices");
  detail::require_sound(contour);
  return Merger<N, Real>(contour, options).run();
}

#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real) \
  template Merging<N, Real> merge_vertices(const Contour<N, Real>&, const MergeOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
