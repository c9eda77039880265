// SPDX-License-Identifier: BSD-3-Clause
//
// The simplices into which one cell of a grid is divided, in any dimension.
//
// Based on: M. Liversage, thesis, 1994, section 9.3.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "tegl/division.hpp"

namespace tegl::detail {

/// A point of a divided cell: the centre of a face, or a corner.
struct FacePoint {
  unsigned low = 0;   ///< bit a: the face's lowest corner is at the upper end of axis a
  unsigned axes = 0;  ///< along which the face extends; 0: a corner
  bool operator==(const FacePoint&) const = default;
};

/// The corners of a face, as masks of axes, ascending.
inline std::vector<unsigned> corner_masks(FacePoint face) {
  std::vector<unsigned> masks;
  for (unsigned v = 0; v <= face.axes; ++v)
    if ((v & ~face.axes) == 0) masks.push_back(face.low | v);
  return masks;
}

/// The value of a centre. Rounding does not move it past the values of all corners: else a cell whose corners are alike
/// could have a contour.
inline double mean_of_corners(std::span<const double> values) noexcept {
  double sum = 0.0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  if (std::isnan(sum)) return sum;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return std::clamp(sum, *least, *most);
}

/// The gradient at a point of a divided cell: the mean of the corners' gradients, of_corner(mask of axes).
template <int N, class OfCorner>
std::array<double, N> mean_gradient(FacePoint point, const OfCorner& of_corner) {
  const std::vector<unsigned> corners = corner_masks(point);
  std::array<double, N> mean{};
  for (const unsigned corner : corners) {
    const std::array<double, N> gradient = of_corner(corner);
    for (int a = 0; a < N; ++a) mean[a] += gradient[a] / static_cast<double>(corners.size());
  }
  return mean;
}

/// Calls visit(facet) for the facets of a face.
template <class Visit>
void for_each_facet(FacePoint face, const Visit& visit) {
  for (unsigned axis = 1; axis <= face.axes; axis <<= 1) {
    if ((face.axes & axis) == 0) continue;
    visit(FacePoint{face.low, face.axes & ~axis});
    visit(FacePoint{face.low | axis, face.axes & ~axis});
  }
}

/// Calls visit(points) for Kuhn's simplices: for each order of the axes, the path along them.
template <int N, class Visit>
void for_each_path(const Visit& visit) {
  std::array<unsigned, N> order;
  std::iota(order.begin(), order.end(), 0u);
  do {
    std::array<FacePoint, N + 1> points;
    for (int j = 0; j < N; ++j) points[j + 1].low = points[j].low | 1u << order[j];
    visit(std::span<const FacePoint>(points));
  } while (std::next_permutation(order.begin(), order.end()));
}

/// Calls visit(points) for the simplices of a face as a cone from its centre over those of its facets. `apexes`: the
/// first points of each simplex; unchanged afterwards.
template <class Visit>
void for_each_cone(FacePoint face, std::vector<FacePoint>& apexes, const Visit& visit) {
  if (std::popcount(face.axes) == 1) {
    apexes.push_back({face.low, 0});
    apexes.push_back({face.low | face.axes, 0});
    visit(std::span<const FacePoint>(apexes));
    apexes.resize(apexes.size() - 2);
    return;
  }
  apexes.push_back(face);
  for_each_facet(face, [&](FacePoint facet) { for_each_cone(facet, apexes, visit); });
  apexes.pop_back();
}

/// The points and simplices of a cell that is divided alike wherever it is; none for other divisions.
template <int N>
struct DividedCell {
  static constexpr unsigned kAll = (1u << N) - 1;

  explicit DividedCell(Division division) {
    const auto add = [this](std::span<const FacePoint> simplex) {
      auto& numbers = simplices.emplace_back();
      for (int j = 0; j <= N; ++j) {
        const auto found = std::find(points.begin(), points.end(), simplex[j]);
        numbers[j] = static_cast<std::uint8_t>(found - points.begin());
        if (found == points.end()) points.push_back(simplex[j]);
      }
    };
    std::vector<FacePoint> apexes;
    if (division == Division::kuhn) for_each_path<N>(add);
    if (division == Division::symmetric) for_each_cone({0, kAll}, apexes, add);
  }

  std::vector<FacePoint> points;  ///< in the order of their first simplices
  std::vector<std::array<std::uint8_t, N + 1>> simplices;
};

}  // namespace tegl::detail
