// SPDX-License-Identifier: BSD-3-Clause
//
// Delaunay triangulations by Qhull.
#include "tegl/delaunay.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/LU>

#include "complex/cell_groups.hpp"
#include "tegl/error.hpp"

#ifdef TEGL_HAS_QHULL
extern "C" {
#include <libqhull_r/qhull_ra.h>
}
#endif

namespace tegl {
namespace {

[[noreturn]] [[maybe_unused]] void refuse(const std::string& message) {
  throw Error(ErrorCode::InvalidArgument, message);
}

/// Throws for points that Qhull cannot or should not take.
template <int N>
[[maybe_unused]] void check_points(std::span<const std::array<double, N>> points) {
  if (points.size() < N + 1) refuse(fmt::format("{} points in {}D; expected at least {}", points.size(), N, N + 1));
  if (points.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw Error(ErrorCode::TooLarge, fmt::format("{} points; expected fewer than 2^31", points.size()));
  for (std::size_t p = 0; p < points.size(); ++p)
    for (const double x : points[p])
      if (!std::isfinite(x)) refuse(fmt::format("point {} has the coordinate {}; expected finite ones", p, x));
  std::vector<Index> order(points.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return points[a] < points[b]; });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (points[order[i]] == points[order[i - 1]])
      refuse(fmt::format("points {} and {} are equal; expected different points", order[i - 1], order[i]));
}

[[noreturn]] [[maybe_unused]] void refuse_flat(std::size_t points, int dim) {
  const char* const space = dim == 2 ? "line" : dim == 3 ? "plane" : "hyperplane";
  refuse(fmt::format("{} points that lie in a {}; expected points in {} dimensions", points, space, dim));
}

#ifdef TEGL_HAS_QHULL
/// A run of Qhull, with its messages in memory.
class Qhull {
 public:
  Qhull() : messages_(open_memstream(&text_, &length_)) {
    if (messages_ == nullptr) throw std::bad_alloc();
    qh_zero(&qh_, messages_);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  ~Qhull() {
    qh_.NOerrexit = True;
    qh_freeqhull(&qh_, qh_ALL);
    int current = 0, total = 0;
    qh_memfreeshort(&qh_, &current, &total);
    std::fclose(messages_);
    std::free(text_);
  }

  /// Returns Qhull's exit code.
  int run(int dim, std::vector<double>& coordinates, const char* command) {
    std::string copy = command;
    return qh_new_qhull(&qh_, dim, static_cast<int>(coordinates.size()) / dim, coordinates.data(), False, copy.data(),
                        nullptr, messages_);
  }
  /// Qhull's first message.
  [[nodiscard]] std::string message() {
    std::fflush(messages_);
    const std::string all(text_, length_);
    return all.substr(0, all.find('\n'));
  }
  [[nodiscard]] qhT& state() noexcept { return qh_; }

 private:
  char* text_ = nullptr;
  std::size_t length_ = 0;
  std::FILE* messages_;
  qhT qh_{};
};

/// The points on the paraboloid over their box, one dimension higher. Heights are raised a little by the points'
/// numbers, so that no more than N + 2 of them are in a hyperplane. Points themselves do not move, and a hull of
/// simplices is conforming whatever the heights. (Qhull's own way, triangulated merged facets, is not conforming in
/// 4D.)
///
/// Based on: H. Edelsbrunner and E. P. Muecke, Simulation of simplicity, 1990 (degenerate input as a limit of generic
/// input); here with heights large enough for floating point.
template <int N>
std::vector<double> lifted(std::span<const std::array<double, N>> points) {
  constexpr double kRaise = 1e-9;
  std::array<double, N> middle{};
  double radius = 0.0;
  for (int a = 0; a < N; ++a) {
    const auto [least, most] =
        std::minmax_element(points.begin(), points.end(), [a](const auto& p, const auto& q) { return p[a] < q[a]; });
    const double half = 0.5 * ((*most)[a] - (*least)[a]);
    middle[a] = (*least)[a] + half;
    radius = std::max(radius, half);
  }
  std::vector<double> coordinates;
  coordinates.reserve(points.size() * (N + 1));
  std::mt19937_64 random(1);  // the same for the same number of points
  for (const std::array<double, N>& point : points) {
    double height = kRaise * static_cast<double>(random() >> 11) * 0x1p-53;
    for (int a = 0; a < N; ++a) {
      const double x = radius > 0.0 ? (point[a] - middle[a]) / radius : 0.0;
      coordinates.push_back(x);
      height += x * x;
    }
    coordinates.push_back(height);
  }
  return coordinates;
}

/// The one cell of N + 1 points, which are too few for a hull one dimension higher.
template <int N>
std::vector<Index> only_simplex(std::span<const std::array<double, N>> points) {
  constexpr double kFlat = 1e-14;
  const std::vector<double> coordinates = lifted<N>(points);
  Eigen::Matrix<double, N, N> edges;
  for (int i = 0; i < N; ++i)
    for (int a = 0; a < N; ++a) edges(i, a) = coordinates[(i + 1) * (N + 1) + a] - coordinates[a];
  const Eigen::FullPivLU<Eigen::Matrix<double, N, N>> parts(edges);
  const auto pivots = parts.matrixLU().diagonal().cwiseAbs();
  if (!(pivots.minCoeff() > kFlat * pivots.maxCoeff())) refuse_flat(points.size(), N);
  std::vector<Index> corners(N + 1);
  std::iota(corners.begin(), corners.end(), Index{0});
  return corners;
}

/// The corners of the simplices of the lower hull, all with the orientation of the hull.
template <int N>
std::vector<Index> lower_simplices(qhT& state) {
  constexpr double kVertical = -1e-10;  // facets over the border of the points
  qhT* const qh = &state;
  std::vector<Index> corners;
  facetT* facet = nullptr;
  vertexT *vertex = nullptr, **vertexp = nullptr;
  FORALLfacets {
    if (!(facet->normal[N] < kVertical)) continue;
    std::array<Index, N + 1> simplex{};
    std::size_t count = 0;
    FOREACHvertex_(facet->vertices) {
      if (count <= N) simplex[count] = static_cast<Index>(qh_pointid(qh, vertex->point));
      ++count;
    }
    if (count != N + 1) throw Error(ErrorCode::UnsupportedData, "Qhull left a facet that is no simplex");
    if (facet->toporient != 0U) std::swap(simplex[0], simplex[1]);
    corners.insert(corners.end(), simplex.begin(), simplex.end());
  }
  return corners;
}

/// Throws unless each face is in at most two simplices: otherwise rounding made the hull inconsistent.
template <int N>
void require_conforming(const std::vector<Index>& corners) {
  std::vector<std::array<Index, N>> faces;
  for (std::size_t c = 0; c < corners.size(); c += N + 1)
    for (std::size_t omitted = 0; omitted <= N; ++omitted) {
      std::array<Index, N>& face = faces.emplace_back();
      for (std::size_t i = 0, n = 0; i <= N; ++i)
        if (i != omitted) face[n++] = corners[c + i];
      std::sort(face.begin(), face.end());
    }
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 2; i < faces.size(); ++i)
    if (faces[i] == faces[i - 2])
      refuse(
          fmt::format("points near point {} are so degenerate that rounding makes cells overlap; expected other points",
                      faces[i][0]));
}
#endif

constexpr CellType simplex_type(int dim) {
  return dim == 2 ? CellType::triangle : dim == 3 ? CellType::tetrahedron : CellType::simplex4;
}

/// Throws if a point is in no cell.
[[maybe_unused]] void require_all_points(std::size_t points, const std::vector<Index>& corners) {
  std::vector<bool> is_used(points, false);
  for (const Index p : corners) is_used[p] = true;
  const auto lost = std::find(is_used.begin(), is_used.end(), false);
  if (lost == is_used.end()) return;
  const auto others = std::count(lost + 1, is_used.end(), false);
  refuse(
      fmt::format("point {}{} so close to other points that rounding hides {}; expected points that are further apart",
                  lost - is_used.begin(),
                  others == 0   ? " is"
                  : others == 1 ? " and 1 other are"
                                : fmt::format(" and {} others are", others),
                  others == 0 ? "it" : "them"));
}

}  // namespace

bool has_delaunay() noexcept {
#ifdef TEGL_HAS_QHULL
  return true;
#else
  return false;
#endif
}

template <int N>
requires DimensionBetween<N, 2, 4> std::vector<Index> delaunay_corners(std::span<const std::array<double, N>> points) {
#ifdef TEGL_HAS_QHULL
  check_points<N>(points);
  if (points.size() == N + 1) return only_simplex<N>(points);
  std::vector<double> coordinates = lifted<N>(points);
  Qhull qhull;
  const int exit = qhull.run(N + 1, coordinates, "qhull Qt Q12");
  if (exit == qh_ERRmem) throw std::bad_alloc();
  if (exit == qh_ERRsingular) refuse_flat(points.size(), N);
  if (exit != 0)
    throw Error(ErrorCode::UnsupportedData, fmt::format("Qhull: {}; expected other points", qhull.message()));
  std::vector<Index> corners = lower_simplices<N>(qhull.state());
  require_all_points(points.size(), corners);
  require_conforming<N>(corners);
  return corners;
#else
  (void)points;
  throw Error(ErrorCode::UnsupportedData, "this build of tegl has no Qhull; expected one with libqhull-dev");
#endif
}

template <int N>
requires DimensionBetween<N, 2, 4> Complex<N> delaunay(std::span<const std::array<double, N>> points) {
  const std::vector<Index> corners = delaunay_corners<N>(points);
  return detail::ComplexAccess::oriented<N>({points.begin(), points.end()}, simplex_type(N), corners);
}

template std::vector<Index> delaunay_corners<2>(std::span<const std::array<double, 2>>);
template std::vector<Index> delaunay_corners<3>(std::span<const std::array<double, 3>>);
template std::vector<Index> delaunay_corners<4>(std::span<const std::array<double, 4>>);
template Complex<2> delaunay<2>(std::span<const std::array<double, 2>>);
template Complex<3> delaunay<3>(std::span<const std::array<double, 3>>);
template Complex<4> delaunay<4>(std::span<const std::array<double, 4>>);

}  // namespace tegl
