// SPDX-License-Identifier: BSD-3-Clause
//
// Triangulation of polygons, and of the polygons of 3D facet hierarchies, with forbidden chords; see tegl/polygons.hpp.
#include "tegl/polygons.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <fmt/format.h>

#include "base/workers.hpp"
#include "kernel/extract_kernel.hpp"
#include "kernel/extract_progress.hpp"
#include "tile/extract_tables.hpp"

namespace tegl {
namespace {

using Triangle = std::array<Index, 3>;
using Part = std::vector<Index>;  ///< points of a polygon in cyclic order

template <int N>
std::array<double, N> difference(const std::array<double, N>& a, const std::array<double, N>& b) noexcept {
  std::array<double, N> result;
  for (int i = 0; i < N; ++i) result[i] = a[i] - b[i];
  return result;
}
template <int N>
double dot(const std::array<double, N>& a, const std::array<double, N>& b) noexcept {
  double sum = 0;
  for (int i = 0; i < N; ++i) sum += a[i] * b[i];
  return sum;
}
/// Component of v orthogonal to `direction`.
template <int N>
std::array<double, N> projected(std::array<double, N> v, const std::array<double, N>& direction) noexcept {
  const double square = dot<N>(direction, direction);
  const double share = square > 0 ? dot<N>(v, direction) / square : 0.0;
  for (int i = 0; i < N; ++i) v[i] -= share * direction[i];
  return v;
}

/// Triangulation of one polygon.
template <int N>
class Polygon {
 public:
  Polygon(std::span<const std::array<double, N>> points, PolygonTriangulation method, std::span<const Chord> forbidden)
      : points_(points),
        size_(static_cast<Index>(points.size())),
        by_kink_(method == PolygonTriangulation::halving_kink) {
    if (forbidden.empty()) return;
    forbidden_.resize(points.size() * points.size());
    for (const auto& [a, b] : forbidden) forbidden_[a * points.size() + b] = forbidden_[b * points.size() + a] = true;
  }

  std::vector<Triangle> run(PolygonTriangulation method) {
    if (size_ == 3) return {{0, 1, 2}};
    triangles_.reserve(size_);
    if (method == PolygonTriangulation::barycentric) return cone();
    for (Index start = 0; start < size_ && method == PolygonTriangulation::fan; ++start)
      if (accept(fan(start))) return std::move(triangles_);
    for (Index start = 0; start < size_ && method == PolygonTriangulation::zigzag; ++start)
      if (accept(zigzag(start))) return std::move(triangles_);
    Part all(size_);
    std::iota(all.begin(), all.end(), Index{0});
    if (!has_triangles(all)) return cone();
    triangles_.clear();
    halve(all);
    return std::move(triangles_);
  }

 private:
  [[nodiscard]] bool allows(Index a, Index b) const noexcept {
    return forbidden_.empty() || !forbidden_[std::size_t{a} * size_ + b];
  }
  /// Whether no triangle has a forbidden chord; edges of the polygon are no chords.
  [[nodiscard]] bool accept(const std::vector<Triangle>& triangles) const noexcept {
    return forbidden_.empty() || std::all_of(triangles.begin(), triangles.end(), [&](const Triangle& t) {
             for (std::size_t j = 0; j < 3; ++j) {
               const Index a = t[j], b = t[(j + 1) % 3];
               if ((a + 1) % size_ != b && !allows(a, b)) return false;
             }
             return true;
           });
  }

  std::vector<Triangle>& cone() {
    triangles_.clear();
    for (Index i = 0; i < size_; ++i) triangles_.push_back({size_, i, (i + 1) % size_});
    return triangles_;
  }
  std::vector<Triangle>& fan(Index start) {
    triangles_.clear();
    for (Index i = 1; i + 1 < size_; ++i) triangles_.push_back({start, (start + i) % size_, (start + i + 1) % size_});
    return triangles_;
  }
  std::vector<Triangle>& zigzag(Index start) {
    triangles_.clear();
    const auto point = [&](Index i) { return (start + i) % size_; };
    Index i = 0, j = size_ - 2;
    for (; i + 1 < j; ++i, --j) {
      triangles_.push_back({point(i), point(i + 1), point(j + 1)});
      triangles_.push_back({point(j), point(j + 1), point(i + 1)});
    }
    if (i < j) triangles_.push_back({point(i), point(i + 1), point(j + 1)});
    return triangles_;
  }

