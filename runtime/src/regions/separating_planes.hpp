// SPDX-License-Identifier: BSD-3-Clause
//
// Whether tetrahedra in a 4D cell intersect for some positions of their vertices, which are points on the cell's edges.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "tegl/generated/cells.hpp"

namespace tegl::detail {

/// The hyperplanes that corners of a 4D shape span.
class SeparatingPlanes {
 public:
  /// A tetrahedron: for each vertex the ends of its edge, as bits of corners.
  using Tetrahedron = std::array<std::uint16_t, 4>;

  explicit SeparatingPlanes(tables::CellShape shape)
      : planes_(tables::shape_table(shape).planes, tables::shape_table(shape).plane_count) {}

  /// Whether some tetrahedron of one set intersects one of the other set for some positions of the vertices on their
  /// edges. No vertex is in both sets. Exact: embedding.md has the proof.
  [[nodiscard]] bool may_meet(std::span<const Tetrahedron> a, std::span<const Tetrahedron> b) const noexcept;

 private:
  /// Whether the relative interiors of the hulls of two sets of corners are disjoint.
  [[nodiscard]] bool are_apart(unsigned p, unsigned q) const noexcept;
  /// Whether one hyperplane has all points of `a` strictly on one side, for all positions, and `b` on the other side.
  [[nodiscard]] bool are_divided(std::span<const Tetrahedron> a, std::span<const Tetrahedron> b) const noexcept;
  [[nodiscard]] bool faces_may_meet(const Tetrahedron& a, const Tetrahedron& b) const noexcept;

  std::span<const tables::PlaneSides> planes_;
};

}  // namespace tegl::detail
