// SPDX-License-Identifier: BSD-3-Clause
//
// Points, and simplices of dimension N - 1 in N-space: normals, shapes, distances. Templates on the dimension, N = 1 to
// 4.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace tegl::detail {

template <int N>
using PointN = std::array<double, N>;

/// N corners: an (N-1)-simplex in N-space.
template <int N>
using CornersN = std::array<PointN<N>, N>;

template <std::size_t N>
std::array<double, N> minus(const std::array<double, N>& a, const std::array<double, N>& b) {
  std::array<double, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = a[i] - b[i];
  return result;
}

template <std::size_t N>
double dot(const std::array<double, N>& a, const std::array<double, N>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < N; ++i) sum += a[i] * b[i];
  return sum;
}

template <std::size_t N>
double norm(const std::array<double, N>& a) {
  return std::sqrt(dot(a, a));
}

/// a + t (b - a). A coordinate that is equal in a and b is exact.
template <std::size_t N>
std::array<double, N> between(const std::array<double, N>& a, const std::array<double, N>& b, double t) {
  std::array<double, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = a[i] + t * (b[i] - a[i]);
  return result;
}

/// The normal of an (N-1)-simplex with length (N-1)! times its measure. Even permutations of the corners give the same
/// side.
template <int N>
PointN<N> normal_of(const CornersN<N>& corners) {
  std::array<PointN<N>, N> e;
  for (int i = 1; i < N; ++i) e[i] = minus(corners[i], corners[0]);
  if constexpr (N == 1) {
    return {1.0};
  } else if constexpr (N == 2) {
    return {e[1][1], -e[1][0]};
  } else if constexpr (N == 3) {
    return {e[1][1] * e[2][2] - e[1][2] * e[2][1], e[1][2] * e[2][0] - e[1][0] * e[2][2],
            e[1][0] * e[2][1] - e[1][1] * e[2][0]};
  } else {
    static_assert(N == 4);
    // The 2 x 2 minors of the last two edges, each used twice.
    const auto minor = [&](int a, int b) { return e[2][a] * e[3][b] - e[2][b] * e[3][a]; };
    const double xy = minor(0, 1), xz = minor(0, 2), xt = minor(0, 3);
    const double yz = minor(1, 2), yt = minor(1, 3), zt = minor(2, 3);
    const PointN<4>& f = e[1];
    return {f[1] * zt - f[2] * yt + f[3] * yz, -(f[0] * zt - f[2] * xt + f[3] * xz), f[0] * yt - f[1] * xt + f[3] * xy,
            -(f[0] * yz - f[1] * xz + f[2] * xy)};
  }
}

/// The centroid.
template <int N>
PointN<N> middle_of(const CornersN<N>& corners) {
  PointN<N> middle{};
  for (const PointN<N>& corner : corners)
    for (int a = 0; a < N; ++a) middle[a] += corner[a] / N;
  return middle;
}

/// The positions of the ends of the longest edge, the smaller one first.
template <int N>
std::pair<int, int> ends_of_longest_edge(const CornersN<N>& corners) {
  std::pair<int, int> ends = {0, 1};
  double longest = -1.0;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < i; ++j) {
      const PointN<N> edge = minus(corners[i], corners[j]);
      const double square = dot(edge, edge);
      if (square > longest) {
        longest = square;
        ends = {j, i};
      }
    }
  return ends;
}

template <int N>
double longest_edge(const CornersN<N>& corners) {
  double square = 0.0;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < i; ++j) {
      const PointN<N> edge = minus(corners[i], corners[j]);
      square = std::max(square, dot(edge, edge));
    }
  return std::sqrt(square);
}

/// Shape quality, independent of size: (N-1)! times the measure, relative to a cube with the longest edge. 0 for flat
/// simplices, about 1 for good ones.
template <int N>
double shape_of_simplex(const CornersN<N>& corners, double normal_length) {
  const double edge = longest_edge<N>(corners);
  if (edge <= 0.0) return 0.0;
  double cube = 1.0;
  for (int i = 1; i < N; ++i) cube *= edge;
  return normal_length / cube;
}