  /// The points from position i to position j in cyclic order.
  static Part between(const Part& part, std::size_t i, std::size_t j) {
    Part result;
    for (;; i = (i + 1) % part.size()) {
      result.push_back(part[i]);
      if (i == j) return result;
    }
  }

  void halve(const Part& part) {
    const std::size_t m = part.size();
    if (m == 3) {
      triangles_.push_back({part[0], part[1], part[2]});
      return;
    }
    std::size_t best_from = 0, best_to = 0;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t step = m / 2; step >= 2 && best_to == best_from; --step)
      for (std::size_t i = 0; i < (2 * step == m ? step : m); ++i) {
        const std::size_t j = (i + step) % m;
        if (!allows(part[i], part[j])) continue;
        const double chord_weight = weight(part, i, j);
        if (best_to != best_from && !(chord_weight < best)) continue;
        if (!has_triangles(between(part, i, j)) || !has_triangles(between(part, j, i))) continue;
        best = chord_weight;
        best_from = i;
        best_to = j;
      }
    halve(between(part, best_from, best_to));
    halve(between(part, best_to, best_from));
  }

  [[nodiscard]] double weight(const Part& part, std::size_t i, std::size_t j) const noexcept {
    const auto chord = difference<N>(points_[part[j]], points_[part[i]]);
    return by_kink_ ? 0.5 * (kink(part, i, chord) + kink(part, j, chord)) : std::sqrt(dot<N>(chord, chord));
  }
  /// Bend of the part at one end of a chord: 0 if flat, 1 if folded.
  [[nodiscard]] double kink(const Part& part, std::size_t i, const std::array<double, N>& chord) const noexcept {
    const auto& here = points_[part[i]];
    const auto a = projected<N>(difference<N>(points_[part[(i + 1) % part.size()]], here), chord);
    const auto b = projected<N>(difference<N>(points_[part[(i + part.size() - 1) % part.size()]], here), chord);
    const double lengths = std::sqrt(dot<N>(a, a) * dot<N>(b, b));
    if (!(lengths > 0)) return 1.0;
    return 1.0 - std::acos(std::clamp(dot<N>(a, b) / lengths, -1.0, 1.0)) / std::numbers::pi;
  }

  /// Whether the part has a triangulation without forbidden chords. Dynamic programming over the stretches from a to b,
  /// by length: O(m^3) for m points.
  [[nodiscard]] bool has_triangles(const Part& part) const {
    const std::size_t m = part.size();
    if (forbidden_.empty() || m == 3) return true;
    std::vector<char> can(m * m, 1);
    for (std::size_t length = 2; length < m; ++length)
      for (std::size_t a = 0; a + length < m; ++a) {
        const std::size_t b = a + length;
        bool found = false;
        for (std::size_t c = a + 1; c < b && !found; ++c) found = can[a * m + c] != 0 && can[c * m + b] != 0;
        const bool is_edge = length == m - 1;
        can[a * m + b] = found && (is_edge || allows(part[a], part[b])) ? 1 : 0;
      }
    return can[m - 1] != 0;
  }

  std::span<const std::array<double, N>> points_;
  Index size_;
  bool by_kink_;
  std::vector<bool> forbidden_;  ///< #points x #points; empty: none
  std::vector<Triangle> triangles_;
};

}  // namespace

template <int N>
requires DimensionBetween<N, 2, 4> std::vector<Triangle> triangulate_polygon(
    std::span<const std::array<double, N>> points, PolygonTriangulation method, std::span<const Chord> forbidden) {
  if (points.size() < 3 || points.size() >= std::numeric_limits<Index>::max())
    throw Error(ErrorCode::InvalidArgument, fmt::format("a polygon of {} points; expected 3 or more", points.size()));
  for (const Chord& chord : forbidden)
    if (std::max(chord[0], chord[1]) >= points.size())
      throw Error(ErrorCode::InvalidArgument, fmt::format("forbidden chord {}-{} of a polygon of {} points; expected "
                                                          "numbers below that",
                                                          chord[0], chord[1], points.size()));
  return Polygon<N>(points, method, forbidden).run(method);
}

