// SPDX-License-Identifier: BSD-3-Clause
//
// Which tetrahedra of a star are neighbours across the triangles at its centre, as words of 64 bits. Files that Highway
// compiles once per instruction set include this after base/dispatch.hpp, so it is read once per instruction set.
//
// Tetrahedra are compared by the lower 16 bits of their numbers, twice as many at a time as by whole numbers. Numbers
// with equal lower bits would be taken for each other. That is found by counting: if each triangle at the centre is in
// two tetrahedra, each tetrahedron is found three times, once from each neighbour, and any mistake adds to that.
#if defined(TEGL_BASE_STAR_NEIGHBOURS) == defined(HWY_TARGET_TOGGLE)
#ifdef TEGL_BASE_STAR_NEIGHBOURS
#undef TEGL_BASE_STAR_NEIGHBOURS
#else
#define TEGL_BASE_STAR_NEIGHBOURS
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hwy/highway.h"
#include "tegl/incidence.hpp"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__

using StarNumbers = hwy::HWY_NAMESPACE::ScalableTag<std::uint16_t>;
inline constexpr std::size_t kMostInStar = 64;  ///< tetrahedra, the bits of a word
inline constexpr std::size_t kAhead = 40;       ///< tetrahedra further, in this star or the next ones, are requested
inline constexpr std::size_t kReadable = kMostInStar + kAhead;  ///< numbers from the first one of a star on

/// The lanes of a mask as bits.
template <class D>
HWY_INLINE std::uint64_t word_of(D d, hwy::HWY_NAMESPACE::Mask<D> mask) {
#if HWY_TARGET <= HWY_AVX3
  if constexpr (hwy::HWY_NAMESPACE::MaxLanes(D()) >= 8) return mask.raw;
  return mask.raw & ((1u << hwy::HWY_NAMESPACE::MaxLanes(D())) - 1);
#else
  std::uint64_t word = 0;
  hwy::HWY_NAMESPACE::StoreMaskBits(d, mask, reinterpret_cast<std::uint8_t*>(&word));
  return word;
#endif
}

/// Adds in the lanes of a mask.
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> add_where(D d, hwy::HWY_NAMESPACE::Mask<D> mask, hwy::HWY_NAMESPACE::Vec<D> sums,
                                                hwy::HWY_NAMESPACE::Vec<D> added) {
  static_cast<void>(d);
#if HWY_TARGET <= HWY_AVX3
  constexpr std::size_t kBytes = sizeof(hwy::HWY_NAMESPACE::TFromD<D>);
  if constexpr (kBytes == 2) return {_mm512_mask_add_epi16(sums.raw, mask.raw, sums.raw, added.raw)};
  if constexpr (kBytes == 4) return {_mm512_mask_add_epi32(sums.raw, mask.raw, sums.raw, added.raw)};
  if constexpr (kBytes == 8) return {_mm512_mask_add_epi64(sums.raw, mask.raw, sums.raw, added.raw)};
#else
  return hwy::HWY_NAMESPACE::Add(sums, hwy::HWY_NAMESPACE::IfThenElseZero(mask, added));
#endif
}

/// By tetrahedron: those across its triangles, by the place that a triangle lacks, and its vertices, or null.
struct LinkedTetrahedra {
  const std::array<Index, 4>* across;
  const std::array<Index, 4>* vertices;
};

