// SPDX-License-Identifier: BSD-3-Clause
//
// Options derived from the input of a simplification: hyperplanes of the image border, and an automatic scale of the
// axes.
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/LU>

#include "tegl/eigen.hpp"
#include "tegl/simplify.hpp"

namespace tegl {

template <int N>
requires DimensionBetween<N, 2, 4> std::vector<Hyperplane<N>> border_planes(const Grid<N>& grid) {
  // Border hyperplane of axis a: origin + the span of the other columns of the map.
  const Eigen::Matrix<double, N, N> linear = as_eigen(grid.linear);
  const Eigen::Matrix<double, N, N> inverse = linear.inverse();
  std::vector<Hyperplane<N>> result;
  for (int a = 0; a < N; ++a)
    for (const std::size_t i : {std::size_t{0}, grid.axes[a].size() - 1}) {
      Hyperplane<N> plane;
      as_eigen(plane.normal) = inverse.row(a).transpose();
      plane.offset = grid.axes[a][i];
      for (int b = 0; b < N; ++b) plane.offset += inverse(a, b) * grid.offset[b];
      result.push_back(plane);
    }
  return result;
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> std::array<double, N> automatic_scale(const Contour<N, Real>& contour) {
  // sum of the extents of all simplices
  std::array<double, N> extent{};
  for (const auto& simplex : contour.simplices)
    for (int a = 0; a < N; ++a) {
      Real low = contour.vertices[simplex[0]][a], high = low;
      for (const Index v : simplex) {
        low = std::min(low, contour.vertices[v][a]);
        high = std::max(high, contour.vertices[v][a]);
      }
      extent[a] += static_cast<double>(high) - static_cast<double>(low);
    }
  // axes with another unit are scaled to the extent of the first
  std::array<double, N> result;
  for (int a = 0; a < N; ++a) {
    const bool same = contour.axis_units[a] == contour.axis_units[0];
    result[a] = same || !(extent[a] > 0.0) || !(extent[0] > 0.0) ? 1.0 : extent[0] / extent[a];
  }
  return result;
}

template std::vector<Hyperplane<2>> border_planes(const Grid<2>&);
template std::vector<Hyperplane<3>> border_planes(const Grid<3>&);
template std::vector<Hyperplane<4>> border_planes(const Grid<4>&);
#define TEGL_INSTANTIATE_CONTOURS(N, Real) \
  template std::array<double, N> automatic_scale<N, Real>(const Contour<N, Real>&);
#include "base/instantiate.hpp"

}  // namespace tegl
