// SPDX-License-Identifier: BSD-3-Clause
//
// Hypersurface elements: a contour as points with normal vectors, for flux integrals over it, as codes for freeze-out
// surfaces compute them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/grid.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// Elements of an (N-1)-dimensional contour in N-space. The integral of a current j over the contour is the sum of
/// j(centroid) . normal over its elements.
///
/// `normals` are covectors, d sigma_mu: the normal times the (N-1)-volume. They are determinants of world coordinates
/// and need no metric, so they are the same in Euclidean and in Minkowski space. Component mu has the product of the
/// units of all other axes. They face the same side as the contour: low (descent) or high (ascent).
template <int N>
requires DimensionBetween<N, 2, 5>
struct Elements {
  using Point = std::array<double, N>;  ///< coordinates, or components of a vector

  Buffer<Point> centroids = {};                              ///< #E x N world coordinates, row = element
  Buffer<Point> normals = {};                                ///< #E x N, row = element
  Buffer<double> measures = {};                              ///< #E: Euclidean lengths, areas or volumes
  Buffer<Index> counts = {};                                 ///< #E: number of simplices of the element
  std::vector<Attribute> attributes = {};                    ///< #E rows: the contour's of vertices, then of simplices
  std::array<std::string, N> axis_names = {};                ///< the contour's
  std::array<std::string, N> axis_units = {};                ///< the contour's
  GradientDirection direction = GradientDirection::descent;  ///< the side that normals face
};

/// One element per simplex, in the order of the simplices. Vertex attributes are interpolated to the centroid: exact
/// for linear fields, NaN if a vertex has NaN. Simplex attributes are kept. N = 2, 3, 4, 5. Errors: InvalidArgument (a
/// vertex number out of range, a coordinate that is not finite, attributes or normals of another number); Cancelled.
/// O(#S) time and memory. Thread-safe.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Elements<N> elements(const Contour<N, Real>& contour, const WorkOptions& work = {});

/// One element for each connected part of the contour in a tile of the grid: simplices of a tile that share vertices
/// become one element. It has the sum of their normals and measures, and the mean of their centroids and attributes,
/// weighted by measure. Cornelius gives the same (P. Huovinen and H. Petersen, Eur. Phys. J. A 48 (2012) 171,
/// arXiv:1206.3371). Elements are in the order of tiles, axis 0 fastest. Caps (ExtractOptions::close) are separate
/// elements. A simplex that lies between two tiles belongs to one of them. The sum of all normals equals that over all
/// simplices, up to rounding.
///
/// `grid`: the grid of the image that the contour was extracted from. Errors: those of `elements`; InvalidArgument if a
/// simplex lies outside of the grid. O(#S log #S) time.
template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] Elements<N> elements_by_cell(const Contour<N, Real>& contour, const Grid<N>& grid,
                                           const WorkOptions& work = {});

/// Sums over elements, compensated: exact to the last bits for any number and order.
template <int N>
requires DimensionBetween<N, 2, 5>
struct ElementSum {
  std::array<double, N> normal{};    ///< sum of the normals: 0 for a closed contour, by Gauss's theorem
  std::array<double, N> absolute{};  ///< sum of the absolute values of their components
  double measure = 0.0;              ///< sum of the measures: the contour's length, area or volume
  /// The maximum of |normal| / absolute over the axes: how far the elements are from closed, independent of units; 0
  /// without elements.
  [[nodiscard]] double closure_error() const noexcept;
};

/// Sums elements in their order, compensated. O(#E).
template <int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] ElementSum<N> sum_of(const Elements<N>& elements);

}  // namespace tegl
