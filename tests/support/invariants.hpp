// SPDX-License-Identifier: BSD-3-Clause
//
// Invariants of every contour: closed, manifold, oriented, with boundary only at the end of the data.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ostream>
#include <vector>

#include <gtest/gtest.h>

#include "fields.hpp"
#include "tegl/check.hpp"
#include "tegl/image.hpp"

namespace tegl {

inline std::ostream& operator<<(std::ostream& out, const MeshReport& report) {
  return out << "dim " << report.dim << ", vertices " << report.vertices << " (+" << report.unused_vertices
             << " unused), simplices " << report.simplices << ", components " << report.components << ", euler "
             << report.euler << ", boundary " << report.boundary_simplices << ", non-manifold "
             << report.nonmanifold_simplices << ", bad links " << report.bad_links << ", orientation conflicts "
             << report.orientation_conflicts << ", degenerate " << report.degenerate_simplices;
}

}  // namespace tegl

namespace tegl::test {

/// An oriented manifold, with or without boundary: no face in three simplices, all links spheres or balls, consistent
/// orientations, no unused vertices. Zero-size simplices are allowed.
inline ::testing::AssertionResult is_oriented_manifold(const MeshReport& report) {
  if (report.nonmanifold_simplices == 0 && report.bad_links == 0 && report.orientation_conflicts == 0 &&
      report.unused_vertices == 0)
    return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "not an oriented manifold: " << report;
}

/// An oriented manifold without boundary.
inline ::testing::AssertionResult is_closed_oriented_manifold(const MeshReport& report) {
  if (report.boundary_simplices == 0) return is_oriented_manifold(report);
  return ::testing::AssertionFailure() << "not closed: " << report;
}

/// Checks the contour; returns the report for further expectations.
template <int N, class Real>
MeshReport expect_oriented_manifold(const Contour<N, Real>& contour) {
  const MeshReport report = check(contour);
  EXPECT_TRUE(is_oriented_manifold(report));
  return report;
}

template <int N, class Real>
MeshReport expect_closed_manifold(const Contour<N, Real>& contour) {
  const MeshReport report = check(contour);
  EXPECT_TRUE(is_closed_oriented_manifold(report));
  return report;
}

/// The (N-2)-faces that lie in exactly one simplex, as rows of N - 1 vertex numbers. Implemented independently of
/// `check`, by sorting all faces, so that each confirms the other.
template <int N, class Real>
std::vector<std::array<Index, N - 1>> boundary_faces(const Contour<N, Real>& contour) {
  std::vector<std::array<Index, N - 1>> faces;
  faces.reserve(contour.simplices.size() * N);
  for (const auto& simplex : contour.simplices)
    for (int omitted = 0; omitted < N; ++omitted) {
      std::array<Index, N - 1> face;
      for (int j = 0, k = 0; j < N; ++j)
        if (j != omitted) face[k++] = simplex[j];
      std::sort(face.begin(), face.end());
      faces.push_back(face);
    }
  std::sort(faces.begin(), faces.end());
  std::vector<std::array<Index, N - 1>> result;
  for (std::size_t i = 0, j = 0; i < faces.size(); i = j) {
    while (j < faces.size() && faces[j] == faces[i]) ++j;
    if (j - i == 1) result.push_back(faces[i]);
  }
  return result;
}

/// True if the tile with the given lowest corner lies in the image and has no missing corner.
template <Value T, int N>
bool is_valid_tile(const Image<T, N>& image, const std::array<std::ptrdiff_t, N>& tile) {
  for (int a = 0; a < N; ++a)
    if (tile[a] < 0 || tile[a] + 1 >= static_cast<std::ptrdiff_t>(image.size(a))) return false;
  for (unsigned corner = 0; corner < (1u << N); ++corner) {
    std::array<std::size_t, N> index;
    for (int a = 0; a < N; ++a) index[a] = static_cast<std::size_t>(tile[a]) + ((corner >> a) & 1u);
    if constexpr (std::is_floating_point_v<T>)
      if (std::isnan(image(index))) return false;
  }
  return true;
}

/// The (real) index coordinate of an axis coordinate, for any strictly monotone axis; exact at the samples' coordinates
/// rounded to Real. Returns -1 outside the axis.
template <class Real>
double index_coordinate(const Axis& axis, Real x) {
  for (std::size_t i = 0; i < axis.size(); ++i)
    if (static_cast<Real>(axis[i]) == x) return static_cast<double>(i);
  for (std::size_t i = 0; i + 1 < axis.size(); ++i)
    if ((axis[i] < static_cast<double>(x)) != (axis[i + 1] < static_cast<double>(x)))
      return static_cast<double>(i) + (static_cast<double>(x) - axis[i]) / (axis[i + 1] - axis[i]);
  return -1.0;
}

/// True if a boundary face lies between a valid tile and an invalid one, which is outside the image or has a missing
/// corner. `at`: index coordinates of the face's centroid; `axis`: the axis that is constant in the face.
template <Value T, int N>
bool separates_valid_tile(const Image<T, N>& image, const Point<N>& at, int axis) {
  std::array<std::ptrdiff_t, N> above;
  for (int a = 0; a < N; ++a) above[a] = static_cast<std::ptrdiff_t>(std::floor(at[a]));
  above[axis] = std::lround(at[axis]);
  auto below = above;
  --below[axis];
  return is_valid_tile<T, N>(image, above) != is_valid_tile<T, N>(image, below);
}

/// EXPECT_TRUE(is_open_only_where_data_end(contour, image)): every boundary face lies in a face of a valid tile whose
/// other side has no valid tile. For grids without a world map and images without samples at the isovalue.
template <int N, class Real, Value T>
::testing::AssertionResult is_open_only_where_data_end(const Contour<N, Real>& contour, const Image<T, N>& image) {
  for (const auto& face : boundary_faces(contour)) {
    Point<N> centroid{};
    std::array<bool, N> constant;
    for (int a = 0; a < N; ++a) {
      constant[a] = true;
      for (const Index v : face) {
        constant[a] = constant[a] && contour.vertices[v][a] == contour.vertices[face[0]][a];
        centroid[a] += index_coordinate(image.grid().axes[a], contour.vertices[v][a]) / (N - 1);
      }
    }
    bool explained = false;
    for (int a = 0; a < N; ++a)
      explained = explained || (constant[a] && std::abs(centroid[a] - std::round(centroid[a])) < 1e-9 &&
                                separates_valid_tile<T, N>(image, centroid, a));
    if (explained) continue;
    auto failure = ::testing::AssertionFailure() << "a boundary face inside the data, at index";
    for (int a = 0; a < N; ++a) failure << ' ' << centroid[a];
    return failure;
  }
  return ::testing::AssertionSuccess();
}

}  // namespace tegl::test
