// SPDX-License-Identifier: BSD-3-Clause
//
// Normals of contours: of simplices, averaged at vertices, and from gradients of the image; see tegl/normals.hpp.
#include "tegl/normals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/periods.hpp"
#include "base/workers.hpp"
#include "image/locate.hpp"
#include "image/row_source.hpp"
#include "kernel/extract_cell.hpp"
#include "kernel/extract_normals.hpp"
#include "mesh/simplex_geometry.hpp"
#include "mesh/validate.hpp"

namespace tegl {

namespace {

using detail::PointOf;

/// Normalized to length 1; 0 stays 0.
template <int N>
PointOf<N> unit(PointOf<N> v) noexcept {
  const double length = detail::length_of<N>(v);
  for (double& x : v) x = length > 0.0 && std::isfinite(length) ? x / length : 0.0;
  return v;
}

template <int N, class Real>
std::array<Real, N> rounded(const PointOf<N>& v) noexcept {
  std::array<Real, N> result;
  for (int a = 0; a < N; ++a) result[a] = static_cast<Real>(v[a]);
  return result;
}

template <int N>
double dot(const PointOf<N>& a, const PointOf<N>& b) noexcept {
  double sum = 0.0;
  for (int i = 0; i < N; ++i) sum += a[i] * b[i];
  return sum;
}

/// The angle of a simplex at its corner j: 1 (2D), in radians (3D), in steradians (4D).
template <int N>
double angle_at(const std::array<PointOf<N>, N>& corners, int j) noexcept {
  std::array<PointOf<N>, N - 1> edges;
  for (int k = 1; k < N; ++k) {
    for (int a = 0; a < N; ++a) edges[k - 1][a] = corners[(j + k) % N][a] - corners[j][a];
    edges[k - 1] = unit<N>(edges[k - 1]);
  }
  if constexpr (N == 2) {
    return 1.0;
  } else if constexpr (N == 3) {
    // From half the sum and half the difference: accurate also for thin angles (W. Kahan).
    PointOf<N> sum, difference;
    for (int a = 0; a < N; ++a) {
      sum[a] = edges[0][a] + edges[1][a];
      difference[a] = edges[0][a] - edges[1][a];
    }
    return 2.0 * std::atan2(detail::length_of<N>(difference), detail::length_of<N>(sum));
  } else {
    const double ab = dot<N>(edges[0], edges[1]), bc = dot<N>(edges[1], edges[2]), ca = dot<N>(edges[2], edges[0]);
    const double gram = 1.0 + 2.0 * ab * bc * ca - ab * ab - bc * bc - ca * ca;
    return 2.0 * std::atan2(std::sqrt(std::max(0.0, gram)), 1.0 + ab + bc + ca);
  }
}

template <int N>
double weight_of(const std::array<PointOf<N>, N>& corners, int j, double measure, NormalWeights weights) noexcept {
  if (weights == NormalWeights::area) return measure;
  return weights == NormalWeights::equal ? 1.0 : angle_at<N>(corners, j);
}

/// By vertex, the weighted sum of the unit normals of its simplices.
template <int N>
std::vector<PointOf<N>> sum_normals(const detail::SimplexView<N>& contour, NormalWeights weights,
                                    const WorkOptions& work) {
  // By simplex: its unit normal and its weights at the corners.
  struct Share {
    PointOf<N> normal;
    std::array<double, N> weights;
  };
  constexpr std::size_t kBatch = std::size_t{1} << 20;  // bounds the memory of shares
  std::vector<PointOf<N>> sums(contour.vertex_count());
  Buffer<Share> shares(std::min(kBatch, contour.simplices().size()));
  const std::size_t count = contour.simplices().size();
  for (std::size_t first = 0; first < count; first += kBatch) {
    const std::size_t batch = std::min(kBatch, count - first);
    const auto progress = [&](double fraction) {
      const double done = static_cast<double>(first) + fraction * static_cast<double>(batch);
      return !work.progress || work.progress(done / static_cast<double>(count));
    };
    detail::for_each_item(batch, work.threads, progress, [&](std::size_t i) {
      const auto corners = contour.corners(first + i);
      const PointOf<N> normal = detail::normal_vector_of<N>(corners);
      shares[i].normal = unit<N>(normal);
      const double measure = detail::length_of<N>(normal);
      for (int j = 0; j < N; ++j) shares[i].weights[j] = weight_of<N>(corners, j, measure, weights);
    });
    // Sequential, in the order of simplices: sums do not depend on the threads.
    for (std::size_t i = 0; i < batch; ++i)
      for (int j = 0; j < N; ++j)
        for (int a = 0; a < N; ++a)
          sums[contour.simplices()[first + i][j]][a] += shares[i].weights[j] * shares[i].normal[a];
  }
  return sums;
}

/// The edge of the grid that a vertex lies on.
struct GridEdge {
  int axis = -1;  ///< -1: none
  double alpha = 0.0;
};

/// Moves a vertex that lies on an edge, up to the rounding of `Real`, to it: `place` gets the edge's first sample.
template <int N, class Real>
GridEdge edge_of(detail::CellPlace<N>& place) noexcept {
  constexpr double kRounding = std::is_same_v<Real, float> ? 1e-4 : 1e-9;
  GridEdge edge;
  for (int a = 0; a < N; ++a) {
    const double share = place.share[a];
    if (share > kRounding && share < 1.0 - kRounding) {
      if (edge.axis >= 0) return {};
      edge = {a, share};
    } else if (share > 0.5) {
      ++place.base[a];
      place.share[a] = 0.0;
    }
  }
  return edge;
}

/// Calls `on_edge(vertex, first sample, edge)` for the vertices on edges of the grid, if `wants_edges`, and
/// `in_cell(vertex, place)` for the others. Vertices outside of the grid are left out, and those that are not `wanted`.
/// Compiled once for all value types.
template <int N, class Real, class OnEdge, class InCell, class Wanted>
void visit_places(const Grid<N>& grid, const Contour<N, Real>& contour, const WorkOptions& work, bool wants_edges,
                  const OnEdge& on_edge, const InCell& in_cell, const Wanted& wanted) {
  const detail::GridLocator<N> locator(grid);
  detail::for_each_item(contour.vertices.size(), work.threads, work.progress, [&](std::size_t v) {
    if (!wanted(v)) return;
    detail::CellPlace<N> place;
    if (!locator.find(detail::widened_point<N>(contour.vertices[v]), place)) return;
    if (wants_edges) {
      detail::CellPlace<N> moved = place;
      if (const GridEdge edge = edge_of<N, Real>(moved); edge.axis >= 0) {
        on_edge(v, moved.base, edge);
        return;
      }
    }
    in_cell(v, place);
  });
}

/// Gradients at all vertices, as normals; 0 outside of the grid.
template <int N, class Real>
void interpolate_gradients(const detail::NormalWriter<N, Real>& writer, const Grid<N>& grid,
                           const Contour<N, Real>& contour, const WorkOptions& work, bool depends_on_edges,
                           Buffer<typename Contour<N, Real>::Vertex>& normals) {
  std::fill(normals.begin(), normals.end(), typename Contour<N, Real>::Vertex{});
  visit_places<N, Real>(
      grid, contour, work, depends_on_edges,
      [&](std::size_t v, const auto& first, const GridEdge& edge) {
        normals[v] = writer.on_edge(first, edge.axis, edge.alpha);
      },
      [&](std::size_t v, const detail::CellPlace<N>& place) {
        normals[v] = writer.template in_cell<detail::CellFrame<N, (1u << N) - 1>>(place.base, place.share);
      },
      [](std::size_t) { return true; });
}

/// The uncertainty at all vertices at which it is NaN, interpolated as the gradients are. 1 outside of the grid.
template <int N, class Real>
void find_uncertainty(const detail::NormalWriter<N, Real>& writer, const Grid<N>& grid, const Contour<N, Real>& contour,
                      const WorkOptions& work, Buffer<double>& result) {
  visit_places<N, Real>(
      grid, contour, work, true,
      [&](std::size_t v, const auto& first, const GridEdge& edge) {
        auto second = first;
        ++second[edge.axis];
        result[v] = (1.0 - edge.alpha) * writer.uncertainty_at(first, {edge.axis, 1}) +
                    edge.alpha * writer.uncertainty_at(second, {edge.axis, -1});
      },
      [&](std::size_t v, const detail::CellPlace<N>& place) {
        result[v] = 0.0;
        const detail::CellCorners<N> corners = detail::weighted_corners<N>(place);
        for (unsigned i = 0; i < corners.count; ++i)
          result[v] += corners.weight[i] * writer.uncertainty_at(corners.index[i], {});
      },
      [&](std::size_t v) { return std::isnan(result[v]); });
  for (double& value : result)
    if (std::isnan(value)) value = 1.0;
}

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> Buffer<typename Contour<N, Real>::Vertex> flat_normals(
    const Contour<N, Real>& contour, const WorkOptions& work) {
  detail::require_vertices(contour);
  Buffer<typename Contour<N, Real>::Vertex> result(contour.simplices.size());
  detail::for_each_item(result.size(), work.threads, work.progress, [&](std::size_t s) {
    result[s] = rounded<N, Real>(unit<N>(detail::normal_vector_of<N>(detail::corners_of(contour, s))));
  });
  return result;
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> Buffer<typename Contour<N, Real>::Vertex> geometric_normals(
    const Contour<N, Real>& contour, NormalWeights weights, const WorkOptions& work) {
  detail::require_vertices(contour);
  const std::vector<PointOf<N>> sums = sum_normals(detail::SimplexView<N>(contour), weights, work);
  Buffer<typename Contour<N, Real>::Vertex> result(sums.size());
  detail::for_each_item(sums.size(), work.threads, {},
                        [&](std::size_t v) { result[v] = rounded<N, Real>(unit<N>(sums[v])); });
  return result;
}

template <Value T, int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> Buffer<typename Contour<N, Real>::Vertex> gradient_normals(
    const Image<T, N>& image, const Contour<N, Real>& contour, Normals kind, const WorkOptions& work,
    const GradientKernel& kernel) {
  if (kind == Normals::none)
    throw Error(ErrorCode::InvalidArgument, "Normals::none for gradient_normals; expected another kind");
  const detail::ImageSource<T, N> source(image, 0.0, 0.0);
  Buffer<typename Contour<N, Real>::Vertex> result(contour.vertices.size());
  interpolate_gradients(detail::NormalWriter<N, Real>(source, image.grid(), contour.direction, kind, kernel),
                        image.grid(), contour, work, kind == Normals::context, result);
  return result;
}

template <Value T, int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> Buffer<double> normal_uncertainty(const Image<T, N>& image,
                                                                     const Contour<N, Real>& contour,
                                                                     const WorkOptions& work) {
  Buffer<double> result(contour.vertices.size(), std::numeric_limits<double>::quiet_NaN());
  detail::complete_uncertainty<T, N, Real>(image, contour, work, result);
  return result;
}

template <Value T, int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void detail::complete_uncertainty(const Image<T, N>& image, const Contour<N, Real>& contour, const WorkOptions& work,
                                  Buffer<double>& result) {
  const ImageSource<T, N> source(image, 0.0, 0.0);
  find_uncertainty(NormalWriter<N, Real>(source, image.grid(), contour.direction, Normals::context, {}), image.grid(),
                   contour, work, result);
}

#define TEGL_INSTANTIATE_CONTOURS(N, Real)                                                                      \
  template Buffer<Contour<N, Real>::Vertex> flat_normals<N, Real>(const Contour<N, Real>&, const WorkOptions&); \
  template Buffer<Contour<N, Real>::Vertex> geometric_normals<N, Real>(const Contour<N, Real>&, NormalWeights,  \
                                                                       const WorkOptions&);
#include "base/instantiate.hpp"

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                                              \
  template Buffer<Contour<N, Real>::Vertex> gradient_normals<T, N, Real>(                               \
      const Image<T, N>&, const Contour<N, Real>&, Normals, const WorkOptions&, const GradientKernel&); \
  template Buffer<double> normal_uncertainty<T, N, Real>(const Image<T, N>&, const Contour<N, Real>&,   \
                                                         const WorkOptions&);                           \
  template void detail::complete_uncertainty<T, N, Real>(const Image<T, N>&, const Contour<N, Real>&,   \
                                                         const WorkOptions&, Buffer<double>&);
#include "base/instantiate.hpp"

}  // namespace tegl
