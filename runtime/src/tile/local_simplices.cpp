// SPDX-License-Identifier: BSD-3-Clause
//
// Looks up local vertices in registers if these are large enough for the numbers of a tile (see local_simplices.hpp).
// Highway's foreach_target compiles this file once per instruction set.
#include "tile/local_simplices.hpp"

#include <algorithm>

#include "builder4.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tile/local_simplices.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Simplex = std::array<Index, 4>;

/// Without vector instructions.
HWY_INLINE void write_plain(const LocalSimplices& simplices, Simplex* out) {
  Index ids[256];  // by local vertex
  std::copy_n(simplices.of_edges, 32, ids);
  if (simplices.of_cubes != nullptr) std::copy_n(simplices.of_cubes, 32, ids + 32);
  for (unsigned v = 64; v < 256; ++v) ids[v] = simplices.own + (v - 64);
  const std::uint8_t* local = simplices.local;
  const unsigned last = simplices.flip ? 2 : 3;
  for (std::uint32_t q = 0; q < simplices.count; ++q, ++out, local += 4) {
    (*out)[0] = ids[local[0]];
    (*out)[1] = ids[local[1]];
    (*out)[5 - last] = ids[local[2]];
    (*out)[last] = ids[local[3]];
  }
}

#if HWY_TARGET <= HWY_AVX3

template <bool kHasCubes>
HWY_INLINE void write_by_registers(const LocalSimplices& simplices, Simplex* out) {
  const __m512i edges[2] = {_mm512_loadu_si512(simplices.of_edges), _mm512_loadu_si512(simplices.of_edges + 16)};
  __m512i cubes[2] = {_mm512_setzero_si512(), _mm512_setzero_si512()};
  if constexpr (kHasCubes)
    for (unsigned i = 0; i < 2; ++i) cubes[i] = _mm512_loadu_si512(simplices.of_cubes + 16 * i);
  const __m512i after_own = _mm512_set1_epi32(static_cast<int>(simplices.own - 64));
  const __m512i first_own = _mm512_set1_epi32(64);
  const __m128i order = simplices.flip ? _mm_setr_epi8(0, 1, 3, 2, 4, 5, 7, 6, 8, 9, 11, 10, 12, 13, 15, 14)
                                       : _mm_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const auto numbers_of = [&](__m128i bytes) HWY_ATTR {
    const __m512i local = _mm512_cvtepu8_epi32(_mm_shuffle_epi8(bytes, order));
    __m512i numbers = _mm512_permutex2var_epi32(edges[0], local, edges[1]);
    if constexpr (kHasCubes)
      numbers = _mm512_mask_mov_epi32(numbers, _mm512_test_epi32_mask(local, _mm512_set1_epi32(32)),
                                      _mm512_permutex2var_epi32(cubes[0], local, cubes[1]));
    return _mm512_mask_add_epi32(numbers, _mm512_cmpge_epu32_mask(local, first_own), local, after_own);
  };
  const auto write_four = [&](std::uint32_t first) HWY_ATTR {
    const auto* const local = reinterpret_cast<const __m128i*>(simplices.local + 4 * std::size_t{first});
    _mm512_storeu_si512(out + first, numbers_of(_mm_loadu_si128(local)));
  };
  if (simplices.count < 4) {
    const auto all = static_cast<__mmask16>((1u << (4 * simplices.count)) - 1);
    return _mm512_mask_storeu_epi32(out, all, numbers_of(_mm_maskz_loadu_epi8(all, simplices.local)));
  }
  // The last four are written whatever their number: twice in part, which costs less than a mask.
  for (std::uint32_t first = 0; first + 4 < simplices.count; first += 4) write_four(first);
  write_four(simplices.count - 4);
}

#endif

void write_local(const LocalSimplices& simplices, Simplex* out) {
#if HWY_TARGET <= HWY_AVX3
  if (simplices.of_cubes == nullptr) return write_by_registers<false>(simplices, out);
  return write_by_registers<true>(simplices, out);
#else
  write_plain(simplices, out);
#endif
}

/// Orders of the bytes of four tetrahedra: as they are, and with the last two vertices exchanged.
alignas(16) constexpr std::uint8_t kOrders[2][16] = {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
                                                     {0, 1, 3, 2, 4, 5, 7, 6, 8, 9, 11, 10, 12, 13, 15, 14}};

