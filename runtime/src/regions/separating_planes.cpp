// SPDX-License-Identifier: BSD-3-Clause
//
// Tests on bits of corners: which are above and which below each hyperplane.
#include "regions/separating_planes.hpp"

#include <algorithm>
#include <bit>

namespace tegl::detail {

namespace {

unsigned corners_of(const SeparatingPlanes::Tetrahedron& t, unsigned vertices) noexcept {
  unsigned corners = 0;
  for (unsigned i = 0; i < 4; ++i)
    if ((vertices >> i & 1u) != 0) corners |= t[i];
  return corners;
}

}  // namespace

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
