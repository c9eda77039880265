// SPDX-License-Identifier: BSD-3-Clause
//
// Proves that tetrahedra in a cube have positive volume, wherever the contour meets the cube's edges.
//
// The volume of a tetrahedron is linear in each of its vertices. A vertex on an edge is a combination of the edge's
// ends, a vertex on a ray one of the ray's ends, and a mean one of its points, all with positive weights. If two
// vertices have the same point in common, the volume with both at that point is zero. So the volume is positive for all
// positions if it is not negative with each vertex at any of its ends, and positive for one choice of the ends.
// Tetrahedra that are all positive and that have the boundary of a region as their boundary, counted with orientations,
// cover each point of the region exactly once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tegl::gen {

/// Signs of volumes of tetrahedra in the unit cube, for all positions. Not thread-safe: const functions, too, store the
/// signs that they compute.
class RegionProof {
 public:
  /// A set of points: bit v for a corner, bit 8 + e for the point on an edge, kCentre for the cube's centre, and one
  /// bit for the point on each ray from the centre to the centre of a square, of an edge, or to a corner. Several
  /// points: a mean of them, with any positive weights.
  using Points = std::uint64_t;
  static constexpr unsigned kFirstRay = 20;  ///< by the sum of (digit + 1) 3^axis of its end (-1, 0, 1)
  static constexpr unsigned kCentre = kFirstRay + 13;
  static constexpr unsigned kPoints = kFirstRay + 27;
  /// The corners and edges.
  static constexpr Points kShared = (Points{1} << kFirstRay) - 1;

  RegionProof();

  /// The point on the ray from the centre to the mean of some corners: those of a square, of an edge, or one.
  [[nodiscard]] static Points on_ray(unsigned corners);

  enum class Sign : std::uint8_t { zero, positive, negative, mixed };
  /// Sign of the volume of (a, b, c, d). positive, negative: for all positions and all weights of means.
  [[nodiscard]] Sign sign(Points a, Points b, Points c, Points d) const;

 private:
  static constexpr std::size_t index(unsigned a, unsigned b, unsigned c, unsigned d) {
    return ((std::size_t{a} * kPoints + b) * kPoints + c) * kPoints + d;
  }

  [[nodiscard]] std::uint8_t signs_of(unsigned a, unsigned b, unsigned c, unsigned d) const;

  using Point = std::array<int, 3>;
  std::array<std::array<Point, 2>, kPoints> ends_{};  ///< of each point's range, in halves of an edge
  /// By points: bit 0, 1: whether the volume is positive, negative for some positions. kNotComputed: not known yet.
  mutable std::vector<std::uint8_t> signs_;
};

}  // namespace tegl::gen
