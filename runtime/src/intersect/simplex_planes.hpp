// SPDX-License-Identifier: BSD-3-Clause
//
// Simplices of a contour with the normals of their hyperplanes, and bounds of the normals' rounding errors. With these,
// most signs of determinants of N + 1 vertices are one scalar product.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/workers.hpp"
#include "intersect/exact_meeting.hpp"
#include "mesh/simplex_shapes.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

inline constexpr double kRounding = 0x1p-53;
/// Larger coordinates could overflow in determinants: no rounding error of them is bounded, so all is decided exactly.
inline constexpr double kLargestFiltered = 0x1p+200;
/// Absolute error of a determinant by underflow, with a margin.
inline constexpr double kUnderflow = 0x1p-800;

template <int N>
double largest_of(const PointN<N>& v) noexcept {
  double largest = 0.0;
  for (const double x : v) largest = std::max(largest, std::abs(x));
  return largest;
}

/// 1, -1, or 0 if rounding errors up to `bound` could change the sign.
inline int sign_beyond(double x, double bound) noexcept { return static_cast<int>(x > bound) - (x < -bound); }

/// The normal of a simplex, of any length: determinants of vertices are scalar products with it.
template <int N>
struct SimplexPlane {
  PointN<N> normal{};
  double bound = 0.0;  ///< n . d has an error of at most bound * max |d_a| + 2^-1000, if d is a rounded difference

  /// The side that a point lies on: 1, -1, or 0 for unknown. `corner`: a corner of the simplex.
  [[nodiscard]] int side(const PointN<N>& corner, const PointN<N>& p) const noexcept {
    const PointN<N> d = minus(p, corner);
    return side_of_vector(d);
  }
  [[nodiscard]] int side_of_vector(const PointN<N>& d) const noexcept {
    return sign_beyond(dot(normal, d), bound * largest_of<N>(d) + 0x1p-1000);
  }
};

/// The normal with its bound. Let u = 2^-53, E the product of the largest components of the N - 1 edges. Each edge has
/// a relative error of u in each component. For N = 4 a component of the normal is the sum of 6 products, each with a
/// relative error below 8 u, so its error is below 48 u E, and its size below 6 E. The scalar product with d, rounded
/// as well, adds 5 u: 4 (48 + 6 * 5) u E max |d| = 312 u E max |d|. N = 3: 3 (2 * 5 + 2 * 4) = 54; N = 2: 2 (1 + 3)
/// = 8. The factors below include second-order terms.
template <int N>
SimplexPlane<N> plane_of(const CornersN<N>& corners, bool is_filtered) noexcept {
  constexpr std::array<double, 5> kFactor = {0.0, 0.0, 16.0, 96.0, 512.0};
  SimplexPlane<N> plane;
  plane.normal = normal_of<N>(corners);
  double product = 1.0;
  for (int i = 1; i < N; ++i) product *= largest_of<N>(minus(corners[i], corners[0]));
  plane.bound = is_filtered ? kFactor[N] * kRounding * product + kUnderflow : HUGE_VAL;
  return plane;
}

/// Simplices with their planes. Coordinates must be finite, and vertex numbers valid. The points and simplices must
/// outlive it.
template <int N>
class SimplexPlanes {
 public:
  using Simplex = std::array<Index, N>;

  SimplexPlanes(std::span<const PointN<N>> points, std::span<const Simplex> simplices, unsigned threads,
                const Progress& progress)
      : points_(points), simplices_(simplices), planes_(simplices.size()), flat_(simplices.size()) {
    double largest = 0.0;
    for (const PointN<N>& p : points) largest = std::max(largest, largest_of<N>(p));
    is_filtered_ = largest < kLargestFiltered;
    for_each_item(simplices.size(), threads, progress, [&](std::size_t s) { update(static_cast<Index>(s)); });
  }

  /// Call it for each simplex whose vertices, or their points, have changed. The largest coordinate must not grow.
  void update(Index s) {
    const CornersN<N> corners = this->corners(s);
    planes_[s] = plane_of<N>(corners, is_filtered_);
    flat_[s] = is_flat_simplex(simplices_[s], corners, planes_[s]) ? 1 : 0;
  }

  [[nodiscard]] std::size_t size() const noexcept { return simplices_.size(); }
  [[nodiscard]] const Simplex& simplex(Index s) const noexcept { return simplices_[s]; }
  [[nodiscard]] const PointN<N>& point(Index v) const noexcept { return points_[v]; }
  [[nodiscard]] std::size_t point_count() const noexcept { return points_.size(); }
  [[nodiscard]] const SimplexPlane<N>& plane(Index s) const noexcept { return planes_[s]; }
  [[nodiscard]] bool is_flat(Index s) const noexcept { return flat_[s] != 0; }
  /// Whether floating-point numbers decide any sign.
  [[nodiscard]] bool is_filtered() const noexcept { return is_filtered_; }
  [[nodiscard]] CornersN<N> corners(Index s) const noexcept {
    CornersN<N> result;
    for (int i = 0; i < N; ++i) result[i] = points_[simplices_[s][i]];
    return result;
  }

 private:
  static bool is_flat_simplex(const Simplex& simplex, const CornersN<N>& corners, const SimplexPlane<N>& plane) {
    if (plane.side_of_vector(unit_towards(plane.normal)) > 0) return false;
    for (int i = 0; i < N; ++i)
      for (int j = i + 1; j < N; ++j)
        if (simplex[i] == simplex[j]) return true;
    std::array<PointRef, N> refs;
    for (int i = 0; i < N; ++i) refs[i] = corners[i].data();
    return are_dependent(N, refs);
  }
  /// The unit vector of the axis along which the normal is longest.
  static PointN<N> unit_towards(const PointN<N>& normal) noexcept {
    PointN<N> result{};
    int longest = 0;
    for (int a = 1; a < N; ++a)
      if (std::abs(normal[a]) > std::abs(normal[longest])) longest = a;
    result[longest] = normal[longest] < 0.0 ? -1.0 : 1.0;
    return result;
  }

  std::span<const PointN<N>> points_;
  std::span<const Simplex> simplices_;
  std::vector<SimplexPlane<N>> planes_;
  std::vector<std::uint8_t> flat_;
  bool is_filtered_ = true;
};

}  // namespace tegl::detail