template <int N>
requires DimensionBetween<N, 2, 4> std::array<double, N> polygon_barycentre(
    std::span<const std::array<double, N>> points) {
  detail::Weighted<N> sum;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto &a = points[i], &b = points[(i + 1) % points.size()];
    sum.add(detail::midpoint<N>(a, b), detail::distance(a, b));
  }
  if (!(sum.weight > 0)) return points[0];
  for (double& x : sum.point) x /= sum.weight;
  return sum.point;
}

namespace {

/// The triangles of a run of consecutive polygons.
struct PolygonRun {
  std::vector<std::array<Index, 3>>
      triangles;  ///< vertex numbers; barycentres of the run are numbered from points_end() on
  std::vector<std::array<double, 3>> barycentres;
  std::vector<std::array<double, 3>> normals;  ///< of the barycentres, if wanted
  std::size_t first_triangle = 0, first_barycentre = 0;
};
struct PolygonScratch {
  std::vector<std::array<double, 3>> points;
  std::vector<Chord> forbidden;
};

template <class Real>
class PolygonTriangulator {
 public:
  PolygonTriangulator(const FacetHierarchy<3, Real>& facets, PolygonTriangulation method)
      : facets_(facets), method_(method) {}

  void add(std::size_t f, PolygonScratch& scratch, PolygonRun& run) const {
    const std::vector<Index> polygon = facets_.points_of(2, f);
    scratch.points.clear();
    for (const Index p : polygon) {
      std::array<double, 3> point;
      for (int a = 0; a < 3; ++a) point[a] = facets_.vertices[p][a];
      scratch.points.push_back(point);
    }
    find_forbidden(f, scratch.forbidden);
    const auto size = static_cast<Index>(polygon.size());
    const std::span<const std::array<double, 3>> points(scratch.points);
    bool has_barycentre = false;
    // `forbidden` is valid by construction, so it is not checked.
    for (const Triangle& t : Polygon<3>(points, method_, scratch.forbidden).run(method_)) {
      Triangle& out = run.triangles.emplace_back();
      for (std::size_t j = 0; j < 3; ++j) {
        has_barycentre = has_barycentre || t[j] == size;
        out[j] = t[j] == size ? static_cast<Index>(points_end() + run.barycentres.size()) : polygon[t[j]];
      }
    }
    if (!has_barycentre) return;
    run.barycentres.push_back(polygon_barycentre<3>(points));
    if (!facets_.normals.empty()) run.normals.push_back(mean_normal(polygon));
  }

  [[nodiscard]] std::size_t points_end() const noexcept { return facets_.vertices.size(); }

 private:
  /// Lists the chords between points of one square of the grid that has two segments of the polygon (an ambiguous
  /// square).
  void find_forbidden(std::size_t f, std::vector<Chord>& forbidden) const {
    forbidden.clear();
    const auto segments = facets_.down(2, f);
    const auto size = static_cast<Index>(segments.size());
    const auto& places = facets_.levels[1].places;
    for (Index i = 0; i < size; ++i)
      for (Index j = i + 1; j < size; ++j) {
        const FacetPlace &a = places[segments[i]], &b = places[segments[j]];
        if (a.base != b.base || a.axes != b.axes || a.is_cap != b.is_cap) continue;
        for (const Index from : {i, (i + 1) % size})
          for (const Index to : {j, (j + 1) % size}) forbidden.push_back({from, to});
      }
  }

  [[nodiscard]] std::array<double, 3> mean_normal(const std::vector<Index>& polygon) const {
    std::array<double, 3> sum{};
    for (const Index p : polygon)
      for (int a = 0; a < 3; ++a) sum[a] += facets_.normals[p][a];
    const double length = std::sqrt(dot<3>(sum, sum));
    for (double& x : sum) x = length > 0 ? x / length : 0.0;
    return sum;
  }

