// SPDX-License-Identifier: BSD-3-Clause
//
// Variants of the cubes of a word (see cube_words.hpp). Highway's foreach_target compiles this file once per
// instruction set.
#include "ambiguity/cube_words.hpp"

#include <algorithm>
#include <bit>

#include "ambiguity/saddle.hpp"
#include "builder4_lookup.hpp"
#include "tile/tesseract_fill.hpp"

#define HWY_WANT_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ambiguity/cube_words.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

#if HWY_TARGET <= HWY_AVX3_DL

using builders::CubeBytes;

/// Entries of `places` in a table of 256.
HWY_INLINE __m512i looked_up(const CubeBytes::BySignature& table, __m512i places) {
  const auto part = [&](std::size_t from) HWY_ATTR { return _mm512_load_si512(table.data() + from); };
  return _mm512_mask_blend_epi8(_mm512_movepi8_mask(places), _mm512_permutex2var_epi8(part(0), places, part(64)),
                                _mm512_permutex2var_epi8(part(128), places, part(192)));
}

/// Entries of tables::ResolvedTable, in two bytes.
struct Entries {
  __m512i low, high;

  /// `faces`: bits of the high squares; others are ignored.
  HWY_INLINE Entries(const CubeBytes& bytes, __m512i signatures, __m512i faces) {
    __m512i bits = _mm512_and_si512(faces, looked_up(bytes.ambiguous, signatures));
    const auto moving = [&](std::size_t step) HWY_ATTR {
      const __m512i moved = _mm512_and_si512(bits, looked_up(bytes.moved[step], signatures));
      bits = _mm512_xor_si512(bits, moved);
      return moved;
    };
    // no bit leaves its byte
    const __m512i by_one = moving(0);
    bits = _mm512_or_si512(bits, _mm512_srli_epi16(by_one, 1));
    const __m512i by_two = moving(1);
    bits = _mm512_or_si512(bits, _mm512_srli_epi16(by_two, 2));
    const __m512i by_four = moving(2);
    bits = _mm512_or_si512(bits, _mm512_srli_epi16(by_four, 4));
    low = _mm512_add_epi8(looked_up(bytes.first_low, signatures), bits);
    high = looked_up(bytes.first_high, signatures);
    high = _mm512_mask_add_epi8(high, _mm512_cmplt_epu8_mask(low, bits), high, _mm512_set1_epi8(1));
  }

  /// Which of the entries are in a set, as bits by lane.
  HWY_INLINE Word in(const std::array<std::uint8_t, 128>& set) const {
    const __m512i byte = _mm512_or_si512(_mm512_and_si512(_mm512_srli_epi16(low, 3), _mm512_set1_epi8(31)),
                                         _mm512_slli_epi16(high, 5));  // `high` is less than 4
    const __m512i bits =
        _mm512_permutex2var_epi8(_mm512_load_si512(set.data()), byte, _mm512_load_si512(set.data() + 64));
    const __m512i powers = _mm512_set1_epi64(static_cast<long long>(0x8040201008040201));
    return _mm512_test_epi8_mask(bits, _mm512_shuffle_epi8(powers, _mm512_and_si512(low, _mm512_set1_epi8(7))));
  }
};

/// The bytes `half` of a register as 16-bit numbers.
HWY_INLINE __m512i widened(__m512i bytes, int half) {
  return _mm512_cvtepu8_epi16(half == 0 ? _mm512_castsi512_si256(bytes) : _mm512_extracti64x4_epi64(bytes, 1));
}

HWY_INLINE void list_open(Word chosen, const Entries& entries, __m512i numbers, __m512i places, OpenCubes& open) {
  open.count = static_cast<std::size_t>(std::popcount(chosen));
  if (chosen == 0) return;
  _mm512_store_si512(open.numbers.data(), _mm512_maskz_compress_epi8(chosen, numbers));
  _mm512_store_si512(open.places.data(), _mm512_maskz_compress_epi8(chosen, places));
  const __m512i low = _mm512_maskz_compress_epi8(chosen, entries.low);
  const __m512i high = _mm512_maskz_compress_epi8(chosen, entries.high);
  for (int half = 0; half < 2; ++half)
    _mm512_store_si512(open.entries.data() + 32 * half,
                       _mm512_or_si512(widened(low, half), _mm512_slli_epi16(widened(high, half), 8)));
}

