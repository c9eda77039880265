// SPDX-License-Identifier: BSD-3-Clause
//
// Volumes of all tetrahedra of corners, and from these the signs for points on edges and for means.
#include "embedding/region_proof.hpp"

#include <bit>

#include "base/determinant.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::gen {

namespace {

constexpr std::uint8_t kPositive = 1, kNegative = 2;

constexpr std::uint8_t kNotComputed = 0xff;

unsigned lowest(RegionProof::Points points) { return static_cast<unsigned>(std::countr_zero(points)); }

}  // namespace

RegionProof::RegionProof() : signs_(index(kPoints - 1, kPoints - 1, kPoints - 1, kPoints - 1) + 1, kNotComputed) {
  const auto corner = [](unsigned v) {
    return Point{static_cast<int>(2 * (v & 1u)), static_cast<int>(2 * (v >> 1 & 1u)), static_cast<int>(2 * (v >> 2))};
  };
  for (unsigned v = 0; v < 8; ++v) ends_[v] = {corner(v), corner(v)};
  for (unsigned e = 0; e < 12; ++e) {
    const unsigned base = detail::edge_base(3, e);
    ends_[8 + e] = {corner(base), corner(base | 1u << e / 4)};
  }
  for (unsigned i = 0; i < 27; ++i)
    ends_[kFirstRay + i] = {Point{1, 1, 1},
                            Point{static_cast<int>(i % 3), static_cast<int>(i / 3 % 3), static_cast<int>(i / 9)}};
}

RegionProof::Points RegionProof::on_ray(unsigned corners) {
  unsigned all = 7, any = 0;  // axes along which all corners, and any corner, are at 1
  for (; corners != 0; corners &= corners - 1) all &= lowest(corners), any |= lowest(corners);
  const auto digit = [&](unsigned axis) { return (all >> axis & 1u) + (any >> axis & 1u); };
  return Points{1} << (kFirstRay + digit(0) + 3 * digit(1) + 9 * digit(2));
}

std::uint8_t RegionProof::signs_of(unsigned a, unsigned b, unsigned c, unsigned d) const {
  std::uint8_t& known = signs_[index(a, b, c, d)];
  if (known != kNotComputed) return known;
  unsigned signs = 0;
  const bool has_equal = a == b || a == c || a == d || b == c || b == d || c == d;
  for (unsigned i = 0; i < 16 && !has_equal; ++i) {
    const int sign = six_volumes(ends_[a][i & 1u], ends_[b][i >> 1 & 1u], ends_[c][i >> 2 & 1u], ends_[d][i >> 3]);
    signs |= sign > 0 ? kPositive : sign < 0 ? kNegative : 0u;
  }
  return known = static_cast<std::uint8_t>(signs);
}

RegionProof::Sign RegionProof::sign(Points a, Points b, Points c, Points d) const {
  unsigned signs = 0;
  for (Points i = a; i != 0; i &= i - 1)
    for (Points j = b; j != 0; j &= j - 1)
      for (Points k = c; k != 0; k &= k - 1)
        for (Points l = d; l != 0; l &= l - 1) signs |= signs_of(lowest(i), lowest(j), lowest(k), lowest(l));
  return static_cast<Sign>(signs);
}

}  // namespace tegl::gen