void map_local(const std::uint8_t* from, std::size_t count, const std::uint64_t* to, bool swap, std::uint8_t* out) {
#if HWY_TARGET == HWY_SCALAR || __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  builders::ResolvedTesseract::map_tetrahedra(from, count, to, swap, out);
#else
  const hn::CappedTag<std::uint8_t, 64> d;  // the 16 entries of each half of `to` are in every block of 16 lanes
  const auto order = hn::LoadDup128(d, kOrders[swap ? 1 : 0]);
  // Not loaded at once: the words have just been written.
  const hn::Repartition<std::uint64_t, decltype(d)> words;
  const auto entries = [&](std::size_t i) HWY_ATTR {
    return hn::BitCast(d, hn::InterleaveLower(words, hn::Set(words, to[i]), hn::Set(words, to[i + 1])));
  };
  const auto lower = entries(0);
  const auto upper = entries(2);
  const auto last_of_lower = hn::Set(d, 15);
  constexpr std::size_t kLanes = hn::MaxLanes(d);
  // 16 at once: most regions have no more
  for (std::size_t q = 0; q < count; q += kMoreSimplices + 1)
    for (std::size_t i = q; i < q + kMoreSimplices + 1; i += kLanes / 4) {
      const auto local = hn::TableLookupBytes(hn::LoadU(d, from + 4 * i), order);
      const auto in_half = hn::And(local, last_of_lower);
      const auto mapped = hn::IfThenElse(hn::Gt(local, last_of_lower), hn::TableLookupBytes(upper, in_half),
                                         hn::TableLookupBytes(lower, in_half));
      hn::StoreU(mapped, d, out + 4 * i);
    }
#endif
}

using builders::ResolvedCubes;

/// Maps the triangles' vertices and sets the apex.
std::uint32_t* cone_local(const ResolvedCubes::Triangles* triangles, std::size_t count, unsigned apex,
                          std::uint32_t* out) {
#if HWY_TARGET == HWY_SCALAR || __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
  return builders::ResolvedTesseract::add_cones(triangles, count, apex, out);
#else
  const hn::CappedTag<std::uint32_t, kMoreSimplices + 1> words;
  const hn::Repartition<std::uint8_t, decltype(words)> bytes;
  constexpr std::uint32_t kLanes = hn::MaxLanes(words);
  const auto first = hn::Set(words, apex);
  for (const ResolvedCubes::Triangles* end = triangles + count; triangles != end; ++triangles) {
    const auto order = hn::LoadDup128(bytes, kOrders[ResolvedCubes::is_reversed(triangles->cube) ? 1 : 0]);
    const auto lifted = hn::LoadDup128(bytes, ResolvedCubes::lifted(triangles->cube).data());
    std::uint32_t t = 0;
    do {  // also if there are none, so that this is not predicted
      const auto local = hn::TableLookupBytes(hn::LoadU(bytes, triangles->words + 4 * std::size_t{t}), order);
      hn::StoreU(hn::Or(hn::BitCast(words, hn::TableLookupBytesOr0(lifted, local)), first), words, out + t);
      t += kLanes;
    } while (t < triangles->count);
    out += triangles->count;
  }
  return out;
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(write_local);

void write_numbers(const LocalSimplices& simplices, std::array<Index, 4>* out) noexcept {
  HWY_DYNAMIC_DISPATCH(write_local)(simplices, out);
}

HWY_EXPORT(map_local);

void map_simplices(const std::uint8_t* from, std::size_t count, const std::uint64_t* to, bool swap,
                   std::uint8_t* out) noexcept {
  HWY_DYNAMIC_DISPATCH(map_local)(from, count, to, swap, out);
}

HWY_EXPORT(cone_local);

std::uint32_t* add_cones(const builders::ResolvedCubes::Triangles* triangles, std::size_t count, unsigned apex,
                         std::uint32_t* out) noexcept {
  return HWY_DYNAMIC_DISPATCH(cone_local)(triangles, count, apex, out);
}

SimplexFunctions simplex_functions() noexcept {
  // Before the processor is known, the functions would be those that find it.
  if (hwy::ChosenTarget& target = hwy::GetChosenTarget(); !target.IsInitialized())
    target.Update(hwy::SupportedTargets());
  return {&HWY_DYNAMIC_DISPATCH(map_local), &HWY_DYNAMIC_DISPATCH(cone_local)};
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
