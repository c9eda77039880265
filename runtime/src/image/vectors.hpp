// SPDX-License-Identifier: BSD-3-Clause
//
// Vector code that several files share: masks from bits, lanes that bits choose, and stores of points. Files that
// Highway compiles once per instruction set include this after Highway's headers, so it is read once per instruction
// set.
#if defined(TEGL_IMAGE_VECTORS) == defined(HWY_TARGET_TOGGLE)
#ifdef TEGL_IMAGE_VECTORS
#undef TEGL_IMAGE_VECTORS
#else
#define TEGL_IMAGE_VECTORS
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"
#include "image/bitplanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

/// The lanes of `bits`, of which those past the last lane are 0.
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Mask<D> mask_of(D d, Word bits) {
#if HWY_TARGET <= HWY_AVX3
  static_assert(hwy::HWY_NAMESPACE::MaxLanes(D()) == 16);
  static_cast<void>(d);
  return hwy::HWY_NAMESPACE::Mask<D>{static_cast<__mmask16>(bits)};
#else
  alignas(8) const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8)};
  return hwy::HWY_NAMESPACE::LoadMaskBits(d, bytes);
#endif
}

#if HWY_TARGET > HWY_AVX3 && HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128

/// By the bits of four or eight lanes: the numbers of the set ones in ascending order, then zeros.
template <std::size_t Lanes, std::size_t BytesOfLane>
struct ChosenLanes {
  alignas(16) std::array<std::array<std::uint8_t, Lanes * BytesOfLane>, std::size_t{1} << Lanes> bytes{};
  constexpr ChosenLanes() {
    for (std::size_t bits = 0; bits < bytes.size(); ++bits)
      for (std::size_t lane = 0, at = 0; lane < Lanes; ++lane)
        if ((bits >> lane & 1u) != 0)
          for (std::size_t b = 0; b < BytesOfLane; ++b)
            bytes[bits][at++] = static_cast<std::uint8_t>(BytesOfLane * lane + b);
  }
};
inline constexpr ChosenLanes<8, 1> kChosen8;  // numbers of lanes
inline constexpr ChosenLanes<4, 4> kChosen4;  // numbers of bytes

#endif

/// The lanes of `bits`, in ascending order; the others are undefined. Without AVX-512 by tables of our own: compilers
/// copy Highway's to the stack for each register.
template <class D>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> chosen_lanes(D d, hwy::HWY_NAMESPACE::Vec<D> v, Word bits) {
  static_assert(sizeof(hwy::HWY_NAMESPACE::TFromD<D>) == 4);
#if HWY_TARGET <= HWY_AVX3 || HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
  return hwy::HWY_NAMESPACE::Compress(v, mask_of(d, bits));
#elif HWY_TARGET == HWY_AVX2
  const auto* const numbers = reinterpret_cast<const __m128i*>(kChosen8.bytes[bits & 0xff].data());
  const __m256i lanes = _mm256_cvtepu8_epi32(_mm_loadl_epi64(numbers));
  static_cast<void>(d);
  return hwy::HWY_NAMESPACE::Vec<D>{_mm256_permutevar8x32_ps(v.raw, lanes)};
#else
  namespace hn = hwy::HWY_NAMESPACE;
  static_assert(hn::MaxLanes(D()) == 4);
  const hn::Repartition<std::uint8_t, D> bytes;
  const auto from = hn::Load(bytes, kChosen4.bytes[bits & 0xf].data());
  return hn::BitCast(d, hn::TableLookupBytes(hn::BitCast(bytes, v), from));
#endif
}

// Stores of points, of which each coordinate is in one register.
template <class D, class V>
HWY_INLINE void store_points(D d, const std::array<V, 2>& x, hwy::HWY_NAMESPACE::TFromD<D>* out) {
  hwy::HWY_NAMESPACE::StoreInterleaved2(x[0], x[1], d, out);
}
template <class D, class V>
HWY_INLINE void store_points(D d, const std::array<V, 4>& x, hwy::HWY_NAMESPACE::TFromD<D>* out) {
  hwy::HWY_NAMESPACE::StoreInterleaved4(x[0], x[1], x[2], x[3], d, out);
}

template <class D, class V>
HWY_INLINE void store_points(D d, const std::array<V, 3>& x, hwy::HWY_NAMESPACE::TFromD<D>* out) {
  hwy::HWY_NAMESPACE::StoreInterleaved3(x[0], x[1], x[2], d, out);
}

