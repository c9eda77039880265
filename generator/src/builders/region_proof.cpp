// SPDX-License-Identifier: BSD-3-Clause
//
// Volumes of all tetrahedra of corners, and from these the signs for points on edges and for means.
#include "builders/region_proof.hpp"

#include <bit>

#include "tegl/tile/corners.hpp"

namespace tegl::gen {

namespace {

constexpr std::uint8_t kPositive = 1, kNegative = 2;

/// The ends of a point: one corner twice, or the two ends of an edge.
std::array<unsigned, 2> range_of(unsigned point) {
  if (point < 8) return {point, point};
  const unsigned e = point - 8, base = detail::edge_base(3, e);
  return {base, base | 1u << e / 4};
}

/// Six times the volume of a tetrahedron of corners.
int volume_of_corners(unsigned a, unsigned b, unsigned c, unsigned d) {
  std::array<std::array<int, 3>, 3> m{};
  const std::array<unsigned, 3> others = {b, c, d};
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t axis = 0; axis < 3; ++axis)
      m[row][axis] = static_cast<int>(others[row] >> axis & 1u) - static_cast<int>(a >> axis & 1u);
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

std::uint8_t signs_of_points(unsigned a, unsigned b, unsigned c, unsigned d) {
  if (a == b || a == c || a == d || b == c || b == d || c == d) return 0;
  const std::array<std::array<unsigned, 2>, 4> ends = {range_of(a), range_of(b), range_of(c), range_of(d)};
  unsigned signs = 0;
  for (unsigned i = 0; i < 16; ++i) {
    const int volume =
        volume_of_corners(ends[0][i & 1u], ends[1][i >> 1 & 1u], ends[2][i >> 2 & 1u], ends[3][i >> 3]);
    signs |= volume > 0 ? kPositive : volume < 0 ? kNegative : 0u;
  }
  return static_cast<std::uint8_t>(signs);
}

unsigned lowest(RegionProof::Points points) { return static_cast<unsigned>(std::countr_zero(points)); }

}  // namespace

RegionProof::RegionProof() : signs_(index(kPoints - 1, kPoints - 1, kPoints - 1, kPoints - 1) + 1) {
  for (unsigned a = 0; a < kPoints; ++a)
    for (unsigned b = 0; b < kPoints; ++b)
      for (unsigned c = 0; c < kPoints; ++c)
        for (unsigned d = 0; d < kPoints; ++d) signs_[index(a, b, c, d)] = signs_of_points(a, b, c, d);
}

RegionProof::Sign RegionProof::sign(Points a, Points b, Points c, Points d) const {
  unsigned signs = 0;
  for (Points i = a; i != 0; i &= i - 1)
    for (Points j = b; j != 0; j &= j - 1)
      for (Points k = c; k != 0; k &= k - 1)
        for (Points l = d; l != 0; l &= l - 1) signs |= signs_[index(lowest(i), lowest(j), lowest(k), lowest(l))];
  return static_cast<Sign>(signs);
}

}  // namespace tegl::gen
