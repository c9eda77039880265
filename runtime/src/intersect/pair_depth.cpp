// SPDX-License-Identifier: BSD-3-Clause
//
// The differences a - b of points of two simplices A and B form a convex polytope. The depth is the distance of 0 from
// its boundary (S. Cameron, R. K. Culley, Determining the minimum translational distance between two convex polyhedra,
// 1986). Each of its facets is the difference of a face of A and a face of B, whose N - 1 edges give the normal.
//
// Each axis is scaled by a power of two, so that neither products nor differences overflow or underflow. The normals
// are covectors: their components are scaled by the inverse, and their products with points do not change.
#include "intersect/pair_depth.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace tegl::detail {

namespace {

/// Two simplices in scaled axes, relative to a corner of the first: all coordinates are at most 2.
template <int N>
class ScaledPair {
 public:
  ScaledPair(const CornersN<N>& a, const CornersN<N>& b) noexcept {
    for (int axis = 0; axis < N; ++axis) {
      double largest = 0.0, extent = 0.0;
      for (const auto* const corners : {&a, &b})
        for (const PointN<N>& p : *corners) largest = std::max(largest, std::abs(p[axis]));
      const double factor = largest > 0x1p+1000 ? 0.25 : 1.0;  // differences do not overflow
      const auto difference = [&](const PointN<N>& p) { return factor * p[axis] - factor * a[0][axis]; };
      for (const auto* const corners : {&a, &b})
        for (const PointN<N>& p : *corners) extent = std::max(extent, std::abs(difference(p)));
      const int exponent = extent > 0.0 ? std::ilogb(extent) : 0;
      exponents_[axis] = exponent + (factor < 1.0 ? 2 : 0);
      for (int i = 0; i < N; ++i) {
        a_[i][axis] = std::scalbn(difference(a[i]), -exponent);
        b_[i][axis] = std::scalbn(difference(b[i]), -exponent);
      }
    }
  }

  /// The smallest distance over the normals of all pairs of faces. Normals whose direction rounding errors could change
  /// by more than `most_error` are left out; infinite if these are all.
  [[nodiscard]] double depth(double most_error) const noexcept {
    constexpr unsigned kAll = (1u << N) - 1;
    double result = std::numeric_limits<double>::infinity();
    for (unsigned of_a = 1; of_a <= kAll; ++of_a)
      for (unsigned of_b = 1; of_b <= kAll; ++of_b) {
        if (std::popcount(of_a) + std::popcount(of_b) != N + 1) continue;
        // the normal of a whole simplex does not depend on the corner of the other
        if ((of_a == kAll && of_b != 1) || (of_b == kAll && of_a != 1)) continue;
        result = std::min(result, distance(of_a, of_b, most_error));
      }
    return result;
  }

 private:
  /// Appends the edges of a face from its first corner.
  static void add_edges(const CornersN<N>& corners, unsigned face, CornersN<N>& edges, int& count) noexcept {
    const int first = std::countr_zero(face);
    for (face &= face - 1; face != 0; face &= face - 1)
      edges[++count] = minus(corners[std::countr_zero(face)], corners[first]);
  }

  /// The distance along the normal of two faces at which the simplices are on different sides.
  [[nodiscard]] double distance(unsigned of_a, unsigned of_b, double most_error) const noexcept {
    // as in simplex_planes.hpp: factors of the errors of a normal, for coordinates of size 2
    constexpr std::array<double, 5> kFactor = {0.0, 0.0, 16.0, 96.0, 512.0};
    CornersN<N> edges{};  // the first is 0
    int count = 0;
    add_edges(a_, of_a, edges, count);
    add_edges(b_, of_b, edges, count);
    const PointN<N> normal = normal_of<N>(edges);
    double product = 1.0;
    for (int i = 1; i < N; ++i) product *= largest_of<N>(edges[i]);
    const double error = 4.0 * kFactor[N] * kRounding * product;
    const double size = largest_of<N>(normal);
    if (!(size > 0.0) || error > most_error * size) return std::numeric_limits<double>::infinity();
    double a_low = HUGE_VAL, a_high = -HUGE_VAL, b_low = HUGE_VAL, b_high = -HUGE_VAL;
    for (int i = 0; i < N; ++i) {
      const double in_a = dot(normal, a_[i]), in_b = dot(normal, b_[i]);
      a_low = std::min(a_low, in_a);
      a_high = std::max(a_high, in_a);
      b_low = std::min(b_low, in_b);
      b_high = std::max(b_high, in_b);
    }
    const double overlap = std::min(a_high - b_low, b_high - a_low);
    return overlap > error + 16.0 * N * kRounding * size ? unscaled(overlap, normal) : 0.0;
  }

  /// The quotient of a product with the normal and the normal's length, both without the scales.
  [[nodiscard]] double unscaled(double overlap, const PointN<N>& normal) const noexcept {
    int largest = std::numeric_limits<int>::min();
    for (int axis = 0; axis < N; ++axis)
      if (normal[axis] != 0.0) largest = std::max(largest, std::ilogb(normal[axis]) - exponents_[axis]);
    double square = 0.0;
    for (int axis = 0; axis < N; ++axis) {
      const double x = std::scalbn(normal[axis], -exponents_[axis] - largest);
      square += x * x;
    }
    return std::min(std::scalbn(overlap / std::sqrt(square), -largest), std::numeric_limits<double>::max());
  }

  CornersN<N> a_, b_;
  std::array<int, N> exponents_;  ///< a coordinate is the scaled one times 2^exponent
};

}  // namespace

template <int N>
double depth_of(const CornersN<N>& a, const CornersN<N>& b) noexcept {
  const ScaledPair<N> pair(a, b);
  double depth = pair.depth(0x1p-20);
  if (std::isinf(depth)) depth = pair.depth(HUGE_VAL);
  return std::isinf(depth) ? 0.0 : depth;
}

template double depth_of<2>(const CornersN<2>&, const CornersN<2>&) noexcept;
template double depth_of<3>(const CornersN<3>&, const CornersN<3>&) noexcept;
template double depth_of<4>(const CornersN<4>&, const CornersN<4>&) noexcept;

}  // namespace tegl::detail
