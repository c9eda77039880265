// SPDX-License-Identifier: BSD-3-Clause
//
// Proves that tetrahedra in a cube have positive volume, wherever the contour meets the cube's edges.
//
// The volume of a tetrahedron is linear in each of its vertices. A vertex on an edge is a combination of the edge's
// ends, and a mean one of its points, both with positive weights. If two vertices have the same point in common, the
// volume with both at that point is zero. So the volume is positive for all positions if it is not negative with each
// vertex at any of its ends, and positive for one choice of the ends. Tetrahedra that are all positive and that have
// the boundary of a region as their boundary, counted with orientations, cover each point of the region exactly once.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tegl::gen {

/// Signs of volumes of tetrahedra in the unit cube, for all positions.
class RegionProof {
 public:
  /// A set of points: bit v for a corner, bit 8 + e for the point on an edge. Several points: a mean of them, with any
  /// positive weights.
  using Points = std::uint32_t;
  static constexpr unsigned kPoints = 20;

  RegionProof();

  enum class Sign : std::uint8_t { zero, positive, negative, mixed };
  /// Sign of the volume of (a, b, c, d). positive, negative: for all positions and all weights of means.
  [[nodiscard]] Sign sign(Points a, Points b, Points c, Points d) const;

 private:
  static constexpr std::size_t index(unsigned a, unsigned b, unsigned c, unsigned d) {
    return ((std::size_t{a} * kPoints + b) * kPoints + c) * kPoints + d;
  }

  /// By points: bit 0, 1: whether the volume is positive, negative for some positions.
  std::vector<std::uint8_t> signs_;
};

}  // namespace tegl::gen
