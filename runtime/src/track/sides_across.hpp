// SPDX-License-Identifier: BSD-3-Clause
//
// The lower and the upper link of a vertex of tetrahedra, connected across the triangles at the vertex: words of 64
// bits for sets of tetrahedra of a star, from neighbours that are known. This needs no numbers for the vertices of the
// link, and decides nearly all vertices of a contour.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tegl/contour.hpp"
#include "tegl/incidence.hpp"

namespace tegl::detail {

/// What a star has below and above its centre.
struct StarSides {
  bool are_connected = false;  ///< if not, nothing else is set
  Index below = 0;             ///< the last tetrahedron with a vertex below the centre
  std::int32_t growth = 0;     ///< tetrahedra that begin at the centre minus those that end there
};

/// By place in a tetrahedron: all bits if the triangle without it contains the centre of the star and a vertex above or
/// below the centre.
struct SideMasks {
  std::array<std::uint64_t, 4> above{}, below{};
};
/// By the place of the centre.
constexpr std::array<SideMasks, 4> make_side_masks() {
  std::array<SideMasks, 4> all{};
  for (unsigned at = 0; at < 4; ++at)
    for (unsigned k = 0; k < 4; ++k) {
      if (k == at) continue;
      all[at].above[k] = 3 - at > (k > at ? 1u : 0u) ? ~std::uint64_t{0} : 0;
      all[at].below[k] = at > (k < at ? 1u : 0u) ? ~std::uint64_t{0} : 0;
    }
  return all;
}
inline constexpr std::array<SideMasks, 4> kSideMasks = make_side_masks();

/// Each tetrahedron lists its vertices in ascending order. Use one object per thread; it takes a byte per tetrahedron.
class SidesAcross {
 public:
  using Simplex = std::array<Index, 4>;

  /// `across`: by tetrahedron and place, the tetrahedron across the triangle without the vertex at that place.
  SidesAcross(std::span<const Simplex> simplices, std::span<const Simplex> across)
      : simplices_(simplices.data()), across_(across.data()), places_(simplices.size()) {
    above_.fill(0);
    below_.fill(0);
  }

  /// If `are_connected`, then so are the vertices of the link above v by edges of the link among them, and those below
  /// v, and both exist. The converse need not hold: at edges whose tetrahedra are not connected across triangles, and
  /// if the star has more than 64 tetrahedra. `star`: the tetrahedra around v that repeat no vertex.
  [[nodiscard]] StarSides visit(Index v, std::span<const Index> star) {
    StarSides sides;
    if (star.size() > 64) return sides;
    for (std::size_t i = 0; i < star.size(); ++i) places_[star[i]] = static_cast<std::uint8_t>(i);
    const Simplex* const simplices = simplices_;
    const Simplex* const across = across_;
    const std::uint8_t* const places = places_.data();
    Set with_above = 0, with_below = 0;
    for (std::size_t i = 0; i < star.size(); ++i) {
      const Index s = star[i];
      const Simplex& simplex = simplices[s];
      const unsigned at = (simplex[1] <= v ? 1u : 0u) + (simplex[2] <= v ? 1u : 0u) + (simplex[3] <= v ? 1u : 0u);
      const SideMasks& masks = kSideMasks[at];
      Set above = 0, below = 0;
      for (unsigned k = 0; k < 4; ++k) {
        const Index t = across[s][k];
        // for none, the tetrahedron itself; the one opposite to v has a place in another star, and is masked
        const Set one = Set{1} << places[t < kSeveralSimplices ? t : s];
        above |= one & masks.above[k];
        below |= one & masks.below[k];
      }
      above_[i] = above;
      below_[i] = below;
      with_above |= Set{at < 3} << i;
      with_below |= Set{at > 0} << i;
      sides.growth += (at == 0 ? 1 : 0) - (at == 3 ? 1 : 0);
      sides.below = at > 0 ? s : sides.below;
    }
    sides.are_connected = with_above != 0 && with_below != 0 && reach_all(with_above, with_below);
    return sides;
  }

 private:
  using Set = std::uint64_t;  ///< of tetrahedra of the star

  /// Whether all of these tetrahedra are reached from the first one on each side. Both sides in one loop, whose steps
  /// wait for each other.
  [[nodiscard]] bool reach_all(Set with_above, Set with_below) const {
    Set reached_above = with_above & (~with_above + 1), open_above = reached_above;
    Set reached_below = with_below & (~with_below + 1), open_below = reached_below;
    while ((open_above | open_below) != 0) {
      const Set above = above_[static_cast<unsigned>(std::countr_zero(open_above))] & ~reached_above;
      const Set below = below_[static_cast<unsigned>(std::countr_zero(open_below))] & ~reached_below;
      open_above = (open_above & (open_above - 1)) | above;
      open_below = (open_below & (open_below - 1)) | below;
      reached_above |= above;
      reached_below |= below;
    }
    return reached_above == with_above && reached_below == with_below;
  }

  const Simplex* simplices_;
  const Simplex* across_;
  std::vector<std::uint8_t> places_;   ///< by tetrahedron: its number in the last star that had it
  std::array<Set, 65> above_, below_;  ///< by number: neighbours; none at 64, the first of an empty set
};

}  // namespace tegl::detail