/// Projection of a point onto the affine hull of a simplex.
template <int N>
struct Projected {
  bool flat = false;                ///< the simplex is flat; the other members are then undefined
  std::array<double, N> weights{};  ///< barycentric coordinates
  PointN<N> rest;                   ///< from the projection to the point
};

/// `count`: number of corners, 2 or more. Gram-Schmidt gives coordinates in an orthonormal basis of the edges, back
/// substitution the barycentric coordinates.
template <int N>
Projected<N> project_onto_hull(const PointN<N>& p, const std::array<PointN<N>, N>& corners, int count) {
  std::array<PointN<N>, N> basis;
  std::array<std::array<double, N>, N> upper{};
  std::array<double, N> at{};
  Projected<N> result;
  PointN<N>& rest = result.rest;
  rest = minus(p, corners[0]);
  for (int i = 1; i < count; ++i) {
    PointN<N> edge = minus(corners[i], corners[0]);
    const double length = norm(edge);
    for (int j = 1; j < i; ++j) {
      upper[j][i] = dot(edge, basis[j]);
      for (int a = 0; a < N; ++a) edge[a] -= upper[j][i] * basis[j][a];
    }
    upper[i][i] = norm(edge);
    if (upper[i][i] <= 1e-12 * length || length <= 0.0) {
      result.flat = true;
      return result;
    }
    for (int a = 0; a < N; ++a) basis[i][a] = edge[a] / upper[i][i];
    at[i] = dot(rest, basis[i]);
    for (int a = 0; a < N; ++a) rest[a] -= at[i] * basis[i][a];
  }
  std::array<double, N>& weights = result.weights;
  weights[0] = 1.0;
  for (int i = count - 1; i > 0; --i) {
    double sum = at[i];
    for (int j = i + 1; j < count; ++j) sum -= upper[i][j] * weights[j];
    weights[i] = sum / upper[i][i];
    weights[0] -= weights[i];
  }
  return result;
}

/// The vector to a point from the nearest point of the convex hull of `count` points (count <= N). If it is not shorter
/// than `most`, the result is any vector that is not shorter.
///
/// If the projection onto the affine hull has negative barycentric coordinates, the nearest point lies on a face
/// opposite to a corner with such a coordinate: these faces are tested recursively, down to points. A flat simplex is
/// the union of its faces.
template <int N>
PointN<N> way_from_simplex(const PointN<N>& p, const std::array<PointN<N>, N>& corners, int count,
                           double most = std::numeric_limits<double>::infinity()) {
  if (count == 1) return minus(p, corners[0]);
  const Projected<N> projected = project_onto_hull<N>(p, corners, count);
  // the distance from the affine hull is a lower bound
  if (!projected.flat && !(norm(projected.rest) < most)) return projected.rest;
  const auto is_outside = [&](int i) { return projected.flat || !(projected.weights[i] >= 0.0); };
  bool any_outside = false;
  for (int i = 0; i < count; ++i) any_outside = any_outside || is_outside(i);
  if (!any_outside) return projected.rest;
  PointN<N> nearest;
  nearest.fill(std::numeric_limits<double>::infinity());
  double least = std::numeric_limits<double>::infinity();
  for (int omitted = 0; omitted < count; ++omitted) {
    if (!is_outside(omitted)) continue;
    std::array<PointN<N>, N> face;
    for (int i = 0, k = 0; i < count; ++i)
      if (i != omitted) face[k++] = corners[i];
    const PointN<N> way = way_from_simplex<N>(p, face, count - 1, std::min(least, most));
    const double length = norm(way);
    if (!(length < least)) continue;
    least = length;
    nearest = way;
  }
  return nearest;
}

/// Distance of a point from the convex hull of `count` points (count <= N). If it is not below `most`, the result is
/// any number that is at least `most`.
template <int N>
double distance_to_simplex(const PointN<N>& p, const std::array<PointN<N>, N>& corners, int count,
                           double most = std::numeric_limits<double>::infinity()) {
  return norm(way_from_simplex<N>(p, corners, count, most));
}

}  // namespace tegl::detail