/// See below; for at most kVectors registers of tetrahedra.
template <std::size_t kVectors, class Visit>
HWY_INLINE bool visit_neighbours_in(const LinkedTetrahedra& tetrahedra, Index centre, const Index* star,
                                    std::size_t count, const Visit& visit) {
  namespace hn = hwy::HWY_NAMESPACE;
  const StarNumbers d;
  const hn::Repartition<std::uint32_t, StarNumbers> d32;
  const hn::Half<StarNumbers> d_half;
  const hn::FixedTag<std::uint32_t, 4> d4;
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  hn::Vec<StarNumbers> numbers[kVectors], counts[kVectors];
  for (std::size_t j = 0; j < kVectors; ++j) {
    const Index* const from = star + j * kLanes;
    numbers[j] = hn::Combine(d, hn::TruncateTo(d_half, hn::LoadU(d32, from + kLanes / 2)),
                             hn::TruncateTo(d_half, hn::LoadU(d32, from)));
    counts[j] = hn::Zero(d);
  }
  const auto one = hn::Set(d, std::uint16_t{1});
  auto largest = hn::Zero(d4);
  const std::uint64_t all = ~std::uint64_t{0} >> (64 - count);
  for (std::size_t i = 0; i < count; ++i) {
    __builtin_prefetch(tetrahedra.across + star[i + kAhead]);
    const std::array<Index, 4>& others = tetrahedra.across[star[i]];
    auto counted = hn::LoadU(d4, others.data());
    if (tetrahedra.vertices != nullptr) {
      const auto vertices = hn::LoadU(d4, tetrahedra.vertices[star[i]].data());
      counted = hn::IfThenZeroElse(hn::Eq(vertices, hn::Set(d4, centre)), counted);
    }
    largest = hn::Max(largest, counted);
    hn::Vec<StarNumbers> other[4];
    for (std::size_t k = 0; k < 4; ++k) other[k] = hn::Set(d, static_cast<std::uint16_t>(others[k]));
    std::uint64_t first = 0, second = 0;
    for (std::size_t j = 0; j < kVectors; ++j) {
      hn::Mask<StarNumbers> is[4];
      for (std::size_t k = 0; k < 4; ++k) {
        is[k] = hn::Eq(numbers[j], other[k]);
        counts[j] = add_where(d, is[k], counts[j], one);
      }
      first |= word_of(d, hn::Or(is[0], is[1])) << (j * kLanes);
      second |= word_of(d, hn::Or(is[2], is[3])) << (j * kLanes);
    }
    visit(i, star[i], first & all, second & all);
  }
  bool is_exact = hn::AllTrue(d4, hn::Lt(largest, hn::Set(d4, kSeveralSimplices)));
  for (std::size_t j = 0; j < kVectors; ++j) {
    const std::size_t here = count > j * kLanes ? count - j * kLanes : 0;
    const auto is_wrong = hn::And(hn::FirstN(d, here), hn::Ne(counts[j], hn::Set(d, std::uint16_t{3})));
    is_exact = is_exact && hn::AllFalse(d, is_wrong);
  }
  return is_exact;
}

/// Calls visit(i, tetrahedron, first, second) for the tetrahedra of a star. `first`, `second`: bit k if the k-th of the
/// star is across the triangle that lacks the vertex at place 0 or 1, or at place 2 or 3. Returns whether this is true:
/// if not, a triangle at the centre is not in two tetrahedra, or tetrahedra were taken for each other, and the words
/// may be wrong; without vertices also if a triangle opposite to the centre is not in two. `star`: at least one and at
/// most kMostInStar tetrahedra; kReadable numbers can be read, also beyond the star.
template <class Visit>
HWY_INLINE bool visit_neighbours(const LinkedTetrahedra& tetrahedra, Index centre, const Index* star, std::size_t count,
                                 const Visit& visit) {
  constexpr std::size_t kLanes = hwy::HWY_NAMESPACE::MaxLanes(StarNumbers());
  if (count <= kLanes) return visit_neighbours_in<1>(tetrahedra, centre, star, count, visit);
  if constexpr (kLanes <= 16) {
    if (count <= 2 * kLanes) return visit_neighbours_in<2>(tetrahedra, centre, star, count, visit);
    if constexpr (kLanes == 8)
      if (count <= 4 * kLanes) return visit_neighbours_in<4>(tetrahedra, centre, star, count, visit);
  }
  return visit_neighbours_in<kMostInStar / kLanes>(tetrahedra, centre, star, count, visit);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#endif