// Loads of points: the first coordinates of as many as a register has lanes, the second ones, and so on.
template <class D, class V>
HWY_INLINE void load_points(D d, const hwy::HWY_NAMESPACE::TFromD<D>* from, std::array<V, 2>& x) {
  hwy::HWY_NAMESPACE::LoadInterleaved2(d, from, x[0], x[1]);
}
template <class D, class V>
HWY_INLINE void load_points(D d, const hwy::HWY_NAMESPACE::TFromD<D>* from, std::array<V, 3>& x) {
  hwy::HWY_NAMESPACE::LoadInterleaved3(d, from, x[0], x[1], x[2]);
}
template <class D, class V>
HWY_INLINE void load_points(D d, const hwy::HWY_NAMESPACE::TFromD<D>* from, std::array<V, 4>& x) {
  hwy::HWY_NAMESPACE::LoadInterleaved4(d, from, x[0], x[1], x[2], x[3]);
}

#if HWY_TARGET <= HWY_AVX3

/// The reverse of ThreeInterleaved: lanes of the first two registers (`xy`), then of the result and the third register.
struct ThreeSeparated {
  alignas(64) std::array<std::array<int, 16>, 3> xy{}, xyz{};
  constexpr ThreeSeparated() {
    for (int axis = 0; axis < 3; ++axis)
      for (int point = 0; point < 16; ++point) {
        const int at = 3 * point + axis;
        xy[axis][point] = at < 32 ? at : 0;
        xyz[axis][point] = at < 32 ? point : at - 16;
      }
  }
};
inline constexpr ThreeSeparated kThreeSeparated;

HWY_INLINE void load_points(hwy::HWY_NAMESPACE::Full512<float> /*d*/, const float* from,
                            std::array<hwy::HWY_NAMESPACE::Vec512<float>, 3>& x) {
  const __m512 first = _mm512_loadu_ps(from), second = _mm512_loadu_ps(from + 16), third = _mm512_loadu_ps(from + 32);
  for (std::size_t a = 0; a < 3; ++a) {
    const __m512 both = _mm512_permutex2var_ps(first, _mm512_load_si512(kThreeSeparated.xy[a].data()), second);
    x[a].raw = _mm512_permutex2var_ps(both, _mm512_load_si512(kThreeSeparated.xyz[a].data()), third);
  }
}

/// Lanes of the three registers of points with coordinates x, y and z. Lanes of the second operand count from `Lanes`.
/// First those of x and y are chosen (`xy`), then those of the result and of z (`xyz`).
template <int Lanes>
struct ThreeInterleaved {
  alignas(64) std::array<std::array<int, Lanes>, 3> xy{}, xyz{};
  constexpr ThreeInterleaved() {
    for (int i = 0; i < 3 * Lanes; ++i) {
      const int point = i / 3, axis = i % 3, lane = i % Lanes;
      xy[i / Lanes][lane] = axis == 1 ? Lanes + point : point;
      xyz[i / Lanes][lane] = axis == 2 ? Lanes + point : lane;
    }
  }
};

inline constexpr ThreeInterleaved<8> kThree8;
inline constexpr ThreeInterleaved<16> kThree16;

// Two permutations for each register. Highway's function takes more than three times as many instructions.
HWY_INLINE void store_points(hwy::HWY_NAMESPACE::Full512<float> /*d*/,
                             const std::array<hwy::HWY_NAMESPACE::Vec512<float>, 3>& x, float* out) {
  for (std::size_t r = 0; r < 3; ++r) {
    const __m512 xy = _mm512_permutex2var_ps(x[0].raw, _mm512_load_si512(kThree16.xy[r].data()), x[1].raw);
    _mm512_storeu_ps(out + 16 * r, _mm512_permutex2var_ps(xy, _mm512_load_si512(kThree16.xyz[r].data()), x[2].raw));
  }
}
HWY_INLINE void store_points(hwy::HWY_NAMESPACE::Full256<float> /*d*/,
                             const std::array<hwy::HWY_NAMESPACE::Vec256<float>, 3>& x, float* out) {
  const auto lanes = [](const std::array<int, 8>& from)
                         HWY_ATTR { return _mm256_load_si256(reinterpret_cast<const __m256i*>(from.data())); };
  for (std::size_t r = 0; r < 3; ++r) {
    const __m256 xy = _mm256_permutex2var_ps(x[0].raw, lanes(kThree8.xy[r]), x[1].raw);
    _mm256_storeu_ps(out + 8 * r, _mm256_permutex2var_ps(xy, lanes(kThree8.xyz[r]), x[2].raw));
  }
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#endif