  const FacetHierarchy<3, Real>& facets_;
  PolygonTriangulation method_;
};

template <class Real>
std::array<Real, 3> rounded(const std::array<double, 3>& point) {
  return {static_cast<Real>(point[0]), static_cast<Real>(point[1]), static_cast<Real>(point[2])};
}

/// Prefix sums: places the runs in the contour, and allocates it.
template <class Real>
void make_room(std::vector<PolygonRun>& runs, const FacetHierarchy<3, Real>& facets, Contour<3, Real>& contour) {
  std::size_t triangles = 0, vertices = facets.vertices.size();
  for (PolygonRun& run : runs) {
    run.first_triangle = triangles;
    run.first_barycentre = vertices;
    triangles += run.triangles.size();
    vertices += run.barycentres.size();
  }
  detail::check_vertex_count(vertices, detail::kMaxVertices);
  contour.vertices.reserve(vertices);
  contour.vertices = facets.vertices;
  contour.vertices.resize(vertices);
  contour.normals = facets.normals;
  if (!facets.normals.empty()) contour.normals.resize(vertices);
  contour.simplices.resize(triangles);
  contour.axis_names = facets.axis_names;
  contour.axis_units = facets.axis_units;
  contour.direction = facets.direction;
}

}  // namespace

template <Coordinate Real>
Contour<3, Real> triangulate(const FacetHierarchy<3, Real>& facets, PolygonTriangulation method,
                             const WorkOptions& work) {
  constexpr std::size_t kRun = 1024;
  if (facets.cells != 0)
    throw Error(
        ErrorCode::UnsupportedData,
        "polygons in the cells of a mesh or lattice, whose common faces are not known; expected polygons of an image");
  if (!facets.periods.empty())
    throw Error(ErrorCode::UnsupportedData,
                "facets with periodic axes, whose polygons cross the seam; expected facets without periods");
  const std::size_t count = facets.count(2);
  std::vector<PolygonRun> runs((count + kRun - 1) / kRun);
  const PolygonTriangulator<Real> triangulator(facets, method);
  // triangulate runs in parallel
  detail::ProgressReporter reporter(work.progress, 1, "passes");
  reporter.begin_batch(0, 1, 1);
  reporter.begin_pass(std::max<std::size_t>(1, runs.size()));
  detail::Workers<PolygonScratch> workers(work.threads, [] { return PolygonScratch(); });
  workers.for_range(runs.size(), 1, [&](std::size_t from, std::size_t to, PolygonScratch& scratch) {
    for (std::size_t r = from; r < to && !reporter.stopped(); ++r) {
      for (std::size_t f = r * kRun; f < std::min(count, (r + 1) * kRun); ++f) triangulator.add(f, scratch, runs[r]);
      reporter.add(1);
    }
  });
  // copy the runs to their places
  Contour<3, Real> contour;
  make_room(runs, facets, contour);
  workers.for_range(runs.size(), 1, [&](std::size_t from, std::size_t to, PolygonScratch&) {
    for (std::size_t r = from; r < to; ++r) {
      const PolygonRun& run = runs[r];
      const auto shift = static_cast<Index>(run.first_barycentre - triangulator.points_end());
      for (std::size_t s = 0; s < run.triangles.size(); ++s)
        for (std::size_t j = 0; j < 3; ++j) {
          const Index id = run.triangles[s][j];
          contour.simplices[run.first_triangle + s][j] = id < triangulator.points_end() ? id : id + shift;
        }
      for (std::size_t v = 0; v < run.barycentres.size(); ++v)
        contour.vertices[run.first_barycentre + v] = rounded<Real>(run.barycentres[v]);
      for (std::size_t v = 0; v < run.normals.size(); ++v)
        contour.normals[run.first_barycentre + v] = rounded<Real>(run.normals[v]);
    }
  });
  reporter.tell(1);
  return contour;
}

#define TEGL_INSTANTIATE(N)                                                                                           \
  template std::vector<Triangle> triangulate_polygon<N>(std::span<const std::array<double, N>>, PolygonTriangulation, \
                                                        std::span<const Chord>);                                      \
  template std::array<double, N> polygon_barycentre<N>(std::span<const std::array<double, N>>);
TEGL_INSTANTIATE(2)
TEGL_INSTANTIATE(3)
TEGL_INSTANTIATE(4)
template Contour<3, float> triangulate(const FacetHierarchy<3, float>&, PolygonTriangulation, const WorkOptions&);
template Contour<3, double> triangulate(const FacetHierarchy<3, double>&, PolygonTriangulation, const WorkOptions&);
#undef TEGL_INSTANTIATE

}  // namespace tegl
