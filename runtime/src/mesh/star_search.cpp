// SPDX-License-Identifier: BSD-3-Clause
//
// Searches through stars of at most 64 tetrahedra, whose neighbours in the star are words of 64 bits. Highway's
// foreach_target compiles this file once per instruction set.
#include "mesh/star_search.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mesh/star_search.cpp"
// This include must precede Highway's own headers.
#include "base/dispatch.hpp"
#include "base/star_neighbours.hpp"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__

/// Whether the tetrahedra are connected; beside[i]: the neighbours of the i-th.
HWY_INLINE bool are_connected(const std::uint64_t* beside, std::size_t count, std::uint64_t reached) {
  const std::uint64_t all = ~std::uint64_t{0} >> (64 - count);
  for (std::uint64_t before = 0; reached != before && reached != all;) {
    before = reached;
    for (std::size_t i = count; i-- > 0;) reached |= beside[i] & (std::uint64_t{0} - (reached >> i & 1));
    if (reached == all) return true;
    for (std::size_t i = 0; i < count; ++i) reached |= beside[i] & (std::uint64_t{0} - (reached >> i & 1));
  }
  return reached == all;
}

HWY_INLINE bool is_found(const Index* rows, const IncidenceData<4>& incidence, Index v) {
  const hn::CappedTag<std::uint32_t, 16> d;
  const hn::FixedTag<std::uint32_t, 4> d4;
  const std::size_t lanes = hn::Lanes(d);
  const std::span<const Index> star = incidence.stars.of(v);
  const std::size_t count = star.size();
  alignas(64) std::array<std::uint32_t, 64 + 16> numbers;
  for (std::size_t i = 0; i < count; ++i) numbers[i] = star[i];
  for (std::size_t i = count; i < count + lanes; ++i) numbers[i] = kSeveralSimplices;
  std::array<std::uint64_t, 64> beside;
  const auto centre = hn::Set(d4, v), none = hn::Set(d4, kNoSimplex), several = hn::Set(d4, kSeveralSimplices);
  std::size_t border = 0;
  auto in_several = hn::MaskFromVec(hn::Zero(d4));
  std::uint64_t reached = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const Index* const across = incidence.across[star[i]].data();
    const auto others = hn::LoadU(d4, across);
    const auto is_none = hn::Eq(others, none);
    in_several = hn::Or(in_several, hn::Eq(others, several));
    border += hn::CountTrue(d4, hn::AndNot(hn::Eq(hn::LoadU(d4, rows + std::size_t{star[i]} * 4), centre), is_none));
    // A tetrahedron across the triangle without v is not in the star, unless it has the same four vertices.
    const auto a = hn::Set(d, across[0]), b = hn::Set(d, across[1]), c = hn::Set(d, across[2]),
               e = hn::Set(d, across[3]);
    std::uint8_t bits[16] = {};
    for (std::size_t j = 0; j < count; j += lanes) {
      const auto here = hn::LoadU(d, numbers.data() + j);
      const auto is_beside = hn::Or(hn::Or(hn::Eq(here, a), hn::Eq(here, b)), hn::Or(hn::Eq(here, c), hn::Eq(here, e)));
      if (lanes >= 8) {
        hn::StoreMaskBits(d, is_beside, bits + j / 8);
      } else {
        std::uint8_t four[8] = {};
        hn::StoreMaskBits(d, is_beside, four);
        bits[j / 8] = static_cast<std::uint8_t>(bits[j / 8] | four[0] << j % 8);
      }
    }
    std::uint64_t word;
    std::memcpy(&word, bits, sizeof word);
    beside[i] = word;
    reached |= word & (std::uint64_t{0} - (reached >> i & 1));
  }
  if (!hn::AllFalse(d4, in_several)) return false;
  const std::size_t edges = (3 * count + border) / 2;
  return incidence.edges_of(v) + count == edges + (border == 0 ? 2 : 1) &&
         are_connected(beside.data(), count, reached & (~std::uint64_t{0} >> (64 - count)));
}

static_assert(kReadable <= Stars::kPadding);

/// Whether the link is a sphere. False if there is doubt, as if two tetrahedra have numbers with equal lower bits.
HWY_INLINE bool is_surely_sphere(const IncidenceData<4>& incidence, std::size_t v) {
  const std::span<const Index> star = incidence.stars.of(v);
  if (2 * (incidence.edges_of(static_cast<Index>(v)) - 2) != star.size()) return false;
  std::array<std::uint64_t, kMostInStar> beside;
  std::uint64_t reached = 1;
  const auto reach = [&](std::uint64_t group) { reached = (reached & group) != 0 ? reached | group : reached; };
  const bool is_closed =
      visit_neighbours({incidence.across.data(), nullptr}, static_cast<Index>(v), star.data(), star.size(),
                       [&](std::size_t i, Index, std::uint64_t first, std::uint64_t second) {
                         beside[i] = first | second | std::uint64_t{1} << i;
                         reach(beside[i]);
                       });
  if (!is_closed) return false;
  const std::uint64_t all = ~std::uint64_t{0} >> (64 - star.size());
  for (std::uint64_t before = 0; reached != all && reached != before;) {
    before = reached;
    for (std::size_t i = star.size(); i-- > 0;) reach(beside[i]);
    if (reached == all) break;
    for (std::size_t i = 0; i < star.size(); ++i) reach(beside[i]);
  }
  return reached == all;
}

void search_stars(const Index* rows, const IncidenceData<4>& incidence, std::size_t from,
                  std::span<std::uint8_t> found) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::size_t size = incidence.stars.of(from + i).size();
    const bool is_small = size > 0 && size <= kMostInStar;
    const bool is_good =
        is_small && (is_surely_sphere(incidence, from + i) || is_found(rows, incidence, static_cast<Index>(from + i)));
    found[i] = is_good ? 1 : 0;
  }
}

#else

void search_stars(const Index*, const IncidenceData<4>&, std::size_t, std::span<std::uint8_t> found) {
  for (std::uint8_t& star : found) star = 0;  // left to StarSearch
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(search_stars);
void find_spheres_and_discs(const Index* rows, const IncidenceData<4>& incidence, std::size_t from,
                            std::span<std::uint8_t> found) {
  HWY_DYNAMIC_DISPATCH(search_stars)(rows, incidence, from, found);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
