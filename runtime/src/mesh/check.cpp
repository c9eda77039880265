// SPDX-License-Identifier: BSD-3-Clause
//
// Invariants of a simplicial complex, vertex by vertex. Everything that `check` counts is visible in the star of a
// vertex (the simplices around it) and is counted at the smallest vertex of the face. So `check` needs one table, from
// vertices to simplices, and small sorts in each star, but no sort of all faces. For D = 3 the faces come from the
// incidence of the simplices, and nearly all links are tested by a search through their triangles.
//
// Based on: H. Seifert and W. Threlfall, Lehrbuch der Topologie, 1934, chapters 3, 6 and 7 (a complex is a manifold iff
// all links are spheres or balls; surfaces are classified by boundary, orientability and Euler characteristic).
#include "tegl/check.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/atomic_minimum.hpp"
#include "base/disjoint_sets.hpp"
#include "base/progress.hpp"
#include "base/workers.hpp"
#include "mesh/flat_simplex.hpp"
#include "mesh/incidence_data.hpp"
#include "mesh/link_checker.hpp"
#include "mesh/star_search.hpp"
#include "mesh/validate.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl {
namespace {

using detail::LinkChecker;
using detail::SimplexComplex;

/// Links between two progress calls; if each link is a surface of thousands of triangles, this takes some hundredths of
/// a second.
constexpr std::size_t kVerticesAtOnce = 1024;

/// Coordinates of vertices, of either type.
class Coordinates {
 public:
  explicit Coordinates(std::span<const float> values) : singles_(values.data()), size_(values.size()) {}
  explicit Coordinates(std::span<const double> values) : doubles_(values.data()), size_(values.size()) {}
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// Calls f with a pointer to the first coordinate.
  template <class F>
  decltype(auto) with_values(const F& f) const {
    return singles_ != nullptr ? f(singles_) : f(doubles_);
  }

 private:
  const float* singles_ = nullptr;
  const double* doubles_ = nullptr;
  std::size_t size_;
};

void require_vertex_numbers(std::span<const Index> rows, std::size_t vertices, std::size_t corners, unsigned threads,
                            const Progress& progress) {
  std::atomic<std::size_t> first = rows.size();  // with a wrong number
  detail::for_each_part(rows.size(), threads, progress, [&](std::size_t from, std::size_t to) {
    const auto at =
        std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(from), rows.begin() + static_cast<std::ptrdiff_t>(to),
                     [&](Index v) { return v >= vertices; });
    const auto found = static_cast<std::size_t>(at - rows.begin());
    if (found == to) return;
    detail::lower_to(first, found);
  });
  if (first < rows.size())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("simplex {} has vertex number {}; expected less than {}, the number of vertices",
                            first / corners, rows[first], vertices));
}

std::uint64_t count_nonfinite(const Coordinates& coordinates, std::size_t vertices, unsigned threads,
                              const Progress& progress) {
  const std::size_t space_dim = vertices == 0 ? 0 : coordinates.size() / vertices;
  std::atomic<std::uint64_t> count = 0;
  detail::for_each_part(vertices, threads, progress, [&](std::size_t from, std::size_t to) {
    count += coordinates.with_values([&](const auto* values) {
      const auto is_finite = [](auto x) { return std::isfinite(x); };
      std::uint64_t found = 0;
      for (const auto* at = values + from * space_dim; at != values + to * space_dim; at += space_dim)
        if (!std::all_of(at, at + space_dim, is_finite)) ++found;
      return found;
    });
  });
  return count;
}

/// Counts over simplices.
struct SimplexCounts {
  std::atomic<std::uint64_t> degenerate = 0;
  std::atomic<std::uint64_t> sound = 0;  ///< with different corners
};

template <int D>
void count_simplices(const SimplexComplex<D>& complex, int space_dim, const Coordinates& coordinates,
                     detail::SharedDisjointSets& connected, unsigned threads, const Progress& progress,
                     SimplexCounts& counts) {
  detail::for_each_part(complex.size(), threads, progress, [&](std::size_t from, std::size_t to) {
    coordinates.with_values([&](const auto* values) {
      const SimplexComplex<D> local = complex;  // stays in registers
      std::uint64_t degenerate = 0, sound = 0;
      for (std::size_t s = from; s < to; ++s) {
        const bool is_collapsed = local.is_collapsed(s);
        if (is_collapsed || detail::is_flat<D>(local[s], space_dim, values)) ++degenerate;
        if (is_collapsed) continue;
        ++sound;
        for (int i = 1; i <= D; ++i) connected.join(local[s][0], local[s][i]);
      }
      counts.degenerate += degenerate;
      counts.sound += sound;
    });
  });
}

