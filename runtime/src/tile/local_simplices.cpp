// SPDX-License-Identifier: BSD-3-Clause
//
// Looks up local vertices in registers if these are large enough for all numbers of a tile (see local_simplices.hpp).
// Highway's foreach_target compiles this file once per instruction set.
#include "tile/local_simplices.hpp"

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
  const Index* const ids = simplices.ids;
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

/// For at most 64 * kBlocks vertices.
template <unsigned kBlocks>
HWY_INLINE void write_by_registers(const LocalSimplices& simplices, Simplex* out) {
  __m512i ids[4 * kBlocks];
  for (unsigned i = 0; i < 4 * kBlocks; ++i) ids[i] = _mm512_loadu_si512(simplices.ids + 16 * i);
  const __m128i order = simplices.flip ? _mm_setr_epi8(0, 1, 3, 2, 4, 5, 7, 6, 8, 9, 11, 10, 12, 13, 15, 14)
                                       : _mm_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  for (std::uint32_t q = 0; q < simplices.count; q += 4) {
    const std::uint32_t rest = simplices.count - q;
    const auto mask = static_cast<__mmask16>(rest >= 4 ? 0xffffu : (1u << (4 * rest)) - 1);
    const __m128i bytes = _mm_maskz_loadu_epi8(mask, simplices.local + 4 * std::size_t{q});
    const __m512i local = _mm512_cvtepu8_epi32(_mm_shuffle_epi8(bytes, order));
    const __mmask16 in_upper = _mm512_test_epi32_mask(local, _mm512_set1_epi32(32));
    __m512i numbers = _mm512_permutex2var_epi32(ids[0], local, ids[1]);
    numbers = _mm512_mask_mov_epi32(numbers, in_upper, _mm512_permutex2var_epi32(ids[2], local, ids[3]));
    if constexpr (kBlocks == 2) {
      __m512i behind = _mm512_permutex2var_epi32(ids[4], local, ids[5]);
      behind = _mm512_mask_mov_epi32(behind, in_upper, _mm512_permutex2var_epi32(ids[6], local, ids[7]));
      numbers = _mm512_mask_mov_epi32(numbers, _mm512_test_epi32_mask(local, _mm512_set1_epi32(64)), behind);
    }
    _mm512_mask_storeu_epi32(out + q, mask, numbers);
  }
}

#endif

void write_local(const LocalSimplices& simplices, Simplex* out) {
#if HWY_TARGET <= HWY_AVX3
  if (simplices.id_count <= 64) return write_by_registers<1>(simplices, out);
  if (simplices.id_count <= 128) return write_by_registers<2>(simplices, out);
#endif
  write_plain(simplices, out);
}

void map_local(const std::uint8_t* from, std::size_t count, const std::uint8_t* to, bool swap, std::uint8_t* out) {
#if HWY_TARGET == HWY_SCALAR
  const unsigned third = swap ? 3 : 2;
  for (std::size_t q = 0; q < count; ++q, from += 4, out += 4) {
    out[0] = to[from[0]];
    out[1] = to[from[1]];
    out[2] = to[from[third]];
    out[3] = to[from[5 - third]];
  }
#else
  const hn::FixedTag<std::uint8_t, 16> d;
  alignas(16) static constexpr std::uint8_t kOrders[2][16] = {{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
                                                              {0, 1, 3, 2, 4, 5, 7, 6, 8, 9, 11, 10, 12, 13, 15, 14}};
  const auto order = hn::Load(d, kOrders[swap ? 1 : 0]);
  const auto lower = hn::LoadU(d, to);
  const auto upper = hn::LoadU(d, to + 16);
  const auto last_of_lower = hn::Set(d, 15);
  for (std::size_t q = 0; q < count; q += 4) {
    const auto local = hn::TableLookupBytes(hn::LoadU(d, from + 4 * q), order);
    const auto in_half = hn::And(local, last_of_lower);
    const auto mapped = hn::IfThenElse(hn::Gt(local, last_of_lower), hn::TableLookupBytes(upper, in_half),
                                       hn::TableLookupBytes(lower, in_half));
    hn::StoreU(mapped, d, out + 4 * q);
  }
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

void map_simplices(const std::uint8_t* from, std::size_t count, const std::uint8_t* to, bool swap,
                   std::uint8_t* out) noexcept {
  HWY_DYNAMIC_DISPATCH(map_local)(from, count, to, swap, out);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
