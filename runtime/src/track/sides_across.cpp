// SPDX-License-Identifier: BSD-3-Clause
//
// Lower and upper links by searches through sets of tetrahedra. Highway's foreach_target compiles this file once per
// instruction set.
#include "track/sides_across.hpp"

#include <array>
#include <bit>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "track/sides_across.cpp"
// This include must precede Highway's own headers.
#include "base/dispatch.hpp"
#include "base/star_neighbours.hpp"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__

static_assert(kReadable <= Stars::kPadding);

using Set = std::uint64_t;  ///< of tetrahedra of a star

/// By place in the star: a tetrahedron and its neighbours on one side of the centre; none if it has no vertex there.
using Groups = std::array<Set, kMostInStar>;

HWY_INLINE Set joined(Set reached, Set group) { return (reached & group) != 0 ? reached | group : reached; }

/// Whether all tetrahedra on each side are reached from one of them. Both sides in one loop, whose steps wait for each
/// other.
HWY_INLINE bool reach_all(const Groups& above, const Groups& below, std::size_t count, Set all_above, Set all_below) {
  Set reached_above = all_above & (~all_above + 1), reached_below = all_below & (~all_below + 1);
  const auto missing = [&] { return (reached_above ^ all_above) | (reached_below ^ all_below); };
  for (Set before = 0, now = missing(); now != 0 && now != before;) {
    before = now;
    for (std::size_t i = 0; i < count; ++i) {
      reached_above = joined(reached_above, above[i]);
      reached_below = joined(reached_below, below[i]);
    }
    if (missing() == 0) return true;
    for (std::size_t i = count; i-- > 0;) {
      reached_above = joined(reached_above, above[i]);
      reached_below = joined(reached_below, below[i]);
    }
    now = missing();
  }
  return missing() == 0;
}

HWY_INLINE StarSides sides_of(const RankedTetrahedra& tetrahedra, std::size_t v, Index rank) {
  StarSides sides;
  const std::span<const Index> star = tetrahedra.stars.of(v);
  if (star.empty() || star.size() > kMostInStar) return sides;
  const Index* const members = star.data();
  const std::array<Index, 4>* const ranks_of = tetrahedra.ranks;
  Groups above, below;
  Set all_above = 0, all_below = 0;
  std::int32_t growth = 0;
  const bool is_exact = visit_neighbours(
      {tetrahedra.across, ranks_of}, rank, members, star.size(), [&](std::size_t i, Index s, Set first, Set second) {
        __builtin_prefetch(ranks_of + members[i + kAhead]);
        const std::array<Index, 4>& ranks = ranks_of[s];
        const auto all_if = [](bool condition) { return Set{0} - (condition ? 1u : 0u); };
        // A triangle with the centre and a vertex above it lacks any other vertex, but not the only one above it.
        const Set is_above = all_if(ranks[3] > rank), are_above = all_if(ranks[2] > rank);
        const Set is_below = all_if(ranks[0] < rank), are_below = all_if(ranks[1] < rank);
        const Set own = Set{1} << i;
        above[i] = (is_above & (first | own)) | (are_above & second);
        below[i] = (is_below & (second | own)) | (are_below & first);
        all_above |= is_above & own;
        all_below |= is_below & own;
        growth += static_cast<std::int32_t>(is_below) - static_cast<std::int32_t>(is_above);
      });
  if (!is_exact || all_above == 0 || all_below == 0) return sides;
  sides.below = members[63 - std::countl_zero(all_below)];
  sides.growth = growth;
  sides.are_connected = reach_all(above, below, star.size(), all_above, all_below);
  return sides;
}

void find_in_stars(const RankedTetrahedra& tetrahedra, std::size_t from, std::span<const Index> ranks,
                   std::span<StarSides> found) {
  for (std::size_t i = 0; i < found.size(); ++i) found[i] = sides_of(tetrahedra, from + i, ranks[i]);
}

#else

void find_in_stars(const RankedTetrahedra&, std::size_t, std::span<const Index>, std::span<StarSides> found) {
  for (StarSides& sides : found) sides = {};  // left to the caller
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(find_in_stars);
void find_sides(const RankedTetrahedra& tetrahedra, std::size_t from, std::span<const Index> ranks,
                std::span<StarSides> found) {
  HWY_DYNAMIC_DISPATCH(find_in_stars)(tetrahedra, from, ranks, found);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