/// Sums over links, of one thread or all.
struct LinkCounts {
  MeshReport report;
  std::uint64_t edges = 0, triangles = 0, tetrahedra = 0;
};

/// Visits the links of all vertices.
template <int D>
LinkCounts count_links(const SimplexComplex<D>& complex, const detail::Stars& stars,
                       detail::SharedDisjointSets& connected, unsigned threads, const Progress& progress) {
  LinkCounts all;
  std::mutex mutex;
  detail::for_each_block(
      complex.vertex_count, kVerticesAtOnce, threads, progress, [&] { return LinkChecker<D>(complex); },
      [&](std::size_t, std::size_t from, std::size_t to, LinkChecker<D>& links) {
        MeshReport report;
        for (std::size_t v = from; v < to; ++v) {
          const std::span<const Index> star = stars.of(v);
          if (star.empty()) continue;
          ++report.vertices;
          if (connected.find(static_cast<Index>(v)) == v) ++report.components;
          links.visit(static_cast<Index>(v), star, report);
        }
        const std::lock_guard lock(mutex);
        for (const auto count :
             {&MeshReport::vertices, &MeshReport::components, &MeshReport::boundary_simplices,
              &MeshReport::nonmanifold_simplices, &MeshReport::bad_links, &MeshReport::orientation_conflicts})
          all.report.*count += report.*count;
        all.edges += links.take_edges();
        all.triangles += links.take_triangles();
        all.tetrahedra += links.take_tetrahedra();
      });
  return all;
}

/// The same for tetrahedra, whose faces are known.
LinkCounts count_links(const SimplexComplex<3>& complex, const detail::IncidenceData<4>& incidence,
                       detail::SharedDisjointSets& connected, unsigned threads, const Progress& progress) {
  struct Scratch {
    std::vector<std::uint8_t> is_good;
    std::optional<detail::StarSearch> search;  ///< made when it is needed, as is `others`
    std::optional<LinkChecker<3>> others;
  };
  LinkCounts all;
  std::mutex mutex;
  detail::for_each_block(
      complex.vertex_count, kVerticesAtOnce, threads, progress, [] { return Scratch(); },
      [&](std::size_t, std::size_t from, std::size_t to, Scratch& scratch) {
        LinkCounts found;
        scratch.is_good.resize(to - from);
        detail::find_spheres_and_discs(complex.rows.data(), incidence, from, scratch.is_good);
        for (std::size_t i = from; i < to; ++i) {
          const auto v = static_cast<Index>(i);
          const std::span<const Index> star = incidence.stars.of(v);
          if (star.empty()) continue;
          ++found.report.vertices;
          if (connected.find(v) == v) ++found.report.components;
          found.report.euler += incidence.euler_above[v];
          if (scratch.is_good[i - from] != 0) continue;
          if (!scratch.search) scratch.search.emplace(complex.rows, incidence);
          if (scratch.search->is_sphere_or_disc(v)) continue;
          if (!scratch.others) scratch.others.emplace(complex);
          MeshReport report;
          scratch.others->visit(v, star, report);
          found.report.bad_links += report.bad_links;
        }
        const std::lock_guard lock(mutex);
        all.report.vertices += found.report.vertices;
        all.report.components += found.report.components;
        all.report.bad_links += found.report.bad_links;
        all.report.euler += found.report.euler;
      });
  for (const detail::IrregularFaces& faces : incidence.irregular) {
    all.report.boundary_simplices += faces.boundary;
    all.report.nonmanifold_simplices += faces.several;
    all.report.orientation_conflicts += faces.conflicts;
  }
  return all;
}