template <CentreRule Rule>
HWY_INLINE void choose_by(const std::uint8_t* high, const Variant* variants, CubesOfWord& cubes, CubesByPairs& open) {
  static_assert(sizeof(Variant) == 4);
  alignas(64) static constexpr auto kCountUp = [] {
    std::array<std::uint8_t, 64> numbers{};
    for (unsigned i = 0; i < 64; ++i) numbers[i] = static_cast<std::uint8_t>(i);
    return numbers;
  }();
  const __m512i count_up = _mm512_load_si512(kCountUp.data());
  const Word ambiguous = cubes.ambiguous;
  // the ambiguous cubes, one byte each
  const bool is_long = ambiguous >> 32 != 0;
  const __m512i keys[2] = {_mm512_loadu_si512(cubes.keys),
                           is_long ? _mm512_loadu_si512(cubes.keys + 32) : _mm512_setzero_si512()};
  const __m512i narrow =
      _mm512_inserti64x4(_mm512_castsi256_si512(_mm512_cvtepi16_epi8(keys[0])), _mm512_cvtepi16_epi8(keys[1]), 1);
  const auto of_active = [&](__m512i by_place) HWY_ATTR {
    return _mm512_maskz_compress_epi8(ambiguous, _mm512_maskz_compress_epi8(cubes.active, by_place));
  };
  const __m512i faces = of_active(_mm512_loadu_si512(high));
  const CubeBytes& bytes = builders::kCubeBytes;
  const Entries entries(bytes, _mm512_maskz_compress_epi8(ambiguous, narrow), faces);
  const auto count = static_cast<unsigned>(std::popcount(ambiguous));
  if constexpr (Rule == CentreRule::by_joins) {
    const Word used = ~Word{0} >> (kWordBits - count);
    const __m512i numbers = _mm512_maskz_compress_epi8(ambiguous, count_up), places = of_active(count_up);
    list_open(entries.in(bytes.with_one_pair) & used, entries, numbers, places, open.with_one);
    list_open(entries.in(bytes.with_more) & used, entries, numbers, places, open.with_more);
  }
  // their variants, sixteen at a time
  alignas(64) std::array<std::uint8_t, 64> low, upper, centres;
  alignas(64) std::array<std::uint16_t, 64> found;
  _mm512_store_si512(low.data(), entries.low);
  _mm512_store_si512(upper.data(), entries.high);
  if constexpr (Rule == CentreRule::by_bit) _mm512_store_si512(centres.data(), _mm512_srli_epi16(faces, 6));
  const __m512i none = _mm512_setzero_si512();
  __m512i simplices = none, own_vertices = none;
  for (unsigned i = 0; i < count; i += 16) {
    const auto sixteen = [&](const std::array<std::uint8_t, 64>& of) HWY_ATTR {
      return _mm512_cvtepu8_epi32(_mm_load_si128(reinterpret_cast<const __m128i*>(of.data() + i)));
    };
    // RowTable::variant
    __m512i place = _mm512_or_si512(_mm512_slli_epi32(sixteen(low), 2), _mm512_slli_epi32(sixteen(upper), 10));
    if constexpr (Rule == CentreRule::by_bit) {
      const __m512i centre = _mm512_and_si512(sixteen(centres), _mm512_set1_epi32(1));
      place = _mm512_add_epi32(_mm512_add_epi32(place, _mm512_set1_epi32(1)), centre);
    }
    const auto used = static_cast<__mmask16>(0xffffu >> (16 - std::min(16u, count - i)));
    const __m512i chosen = _mm512_mask_i32gather_epi32(none, used, place, variants, 4);
    _mm256_store_si256(reinterpret_cast<__m256i*>(found.data() + i), _mm512_cvtepi32_epi16(chosen));
    simplices = _mm512_add_epi32(simplices, _mm512_srai_epi32(_mm512_slli_epi32(chosen, 8), 24));
    own_vertices = _mm512_add_epi32(own_vertices, _mm512_srai_epi32(chosen, 24));
  }
  // to their places among the active tiles
  const auto store = [&](unsigned half, unsigned first) HWY_ATTR {
    const auto chosen = static_cast<__mmask32>(ambiguous >> (32 * half));
    const __m512i of_half = _mm512_loadu_si512(found.data() + first);
    _mm512_storeu_si512(cubes.keys + 32 * half, _mm512_mask_expand_epi16(keys[half], chosen, of_half));
  };
  store(0, 0);
  if (is_long) store(1, static_cast<unsigned>(std::popcount(static_cast<std::uint32_t>(ambiguous))));
  cubes.more_simplices += _mm512_reduce_add_epi32(simplices);
  cubes.more_own_vertices += _mm512_reduce_add_epi32(own_vertices);
}

