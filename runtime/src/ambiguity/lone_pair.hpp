// SPDX-License-Identifier: BSD-3-Clause
//
// Tunnels in cross-polytopes, the octahedron and the 16-cell: their faces are simplices, which are never ambiguous, but
// two opposite corners may be unlike all others. The contour in the boundary is then two spheres (in octahedra: loops),
// each around one of the two corners, and a tunnel may connect these.
#pragma once

#include <bit>
#include <optional>
#include <span>

#include "ambiguity/face_estimator.hpp"

namespace tegl::detail {

/// Two opposite corners, 2 pair and 2 pair + 1, of a cross-polytope.
struct LonePair {
  unsigned pair;
  bool is_high;
};

/// Which pairs are high, as bits; none if the corners of a pair differ, as a single sphere is the contour then.
[[nodiscard]] constexpr std::optional<unsigned> high_pairs(unsigned signature, unsigned pairs) noexcept {
  unsigned high = 0;
  for (unsigned i = 0; i < pairs; ++i) {
    const unsigned bits = signature >> 2 * i & 3u;
    if (bits == 1 || bits == 2) return std::nullopt;
    high |= (bits & 1u) << i;
  }
  return high;
}

/// The pair that is unlike all others.
[[nodiscard]] constexpr std::optional<LonePair> lone_pair(unsigned signature, unsigned pairs) noexcept {
  const std::optional<unsigned> high = high_pairs(signature, pairs);
  if (!high) return std::nullopt;
  const unsigned low = ~*high & ((1u << pairs) - 1);
  if (std::has_single_bit(*high)) return LonePair{static_cast<unsigned>(std::countr_zero(*high)), true};
  if (std::has_single_bit(low)) return LonePair{static_cast<unsigned>(std::countr_zero(low)), false};
  return std::nullopt;
}

/// Whether a tunnel connects the corners of a lone pair: if the centre, the mean of all corners, is like them.
[[nodiscard]] inline bool has_tunnel_between(const LonePair& pair, std::span<const double> values,
                                             double isovalue) noexcept {
  return is_mean_high(values, isovalue) == pair.is_high;
}

}  // namespace tegl::detail
