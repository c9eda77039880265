// SPDX-License-Identifier: BSD-3-Clause
//
// Hypersurface elements: a contour as points with normal vectors, to integrate currents over it, as codes for
// freeze-out surfaces do.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/grid.hpp"

namespace tegl {

/// Elements of an (N-1)-dimensional contour in N-space. The integral of a current j over the contour is the sum of
/// j(centroid) . normal over its elements.
///
/// `normals` are covectors, d sigma_mu: the normal times the (N-1)-volume, made of the world coordinates by
/// determinants alone, without a metric, so they are the same in Euclid's space and in Minkowski's. Component mu has
/// the product of the units of all other axes. They face the side that the contour's orientation does: low (descent) or
/// high (ascent).
template <int N>
requires DimensionBetween<N, 2, 5>
struct Elements {
  using Point = std::array<double, N>;  ///< coordinates, or components of a vector

  Buffer<Point> centroids = {};                ///< #E x N world coordinates, row = element
  Buffer<Point> normals = {};                  ///< #E x N, row = element
  Buffer<double> measures = {};                ///< #E: lengths, areas or volumes, as Euclid has them
  Buffer<Index> counts = {};                   ///< #E: of how many simplices the element is made
  std::vector<Attribute> attributes = {};      ///< of elements: the contour's, of vertices first, then of simplices
  std::array<std::string, N> axis_names = {};  ///< the contour's
  std::array<std::string, N> axis_units = {};  ///< likewise
  GradientDirection direction = GradientDirection::descent;  ///< which side dsigma points to
};

/// One element per simplex, in the order of the simplices. Attributes of vertices are interpolated to the centroid:
/// exact for linear fields, NaN where one of the vertices has NaN. Those of simplices stay. N = 2, 3, 4, 5.
/// Errors: InvalidArgument (a vertex number out of range, a coordinate that is not finite, attributes or normals of
/// another number); Cancelled. O(#S) time and memory. Thread-safe.
template <int N, class Real>
Elements<N> elements(const Contour<N, Real>& contour, const WorkOptions& options = {});

/// One element per tile of the grid that the contour is of, and piece of the contour in it: simplices that share
/// vertices within a tile are one, with the sum of their normals, the sum of their measures, and their centroids' and
/// attributes' mean, weighted by measure. This is what Cornelius gives (P. Huovinen and H. Petersen, Eur. Phys. J. A 48
/// (2012) 171, arXiv:1206.3371). In the order of tiles, axis 0 fastest. Caps (ExtractOptions::close) are elements of
/// their own, and what lies flat between two tiles belongs to one of them. The sum of all normals is that of all
/// simplices, up to rounding.
///
/// `grid`: the one of the image that the contour was extracted from. Errors: those above; InvalidArgument if a simplex
/// lies outside of the grid. O(#S log #S) time.
template <int N, class Real>
Elements<N> elements_by_cell(const Contour<N, Real>& contour, const Grid<N>& grid, const WorkOptions& options = {});

/// Sums over elements, exact to the last bits (compensated), whatever their number and order.
template <int N>
requires DimensionBetween<N, 2, 5>
struct ElementSum {
  std::array<double, N> normal{};    ///< the sum of the normals: 0 for a closed contour, by Gauss's theorem
  std::array<double, N> absolute{};  ///< the sums of their components' absolute values
  double measure = 0.0;              ///< the sum of the measures: the contour's length, area or volume
  /// The largest of |normal| / absolute over the axes: how far from closed the elements are, whatever the units; 0 for
  /// no elements.
  [[nodiscard]] double closure_error() const noexcept;
};

/// Their sum, compensated, in their order. O(#E).
template <int N>
ElementSum<N> sum_of(const Elements<N>& elements);

}  // namespace tegl