/// `incidence`: null if it is not known.
template <int D>
MeshReport check_complex(std::span<const Index> rows, int space_dim, const Coordinates& coordinates,
                         const detail::IncidenceData<D + 1>* incidence, const WorkOptions& work) {
  using detail::part_of;
  const unsigned threads = work.threads;
  const Progress& progress = work.progress;
  const SimplexComplex<D> complex{rows, coordinates.size() / static_cast<std::size_t>(space_dim)};
  require_vertex_numbers(rows, complex.vertex_count, D + 1, threads, part_of(progress, 0.0, 0.02));
  const std::uint64_t nonfinite =
      count_nonfinite(coordinates, complex.vertex_count, threads, part_of(progress, 0.02, 0.03));
  detail::SharedDisjointSets connected(complex.vertex_count);
  SimplexCounts simplices;
  count_simplices<D>(complex, space_dim, coordinates, connected, threads, part_of(progress, 0.03, 0.2), simplices);
  LinkCounts links;
  if constexpr (D == 3) {
    std::optional<detail::IncidenceData<4>> made;
    if (incidence == nullptr)
      incidence = &made.emplace(
          detail::make_incidence<4>(rows, complex.vertex_count, true, threads, part_of(progress, 0.2, 0.7)));
    links = count_links(complex, *incidence, connected, threads, part_of(progress, 0.7, 1.0));
  } else if (incidence != nullptr) {
    links = count_links<D>(complex, incidence->stars, connected, threads, part_of(progress, 0.2, 1.0));
  } else {
    const detail::Stars stars =
        detail::make_stars<D + 1>(rows, complex.vertex_count, threads, part_of(progress, 0.2, 0.4));
    links = count_links<D>(complex, stars, connected, threads, part_of(progress, 0.4, 1.0));
  }
  MeshReport report = links.report;
  report.dim = D;
  report.simplices = complex.size();
  report.nonfinite_vertices = nonfinite;
  report.degenerate_simplices = simplices.degenerate;
  report.unused_vertices = complex.vertex_count - report.vertices;
  if (D == 3) return report;  // with the Euler characteristic
  // V - E + F - …, with the simplices last. For D < 2 there are no edges, for D < 4 no triangles and tetrahedra
  // in the counts.
  report.euler = static_cast<std::int64_t>(report.vertices) - static_cast<std::int64_t>(links.edges) +
                 static_cast<std::int64_t>(links.triangles) - static_cast<std::int64_t>(links.tetrahedra) +
                 (D % 2 == 0 ? 1 : -1) * static_cast<std::int64_t>(simplices.sound.load());
  return report;
}

MeshReport check_any(int d, std::span<const Index> simplices, int space_dim, const Coordinates& coordinates,
                     const WorkOptions& work) {
  if (d < 1 || d > 4)
    throw Error(ErrorCode::InvalidArgument, fmt::format("simplices of dimension {}; expected 1, 2, 3 or 4", d));
  if (space_dim < d || space_dim > 8)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("coordinates of {} numbers each for simplices of dimension {}; expected {} to 8", space_dim, d, d));
  const std::size_t width = static_cast<std::size_t>(d) + 1;
  if (simplices.size() % width != 0)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("{} vertex numbers; expected a multiple of {}, the number per simplex", simplices.size(), width));
  if (coordinates.size() % static_cast<std::size_t>(space_dim) != 0)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("{} coordinates; expected a multiple of {}, the number per vertex", coordinates.size(), space_dim));
  constexpr std::size_t kLimit = std::numeric_limits<Index>::max();
  if (simplices.size() / width > kLimit || coordinates.size() / static_cast<std::size_t>(space_dim) > kLimit)
    throw Error(ErrorCode::TooLarge, fmt::format("{} simplices and {} vertices; expected at most {} of each",
                                                 simplices.size() / width, coordinates.size() / space_dim, kLimit));
  if (d == 1) return check_complex<1>(simplices, space_dim, coordinates, nullptr, work);
  if (d == 2) return check_complex<2>(simplices, space_dim, coordinates, nullptr, work);
  if (d == 3) return check_complex<3>(simplices, space_dim, coordinates, nullptr, work);
  return check_complex<4>(simplices, space_dim, coordinates, nullptr, work);
}

template <int N, class Real>
Coordinates coordinates_of(const Contour<N, Real>& contour) {
  return Coordinates(detail::flat_rows(std::span<const std::array<Real, N>>(contour.vertices)));
}

}  // namespace

MeshReport check(int d, std::span<const Index> simplices, int space_dim, std::span<const double> coordinates,
                 const WorkOptions& work) {
  return check_any(d, simplices, space_dim, Coordinates(coordinates), work);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> MeshReport check(const Contour<N, Real>& contour, const WorkOptions& work) {
  return check_any(N - 1, detail::flat_rows(std::span<const std::array<Index, N>>(contour.simplices)), N,
                   coordinates_of(contour), work);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> MeshReport check(const Contour<N, Real>& contour, const Incidence<N>& incidence,
                                                    const WorkOptions& work) {
  const auto rows = detail::flat_rows(std::span<const std::array<Index, N>>(contour.simplices));
  detail::require_incidence<N>(incidence.data(), rows, contour.vertices.size());
  return check_complex<N - 1>(rows, N, coordinates_of(contour), &incidence.data(), work);
}

#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real)                           \
  template MeshReport check(const Contour<N, Real>&, const WorkOptions&); \
  template MeshReport check(const Contour<N, Real>&, const Incidence<N>&, const WorkOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
