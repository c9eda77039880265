// SPDX-License-Identifier: BSD-3-Clause
//
// Checks the caps of a closed contour: each lies exactly in one side of the image border, and their content in a side
// equals that of the high set of that side's own image.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "compare.hpp"
#include "invariants.hpp"
#include "measure.hpp"
#include "tegl/eigen.hpp"
#include "tegl/extract.hpp"

namespace tegl::test {

/// Coordinate of a side of an image's border: side 2 a is at the first sample of axis a, side 2 a + 1 at the last.
template <int N, class Real>
Real border_coordinate(const Grid<N>& grid, int side) {
  const Axis& axis = grid.axes[side / 2];
  return static_cast<Real>(axis[side % 2 == 0 ? 0 : axis.size() - 1]);
}

/// A side that contains all corners of a simplex exactly, if any. For grids without a world map.
template <int N, class Real>
std::optional<int> side_of(const CanonicalSimplex<N, Real>& simplex, const Grid<N>& grid) {
  for (int side = 0; side < 2 * N; ++side) {
    const Real at = border_coordinate<N, Real>(grid, side);
    if (std::all_of(simplex.corners.begin(), simplex.corners.end(),
                    [&](const auto& corner) { return corner[side / 2] == at; }))
      return side;
  }
  return std::nullopt;
}

/// The measure of a simplex in a side of the border; negative if its orientation is wrong. The high set is inside.
template <int N, class Real>
double content_outwards(const CanonicalSimplex<N, Real>& simplex, int side, const Grid<N>& grid,
                        GradientDirection direction) {
  Eigen::Matrix<double, N, N> frame;
  for (int j = 1; j < N; ++j)
    for (int a = 0; a < N; ++a)
      frame(a, j - 1) = static_cast<double>(simplex.corners[j][a]) - static_cast<double>(simplex.corners[0][a]);
  frame.col(N - 1).setZero();
  const bool outwards_is_up = (side % 2 != 0) == (grid.axes[side / 2][1] > grid.axes[side / 2][0]);
  frame(side / 2, N - 1) = outwards_is_up == (direction == GradientDirection::descent) ? 1.0 : -1.0;
  return simplex.parity * frame.determinant() / factorial(N - 1);
}

/// Expects `closed` to contain all simplices of `open`, and each of its other simplices, the caps, to lie in one side
/// of the border with no corner outside the image. Returns the content of the caps in each side; caps that face inwards
/// count negatively.
template <int N, class Real, Value T>
std::array<double, 2 * N> expect_caps_in_border(const Contour<N, Real>& closed, const Contour<N, Real>& open,
                                                const Image<T, N>& image) {
  const auto all = canonical_simplices(closed), inside = canonical_simplices(open);
  EXPECT_TRUE(std::includes(all.begin(), all.end(), inside.begin(), inside.end()));
  std::vector<CanonicalSimplex<N, Real>> caps;
  std::set_difference(all.begin(), all.end(), inside.begin(), inside.end(), std::back_inserter(caps));
  EXPECT_FALSE(caps.empty());
  std::array<double, 2 * N> sizes{};
  for (const auto& cap : caps) {
    const std::optional<int> side = side_of(cap, image.grid());
    EXPECT_TRUE(side.has_value()) << "a cap outside of the border";
    if (!side) break;
    sizes[static_cast<std::size_t>(*side)] += content_outwards(cap, *side, image.grid(), closed.direction);
    for (const auto& corner : cap.corners)
      for (int a = 0; a < N; ++a) {
        const double at = index_coordinate(image.grid().axes[a], corner[a]);
        EXPECT_TRUE(at >= 0.0 && at <= static_cast<double>(image.size(a) - 1)) << "a cap's corner at index " << at;
      }
  }
  return sizes;
}

/// The image of one side of an image's border.
template <Value T, int N>
OwnedImage<T, N - 1> image_of_side(const Image<T, N>& image, int side) {
  OwnedImage<T, N - 1> result;
  const int across = side / 2;
  for (int a = 0, k = 0; a < N; ++a)
    if (a != across) result.grid.axes[k++] = image.grid().axes[a];
  result.values.resize(sample_count(result.grid));
  for_each_sample<N - 1>(result.grid, [&](std::size_t i, const std::array<std::size_t, N - 1>& index) {
    std::array<std::size_t, N> at;
    at[across] = side % 2 == 0 ? 0 : image.size(across) - 1;
    for (int a = 0, k = 0; a < N; ++a)
      if (a != across) at[a] = index[k++];
    result.values[i] = image(at);
  });
  return result;
}

/// The content of the image's box.
template <int N>
double box_content(const Grid<N>& grid) {
  double product = std::abs(as_eigen(grid.linear).determinant());
  for (const Axis& axis : grid.axes) product *= std::abs(axis[axis.size() - 1] - axis[0]);
  return product;
}

/// All checks of a closed contour of an image without missing values. For grids without a world map.
template <class Real, Value T, int N>
void expect_closed_at_border(const Image<T, N>& image, double isovalue, ExtractOptions options) {
  options.close = false;
  const auto open = extract<Real>(image, isovalue, options);
  options.close = true;
  const auto closed = extract<Real>(image, isovalue, options);
  expect_closed_manifold(closed);
  const double box = box_content(image.grid());
  const double enclosed = enclosed_content(closed);
  EXPECT_GT(enclosed, 0.0);
  EXPECT_LT(enclosed, box);
  const auto sizes = expect_caps_in_border(closed, open, image);
  if constexpr (N == 3 || N == 4)  // the high set of a side's image, by the contour of that image
    for (int side = 0; side < 2 * N; ++side) {
      const auto of_side = image_of_side(image, side);
      const double whole = box_content(of_side.grid);
      EXPECT_NEAR(sizes[static_cast<std::size_t>(side)],
                  enclosed_content(extract<double>(of_side.view(), isovalue, options)),
                  (sizeof(Real) == 4 ? 1e-4 : 1e-9) * whole)
          << "side " << side;
    }
}

/// Expects a closed contour of an image with missing values to be open only inside the image, at tiles with missing
/// values, and the caps to lie in the border.
template <class Real, Value T, int N>
void expect_closed_up_to_missing_values(const Image<T, N>& image, double isovalue, ExtractOptions options) {
  options.close = false;
  const auto open = extract<Real>(image, isovalue, options);
  options.close = true;
  const auto closed = extract<Real>(image, isovalue, options);
  const MeshReport report = check(closed);
  EXPECT_EQ(report.nonmanifold_simplices, 0u);
  EXPECT_EQ(report.orientation_conflicts, 0u);
  EXPECT_EQ(report.unused_vertices, 0u);
  expect_caps_in_border(closed, open, image);
  for (const auto& face : boundary_faces(closed)) {
    Point<N> centroid{};
    for (int a = 0; a < N; ++a)
      for (const Index v : face) centroid[a] += index_coordinate(image.grid().axes[a], closed.vertices[v][a]) / (N - 1);
    bool explained = false;
    for (int a = 0; a < N && !explained; ++a) {
      const double layer = std::round(centroid[a]);
      if (std::abs(centroid[a] - layer) > 1e-6 || layer < 1.0 || layer > static_cast<double>(image.size(a)) - 2.0)
        continue;
      // Caps at the last samples belong to the last tiles.
      Point<N> inside = centroid;
      for (int b = 0; b < N; ++b) inside[b] = std::min(inside[b], static_cast<double>(image.size(b)) - 1.5);
      inside[a] = layer;
      explained = separates_valid_tile<T, N>(image, inside, a);
    }
    EXPECT_TRUE(explained) << "a boundary face where no values are missing";
    if (!explained) return;
  }
}

}  // namespace tegl::test
