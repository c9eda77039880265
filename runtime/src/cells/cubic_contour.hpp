// SPDX-License-Identifier: BSD-3-Clause
//
// The contour between high and low cells.
//
// Samples are the centres of cells, so the faces of the grid of samples are dual to those of the cells: the middle of
// an edge between two samples is the centre of the face between two cells, the middle of a square is the centre of an
// edge of cells (in 3D), and so on. A k-facet of the contour lies in a (k+1)-face of the grid. In the barycentric
// subdivision of the facets, with the vertex of each facet in the middle of its face of the grid, the simplices of each
// tile fill those quarters (eighths …) of the faces between cells that lie in the tile, on the side of each facet's own
// copy. If all facets are balls, the subdivision of the manifold of facets is a manifold.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "base/progress.hpp"
#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/grid.hpp"

namespace tegl::detail {

/// Coordinates of the cells of a grid, without the layer of low cells around it.
template <int N>
struct CellPlaces {
  std::array<std::vector<double>, N> centres;  ///< by axis
  std::array<std::vector<double>, N> faces;    ///< by axis, one more
  Matrix<N> linear;                            ///< world map
  Vector<N> offset;

  /// Whether the map from indices to the world turns orientations over.
  [[nodiscard]] bool is_mirrored() const {
    Eigen::Matrix<double, N, N> matrix;
    bool is_mirrored = false;
    for (int a = 0; a < N; ++a) {
      is_mirrored = is_mirrored != (faces[a].back() < faces[a].front());
      for (int row = 0; row < N; ++row) matrix(row, a) = linear[row][a];
    }
    return is_mirrored != (matrix.determinant() < 0);
  }

  /// The world position for coordinates along the axes.
  template <class Real>
  [[nodiscard]] std::array<Real, N> world(const std::array<double, N>& along) const noexcept {
    std::array<Real, N> result;
    for (int row = 0; row < N; ++row) {
      double x = offset[row];
      for (int a = 0; a < N; ++a) x += linear[row][a] * along[a];
      result[row] = static_cast<Real>(x);
    }
    return result;
  }
};

/// Whether all facets are balls.
template <int N, class Real>
bool are_balls(const FacetHierarchy<N, Real>& facets) {
  if constexpr (N == 4)
    for (std::size_t f = 0; f < facets.count(N - 1); ++f)
      if (facet_euler(facets, N - 1, f) != 1) return false;
  return true;
}

/// Makes the simplices of a subdivision: one for each sequence of facets that bound each other.
template <int N, class Real>
class BarycentricSubdivision {
 public:
  explicit BarycentricSubdivision(const FacetHierarchy<N, Real>& facets) : facets_(facets) {
    std::uint64_t vertices = 0;
    for (int k = 0; k < N; ++k) {
      first_[k] = vertices;
      vertices += facets.count(k);
    }
    if (vertices > std::numeric_limits<Index>::max())
      throw Error(ErrorCode::TooLarge, "the contour of cells has 2^32 vertices or more; expected fewer");
    vertex_count_ = static_cast<std::size_t>(vertices);
  }

  [[nodiscard]] std::size_t vertex_count() const noexcept { return vertex_count_; }
  /// The vertex of facet f of dimension k.
  [[nodiscard]] Index vertex(int k, std::size_t f) const noexcept { return static_cast<Index>(first_[k] + f); }

  /// Appends the simplices of all (N-1)-facets.
  void append_to(Buffer<std::array<Index, N>>& simplices, const Progress& progress) {
    in_parts(facets_.count(N - 1), progress, [&](std::size_t from, std::size_t to) {
      for (std::size_t f = from; f < to; ++f) {
        simplex_[N - 1] = vertex(N - 1, f);
        descend(N - 1, f, kSign, simplices);
      }
    });
  }

 private:
  /// The orientation of the subdivision: that of the facets times (-1)^(sum of the dimensions' places).
  static constexpr int kSign = (N * (N - 1) / 2) % 2 == 0 ? 1 : -1;

  void descend(int k, std::size_t f, int sign, Buffer<std::array<Index, N>>& simplices) {
    const auto down = facets_.down(k, f);
    const auto signs = facets_.down_signs(k, f);
    for (std::size_t i = 0; i < down.size(); ++i) {
      simplex_[k - 1] = vertex(k - 1, down[i]);
      const int product = sign * signs[i];
      if (k > 1) {
        descend(k - 1, down[i], product, simplices);
        continue;
      }
      std::array<Index, N> simplex = simplex_;
      if (product < 0) std::swap(simplex[0], simplex[1]);
      simplices.push_back(simplex);
    }
  }

  const FacetHierarchy<N, Real>& facets_;
  std::array<std::uint64_t, N> first_{};
  std::size_t vertex_count_ = 0;
  std::array<Index, N> simplex_{};
};

/// The contour of the faces between cells. `facets`: of the image of sides with a low layer around it.
template <int N, class Real>
Contour<N, Real> cubic_contour(const FacetHierarchy<N, Real>& facets, const CellPlaces<N>& places,
                               const Progress& progress) {
  Contour<N, Real> contour;
  BarycentricSubdivision<N, Real> subdivision(facets);
  contour.vertices.resize(subdivision.vertex_count());
  for (int k = 0; k < N; ++k)
    for (std::size_t f = 0; f < facets.count(k); ++f) {
      const FacetPlace& place = facets.levels[k].places[f];
      const auto index = facets.index_of(place.base);
      std::array<double, N> along;
      for (int a = 0; a < N; ++a)
        along[a] = (place.axes >> a & 1u) != 0 ? places.faces[a][index[a]] : places.centres[a][index[a] - 1];
      contour.vertices[subdivision.vertex(k, f)] = places.template world<Real>(along);
    }
  subdivision.append_to(contour.simplices, progress);
  return contour;
}

}  // namespace tegl::detail