#else

/// A list of open cubes, to which a cube is added without a branch on whether it belongs to the list.
struct OpenList {
  OpenCubes& to;
  std::size_t count = 0;

  HWY_INLINE void add(unsigned number, unsigned place, unsigned entry, bool belongs) {
    if (count == kWordBits) return;  // all are listed
    to.numbers[count] = static_cast<std::uint8_t>(number);
    to.places[count] = static_cast<std::uint8_t>(place);
    to.entries[count] = static_cast<std::uint16_t>(entry);
    count += belongs ? 1 : 0;
  }
};

template <CentreRule Rule>
HWY_INLINE void choose_by(const std::uint8_t* high, const Variant* variants, CubesOfWord& cubes, CubesByPairs& open) {
  // By local variables: the compiler has to assume that stores of keys and cubes change the members.
  const std::uint16_t* const at = cubes.at;
  std::uint16_t* const keys = cubes.keys;
  std::int32_t simplices = 0, own_vertices = 0;
  OpenList with_one{open.with_one}, with_more{open.with_more};
  for (Word rest = cubes.ambiguous; rest != 0; rest &= rest - 1) {
    const auto number = static_cast<unsigned>(std::countr_zero(rest));
    const unsigned place = at[number] % kWordBits, of = high[place];
    const unsigned entry = ResolvedCubes::entry(keys[number], of & 63u);
    const Variant& variant = variants[4 * entry + (Rule == CentreRule::by_bit ? 1 + (of >> 6) : 0)];
    keys[number] = variant.key;
    simplices += variant.more_simplices;
    own_vertices += variant.more_own_vertices;
    if constexpr (Rule == CentreRule::by_joins) {
      const unsigned pairs = cube_joins()[entry].pairs;
      with_one.add(number, place, entry, pairs == 1);
      if (pairs > 1) with_more.add(number, place, entry, true);
    }
  }
  open.with_one.count = with_one.count;
  open.with_more.count = with_more.count;
  cubes.more_simplices += simplices;
  cubes.more_own_vertices += own_vertices;
}

#endif

void choose(const std::uint8_t* high, const Variant* variants, CentreRule rule, CubesOfWord& cubes,
            CubesByPairs& open) {
  switch (rule) {
    case CentreRule::separate:
      return choose_by<CentreRule::separate>(high, variants, cubes, open);
    case CentreRule::by_bit:
      return choose_by<CentreRule::by_bit>(high, variants, cubes, open);
    case CentreRule::by_joins:
      return choose_by<CentreRule::by_joins>(high, variants, cubes, open);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(choose);
void choose_variants(const std::uint8_t* high, const Variant* variants, CentreRule rule, CubesOfWord& cubes,
                     CubesByPairs& open) noexcept {
  HWY_DYNAMIC_DISPATCH(choose)(high, variants, rule, cubes, open);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
