// SPDX-License-Identifier: BSD-3-Clause
//
// Tests on bits of corners: which are above and which below each hyperplane.
#include "regions/separating_planes.hpp"

#include <algorithm>
#include <bit>
#include <memory>

#include "regions/shape_volumes.hpp"
#include "tegl/generated/cells.hpp"

namespace tegl::detail {

namespace {

using Vector = std::array<int, 4>;

/// A vector at right angles to three others; 0 if they are linearly dependent.
Vector normal_of(const std::array<Vector, 3>& d) noexcept {
  Vector normal;
  for (unsigned k = 0; k < 4; ++k) {
    std::array<std::array<int, 3>, 4> rows{};  // row 0 is the origin
    for (unsigned i = 0; i < 3; ++i)
      for (unsigned a = 0; a < 3; ++a) rows[i + 1][a] = d[i][a < k ? a : a + 1];
    normal[k] = six_volumes(rows) * (k % 2 == 0 ? 1 : -1);
  }
  return normal;
}

unsigned corners_of(const SeparatingPlanes::Tetrahedron& t, unsigned vertices) noexcept {
  unsigned corners = 0;
  for (unsigned i = 0; i < 4; ++i)
    if ((vertices >> i & 1u) != 0) corners |= t[i];
  return corners;
}

}  // namespace

SeparatingPlanes::SeparatingPlanes(const tables::CellTable& table) {
  const unsigned count = table.corner_count;
  const auto between = [&](unsigned from, unsigned to) {
    Vector d;
    for (unsigned a = 0; a < 4; ++a) d[a] = table.corners[4 * to + a] - table.corners[4 * from + a];
    return d;
  };
  for (unsigned chosen = 0; chosen < 1u << count; ++chosen) {
    if (std::popcount(chosen) != 4) continue;
    const auto first = static_cast<unsigned>(std::countr_zero(chosen));
    std::array<Vector, 3> d;
    unsigned i = 0;
    for (unsigned rest = chosen & (chosen - 1); rest != 0; rest &= rest - 1)
      d[i++] = between(first, static_cast<unsigned>(std::countr_zero(rest)));
    const Vector normal = normal_of(d);
    if (normal == Vector{}) continue;
    std::array<std::uint16_t, 2> sides{};
    for (unsigned v = 0; v < count; ++v) {
      const Vector at = between(first, v);
      int height = 0;
      for (unsigned a = 0; a < 4; ++a) height += normal[a] * at[a];
      if (height != 0) sides[height > 0 ? 0 : 1] |= static_cast<std::uint16_t>(1u << v);
    }
    std::sort(sides.begin(), sides.end());
    planes_.push_back(sides);
  }
  std::sort(planes_.begin(), planes_.end());
  planes_.erase(std::unique(planes_.begin(), planes_.end()), planes_.end());
}

const SeparatingPlanes& SeparatingPlanes::of(tables::CellShape shape) {
  static const auto kPlanes = [] {
    std::array<std::unique_ptr<const SeparatingPlanes>, tables::kCellShapes> all;
    for (unsigned s = 0; s < tables::kCellShapes; ++s) {
      const auto& table = tables::cell_table(static_cast<tables::CellShape>(s), Triangulation::barycentric);
      if (table.dim == 4) all[s] = std::make_unique<const SeparatingPlanes>(table);
    }
    return all;
  }();
  return *kPlanes[static_cast<std::size_t>(shape)];
}

bool SeparatingPlanes::are_apart(unsigned p, unsigned q) const noexcept {
  return std::any_of(planes_.begin(), planes_.end(), [&](const auto& plane) {
    const auto& [above, below] = plane;
    return ((p | q) & (above | below)) != 0 &&
           (((p & above) == 0 && (q & below) == 0) || ((p & below) == 0 && (q & above) == 0));
  });
}

bool SeparatingPlanes::are_divided(std::span<const Tetrahedron> a, std::span<const Tetrahedron> b) const noexcept {
  const auto is_on_side = [](std::span<const Tetrahedron> of, unsigned side, unsigned other, bool strictly) {
    return std::all_of(of.begin(), of.end(), [&](const Tetrahedron& t) {
      return std::all_of(t.begin(), t.end(),
                         [&](unsigned ends) { return (ends & other) == 0 && (!strictly || (ends & side) != 0); });
    });
  };
  return std::any_of(planes_.begin(), planes_.end(), [&](const auto& plane) {
    const auto& [above, below] = plane;
    return (is_on_side(a, above, below, true) && is_on_side(b, below, above, false)) ||
           (is_on_side(a, below, above, true) && is_on_side(b, above, below, false));
  });
}

bool SeparatingPlanes::faces_may_meet(const Tetrahedron& a, const Tetrahedron& b) const noexcept {
  for (unsigned p = 1; p < 16; ++p)
    for (unsigned q = 1; q < 16; ++q)
      if (std::popcount(p) + std::popcount(q) <= 6 && !are_apart(corners_of(a, p), corners_of(b, q))) return true;
  return false;
}

bool SeparatingPlanes::may_meet(std::span<const Tetrahedron> a, std::span<const Tetrahedron> b) const noexcept {
  if (are_divided(a, b) || are_divided(b, a)) return false;
  for (const Tetrahedron& t : a)
    for (const Tetrahedron& u : b)
      if (faces_may_meet(t, u)) return true;
  return false;
}

}  // namespace tegl::detail
