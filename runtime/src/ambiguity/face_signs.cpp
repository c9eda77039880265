// SPDX-License-Identifier: BSD-3-Clause
//
// Decides faces by registers (see face_signs.hpp). Highway's foreach_target compiles this file once per instruction
// set.
#include "ambiguity/face_signs.hpp"

#include <algorithm>
#include <cmath>

#define HWY_WANT_AVX3_DL
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ambiguity/face_signs.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using Bits = hn::Rebind<std::uint64_t, D>;

/// Number of the face along `axes` (bits) at sides `base` of the other axes.
template <int N>
constexpr unsigned face_number(unsigned axes, unsigned base) {
  std::array<unsigned, 4> across{};
  unsigned count = 0;
  for (unsigned a = 0; a < N; ++a)
    if ((axes >> a & 1u) == 0) across[count++] = a;
  const auto side = [&](unsigned i) { return base >> across[i] & 1u; };
  if (count == 0) return N == 3 ? kFirstCube<3> : kTesseractFace;
  if (count == 1) return (N == 3 ? 0 : kFirstCube<4>)+2 * across[0] + side(0);
  unsigned pair = 0;
  for (unsigned c = 0; c < across[0]; ++c) pair += 3 - c;
  return 4 * (pair + across[1] - across[0] - 1) + side(0) + 2 * side(1);
}

/// Face numbers by axes and base.
template <int N>
struct FaceNumbers {
  std::array<std::array<std::uint8_t, 16>, 16> of{};
  constexpr FaceNumbers() {
    for (unsigned axes = 0; axes < 1u << N; ++axes)
      for (unsigned base = 0; base < 1u << N; ++base)
        if ((axes & base) == 0) of[axes][base] = static_cast<std::uint8_t>(face_number<N>(axes, base));
  }
};

/// Bits of the high faces, for as many tiles as there are lanes.
struct Highs {
  hn::Vec<Bits> bits;

  HWY_INLINE Highs() : bits(hn::Zero(Bits())) {}
  template <class M>
  HWY_INLINE void take(unsigned face, M is_high) {
    const Bits d;
    const auto bit = hn::Set(d, std::uint64_t{1} << face);
#if HWY_TARGET <= HWY_AVX3
    bits.raw = _mm512_mask_or_epi64(bits.raw, is_high.raw, bits.raw, bit.raw);
#else
    bits = hn::Or(bits, hn::IfThenElseZero(hn::RebindMask(d, is_high), bit));
#endif
  }
};

/// Decides faces by the sums of their corners. `least`: smallest distance of a sum from its limit.
struct Means {
  Highs highs;
  hn::Vec<D> least;
  double isovalue;

  HWY_INLINE explicit Means(double t) : least(hn::Set(D(), 0x1p1023)), isovalue(t) {}
  template <class V>
  HWY_INLINE void take(unsigned face, unsigned corners, V sum) {
    const auto limit = hn::Set(D(), corners * isovalue);
    highs.take(face, hn::Ge(sum, limit));
    least = hn::Min(least, hn::Abs(hn::Sub(sum, limit)));
  }
};

/// Samples of some tiles, at their own positions or the next ones.
template <int N>
HWY_INLINE auto samples_at(const FaceBlock<N>& block, std::size_t row, std::size_t at) {
  return hn::LoadU(D(), block.samples[row].data() + at);
}

/// Bound of the rounding errors of all sums; infinite if values are too large or not finite.
template <int N>
HWY_INLINE auto error_of_means(const FaceBlock<N>& block, std::size_t at, double isovalue) {
  const D d;
  auto size = hn::Set(d, 2.0 * block.kRows * std::abs(isovalue));
  for (std::size_t r = 0; r < block.kRows; ++r)
    size = hn::Add(size, hn::Add(hn::Abs(samples_at(block, r, at)), hn::Abs(samples_at(block, r, at + 1))));
  const auto infinite = hn::Set(d, HUGE_VAL);
  return hn::IfThenElse(hn::Lt(size, hn::Set(d, 0x1p1000)), hn::Mul(size, hn::Set(d, 0x1p-46)), infinite);
}

/// Decides the faces along two axes across the row, and those that these span with the row.
template <int N>
HWY_INLINE void take_means_across(const FaceBlock<N>& block, std::size_t at, Means& means) {
  static constexpr FaceNumbers<N> kNumbers;
  for (unsigned a = 1; a < N; ++a)
    for (unsigned b = a + 1; b < N; ++b)
      for (unsigned row = 0; row < block.kRows; ++row) {
        const unsigned up_a = 1u << (a - 1), up_b = 1u << (b - 1), axes = 1u << a | 1u << b;
        if ((row & (up_a | up_b)) != 0) continue;
        const auto sum = [&](std::size_t to) HWY_ATTR {
          return hn::Add(hn::Add(samples_at(block, row, to), samples_at(block, row | up_a, to)),
                         hn::Add(samples_at(block, row | up_b, to), samples_at(block, row | up_a | up_b, to)));
        };
        const auto here = sum(at), next = sum(at + 1);
        means.take(kNumbers.of[axes][row << 1], 4, here);
        means.take(kNumbers.of[axes][row << 1 | 1], 4, next);
        means.take(kNumbers.of[axes | 1][row << 1], 8, hn::Add(here, next));
      }
}

/// Decides the squares along the row.
template <int N>
HWY_INLINE void take_means_along(const FaceBlock<N>& block, std::size_t at, Means& means) {
  static constexpr FaceNumbers<N> kNumbers;
  for (unsigned a = 1; a < N; ++a)
    for (unsigned row = 0; row < block.kRows; ++row) {
      const unsigned up = 1u << (a - 1);
      if ((row & up) != 0) continue;
      const auto here = hn::Add(samples_at(block, row, at), samples_at(block, row | up, at));
      const auto next = hn::Add(samples_at(block, row, at + 1), samples_at(block, row | up, at + 1));
      means.take(kNumbers.of[1u << a | 1u][row << 1], 4, hn::Add(here, next));
    }
}

/// Decides the tesseract and its cubes across the row.
HWY_INLINE void take_means_of_rows(const FaceBlock<4>& block, std::size_t at, bool cubes, Means& means) {
  const auto sum = [&](std::size_t to) HWY_ATTR {
    auto result = samples_at(block, 0, to);
    for (std::size_t row = 1; row < block.kRows; ++row) result = hn::Add(result, samples_at(block, row, to));
    return result;
  };
  const auto here = sum(at), next = sum(at + 1);
  if (cubes) {
    means.take(kFirstCube<4>, 8, here);
    means.take(kFirstCube<4> + 1, 8, next);
  }
  means.take(kTesseractFace, 16, hn::Add(here, next));
}

/// Whether all samples are multiples of 2^-10 and less than `limit`.
template <int N>
HWY_INLINE bool are_whole(const FaceBlock<N>& block, double limit) {
  const D d;
  const auto scale = hn::Set(d, 0x1p10), most = hn::Set(d, 0x1p10 * limit);
  auto so_far = hn::Eq(scale, scale);
  for (std::size_t r = 0; r < block.kRows; ++r)
    for (std::size_t i = 0; i <= block.tiles; i += hn::Lanes(d)) {
      const auto scaled = hn::Mul(samples_at(block, r, i), scale);
      so_far = hn::And(so_far, hn::And(hn::Eq(hn::Round(scaled), scaled), hn::Lt(hn::Abs(scaled), most)));
    }
  return hn::AllTrue(d, so_far);
}

/// Clears `unsure` if nothing was rounded.
template <int N>
HWY_INLINE void look_again(FaceBlock<N>& block, bool any_unsure, double limit) {
  if (any_unsure && are_whole(block, limit)) std::fill_n(block.unsure.data(), block.tiles, 0);
}

template <int N>
HWY_INLINE void means_of(FaceBlock<N>& block, double isovalue) {
  const D d;
  const Bits bits;
  auto any_unsure = hn::Zero(bits);
  for (std::size_t i = 0; i < block.tiles; i += hn::Lanes(d)) {
    Means means(isovalue);
    take_means_across(block, i, means);
    take_means_along(block, i, means);
    if constexpr (N == 4) take_means_of_rows(block, i, true, means);
    const auto sure = hn::RebindMask(bits, hn::Gt(means.least, error_of_means(block, i, isovalue)));
    const auto unsure = hn::IfThenZeroElse(sure, hn::Set(bits, 1));
    hn::Store(means.highs.bits, bits, block.high.data() + i);
    hn::Store(unsure, bits, block.unsure.data() + i);
    any_unsure = hn::Or(any_unsure, unsure);
  }
  // Sums of 16 are then exact.
  look_again(block, !hn::AllTrue(bits, hn::Eq(any_unsure, hn::Zero(bits))), 0x1p36);
}

/// Decides squares by their saddles. `least`: smallest margin of a determinant over its possible error without kTiny.
struct Saddles {
  Highs highs;
  hn::Vec<D> least;

  HWY_INLINE Saddles() : least(hn::Set(D(), 0x1p1023)) {}
  /// Arguments: corner 0, its two neighbours, and the opposite corner, each minus the isovalue.
  template <class V>
  HWY_INLINE void take(unsigned face, V first, V second, V third, V last) {
    const D d;
    const auto one = hn::Mul(first, last), other = hn::Mul(second, third);
    const auto determinant = hn::Sub(one, other);
    const auto size = hn::Add(hn::Abs(one), hn::Abs(other));
    // The difference of two zeros may be -0.
    const auto of_high = hn::IfThenElse(hn::Lt(first, hn::Zero(d)), hn::Neg(determinant), determinant);
    highs.take(face, hn::Ge(of_high, hn::Zero(d)));
    // The factor has room for the rounding of this line, fused or not.
    least = hn::Min(least, hn::NegMulAdd(size, hn::Set(d, 0x1p-48), hn::Abs(determinant)));
  }
  /// Where rounding cannot decide.
  HWY_INLINE auto sure() const {
    constexpr double kTiny = 0x1p-1006;  // of the products, if they are denormal
    return hn::Gt(least, hn::Set(D(), kTiny));
  }
};

template <int N>
HWY_INLINE void take_saddles(const FaceBlock<N>& block, std::size_t at, double isovalue, Saddles& saddles) {
  static constexpr FaceNumbers<N> kNumbers;
  const auto difference = [&](std::size_t row, std::size_t to)
                              HWY_ATTR { return hn::Sub(samples_at(block, row, to), hn::Set(D(), isovalue)); };
  for (unsigned a = 1; a < N; ++a)
    for (unsigned row = 0; row < block.kRows; ++row) {
      const unsigned up_a = 1u << (a - 1);
      if ((row & up_a) != 0) continue;
      saddles.take(kNumbers.of[1u << a | 1u][row << 1], difference(row, at), difference(row, at + 1),
                   difference(row | up_a, at), difference(row | up_a, at + 1));
      for (unsigned b = a + 1; b < N; ++b) {
        const unsigned up_b = 1u << (b - 1);
        if ((row & up_b) != 0) continue;
        for (unsigned side = 0; side < 2; ++side)
          saddles.take(kNumbers.of[1u << a | 1u << b][row << 1 | side], difference(row, at + side),
                       difference(row | up_a, at + side), difference(row | up_b, at + side),
                       difference(row | up_a | up_b, at + side));
      }
    }
}

template <int N>
HWY_INLINE void saddles_of(FaceBlock<N>& block, double isovalue) {
  const D d;
  const Bits bits;
  const auto large = hn::Set(d, 0x1p500);  // products of two are finite
  auto any_unsure = hn::Zero(bits);
  for (std::size_t i = 0; i < block.tiles; i += hn::Lanes(d)) {
    Saddles saddles;
    take_saddles(block, i, isovalue, saddles);
    auto sure = saddles.sure();
    auto largest = hn::Zero(d);
    for (std::size_t r = 0; r < block.kRows; ++r)
      for (std::size_t to = i; to < i + 2; ++to) largest = hn::Max(largest, hn::Abs(samples_at(block, r, to)));
    sure = hn::And(sure, hn::Lt(largest, large));
    if constexpr (N == 4) {
      Means means(isovalue);
      take_means_of_rows(block, i, false, means);
      saddles.highs.bits = hn::Or(saddles.highs.bits, means.highs.bits);
      sure = hn::And(sure, hn::Gt(means.least, error_of_means(block, i, isovalue)));
    }
    const auto unsure = hn::IfThenZeroElse(hn::RebindMask(bits, sure), hn::Set(bits, 1));
    hn::Store(saddles.highs.bits, bits, block.high.data() + i);
    hn::Store(unsure, bits, block.unsure.data() + i);
    any_unsure = hn::Or(any_unsure, unsure);
  }
  // Differences then have 25 bits, and products 50.
  constexpr double kMost = 0x1p14;
  const bool is_whole = std::abs(isovalue) < kMost && std::nearbyint(0x1p10 * isovalue) == 0x1p10 * isovalue;
  look_again(block, is_whole && !hn::AllTrue(bits, hn::Eq(any_unsure, hn::Zero(bits))), kMost);
}

/// Numbers computed in doubles, and the same with all signs positive; see Rounded in saddle.cpp.
struct Rounded {
  hn::Vec<D> value, size;
};
HWY_INLINE Rounded plus(const Rounded& x, const Rounded& y) {
  return {hn::Add(x.value, y.value), hn::Add(x.size, y.size)};
}
HWY_INLINE Rounded minus(const Rounded& x, const Rounded& y) {
  return {hn::Sub(x.value, y.value), hn::Add(x.size, y.size)};
}
HWY_INLINE Rounded times(const Rounded& x, const Rounded& y) {
  return {hn::Mul(x.value, y.value), hn::Add(hn::Mul(x.size, y.size), hn::Set(D(), 0x1p-960))};
}
HWY_INLINE Rounded twice(const Rounded& x) { return plus(x, x); }

/// Conditions that numbers are positive (or not negative): lanes where all hold for certain, and where one certainly
/// fails.
struct Conditions {
  hn::Mask<D> all, none;

  HWY_INLINE Conditions() : all(hn::Eq(hn::Zero(D()), hn::Zero(D()))), none(hn::Lt(hn::Zero(D()), hn::Zero(D()))) {}
  HWY_INLINE void take(const Rounded& x) {
    const auto error = hn::Mul(x.size, hn::Set(D(), 0x1p-48));
    all = hn::And(all, hn::Gt(x.value, error));
    none = hn::Or(none, hn::Lt(x.value, hn::Neg(error)));
  }
};

/// Answers as many questions as there are lanes, from `i` on. Same test as PairQuestion (saddle.cpp), without branches.
HWY_INLINE void answer_some(JoinQuestions& questions, double isovalue, std::size_t i) {
  const D d;
  const auto zero = hn::Zero(d);
  const auto end = [&](std::size_t e) HWY_ATTR {
    const auto difference = hn::Sub(hn::LoadU(d, questions.ends[e].data() + i), hn::Set(d, isovalue));
    return Rounded{difference, hn::Abs(difference)};
  };
  // the polynomials of PairQuestion
  const Rounded a0 = end(0), a1 = end(1), c0 = end(2), c1 = end(3), b0 = end(4), b1 = end(5), d0 = end(6), d1 = end(7);
  const Rounded q0 = minus(times(a0, c0), times(b0, d0)), q1 = minus(times(a1, c1), times(b1, d1));
  const Rounded m = minus(minus(plus(times(a0, c1), times(a1, c0)), times(b0, d1)), times(b1, d0));
  const Rounded u0 = minus(m, twice(q0)), u1 = minus(m, twice(q1));
  const Rounded a = plus(times(a0, u1), times(a1, u0)), c = plus(times(c0, u1), times(c1, u0));
  const Rounded hyperdeterminant = minus(times(m, m), twice(twice(times(q0, q1))));
  const auto sign = hn::LoadU(d, questions.sign.data() + i);
  // answers in rounded arithmetic
  Conditions conditions;
  conditions.take(u0);
  conditions.take(u1);
  conditions.take({hn::Mul(sign, a.value), a.size});
  conditions.take({hn::Mul(sign, c.value), c.size});
  conditions.take(hyperdeterminant);
  const auto used = hn::FirstN(d, questions.count - i);
  auto is_yes = conditions.all, is_no = conditions.none;
  if (!hn::AllFalse(d, hn::AndNot(hn::Or(is_yes, is_no), used))) {
    // Nothing was rounded if all values and the isovalue are multiples of 1/2 with 10 bits. A zero then counts as high.
    const auto is_short = [&](hn::Vec<D> value) HWY_ATTR {
      const auto halves = hn::Add(value, value);
      return hn::And(hn::Eq(hn::Round(halves), halves), hn::Le(hn::Abs(value), hn::Set(d, 0x1p9)));
    };
    auto is_whole = is_short(hn::Set(d, isovalue));
    for (const auto& values : questions.ends) is_whole = hn::And(is_whole, is_short(hn::LoadU(d, values.data() + i)));
    const auto least = hn::IfThenElse(hn::Gt(sign, zero), zero, hn::Set(d, 0x1p-60));  // below any such number
    const auto is_so = [&](const Rounded& x) HWY_ATTR { return hn::Ge(hn::Mul(sign, x.value), least); };
    const auto is_inside = hn::And(hn::Gt(u0.value, zero), hn::Gt(u1.value, zero));
    const auto exactly =
        hn::And(hn::And(is_inside, hn::Ge(hyperdeterminant.value, least)), hn::And(is_so(a), is_so(c)));
    is_yes = hn::Or(hn::And(is_whole, exactly), hn::AndNot(is_whole, is_yes));
    is_no = hn::Or(hn::AndNot(exactly, is_whole), hn::AndNot(is_whole, is_no));
  }
  // write
  alignas(64) double result[hn::MaxLanes(d)];
  hn::Store(hn::IfThenElse(is_yes, hn::Set(d, 1.0), hn::IfThenElse(is_no, zero, hn::Set(d, 2.0))), d, result);
  for (std::size_t j = 0; j < hn::Lanes(d) && i + j < questions.count; ++j)
    questions.answers[i + j] = static_cast<JoinQuestions::Answer>(static_cast<int>(result[j]));
}

void answer_all(JoinQuestions& questions, double isovalue) {
  const D d;
  const std::size_t end = (questions.count + hn::Lanes(d) - 1) / hn::Lanes(d) * hn::Lanes(d);
  for (auto& values : questions.ends) std::fill(values.begin() + questions.count, values.begin() + end, 0.0);
  std::fill(questions.sign.begin() + questions.count, questions.sign.begin() + end, 0.0);
  for (std::size_t i = 0; i < questions.count; i += hn::Lanes(d)) answer_some(questions, isovalue, i);
}

#if HWY_TARGET <= HWY_AVX3

/// Transposes eight rows of eight numbers and stores them `pitch` apart.
HWY_INLINE void store_transposed(const __m512d (&rows)[8], double* to, std::size_t pitch) {
  __m512d pairs[8], fours[8];
  for (unsigned i = 0; i < 8; i += 2) {
    pairs[i] = _mm512_unpacklo_pd(rows[i], rows[i + 1]);
    pairs[i + 1] = _mm512_unpackhi_pd(rows[i], rows[i + 1]);
  }
  for (unsigned i = 0; i < 8; i += 4)
    for (unsigned j = 0; j < 2; ++j) {  // columns j, j + 4 and j + 2, j + 6
      fours[i + j] = _mm512_shuffle_f64x2(pairs[i + j], pairs[i + j + 2], 0x88);
      fours[i + j + 2] = _mm512_shuffle_f64x2(pairs[i + j], pairs[i + j + 2], 0xDD);
    }
  for (unsigned j = 0; j < 4; ++j) {
    _mm512_storeu_pd(to + j * pitch, _mm512_shuffle_f64x2(fours[j], fours[j + 4], 0x88));
    _mm512_storeu_pd(to + (j + 4) * pitch, _mm512_shuffle_f64x2(fours[j], fours[j + 4], 0xDD));
  }
}

void ask_all(const FaceBlock<3>& block, const std::uint8_t* bits, std::size_t count,
             const tables::CubeJoin* const* joins, JoinQuestions& questions) {
  // the corners of one tile are a register, from which its ends are picked
  for (std::size_t q = 0; q < count; q += 8) {
    __m512d rows[8];
    for (std::size_t j = 0; j < 8; ++j) {
      const std::size_t i = std::min(q + j, count - 1);
      const auto two = [&](std::size_t row) HWY_ATTR { return _mm_loadu_pd(block.samples[row].data() + bits[i]); };
      const __m256d lower = _mm256_insertf128_pd(_mm256_castpd128_pd256(two(0)), two(1), 1);
      const __m256d upper = _mm256_insertf128_pd(_mm256_castpd128_pd256(two(2)), two(3), 1);
      const __m512i ends = _mm512_cvtepu8_epi64(_mm_loadu_si64(joins[i]->corners.data()));
      rows[j] = _mm512_permutexvar_pd(ends, _mm512_insertf64x4(_mm512_castpd256_pd512(lower), upper, 1));
      questions.sign[q + j] = JoinQuestions::kSigns[joins[i]->high];
    }
    store_transposed(rows, questions.ends[0].data() + q, JoinQuestions::kMost);
  }
  questions.count = count;
}

#else

void ask_all(const FaceBlock<3>& block, const std::uint8_t* bits, std::size_t count,
             const tables::CubeJoin* const* joins, JoinQuestions& questions) {
  for (std::size_t q = 0; q < count; ++q)
    questions.add(*joins[q], [&](unsigned corner) { return block.samples[corner >> 1][bits[q] + (corner & 1u)]; });
}

#endif

// Highway's dispatch tables cannot hold templates.
void means3(FaceBlock<3>& block, double isovalue) { means_of<3>(block, isovalue); }
void means4(FaceBlock<4>& block, double isovalue) { means_of<4>(block, isovalue); }
void saddles3(FaceBlock<3>& block, double isovalue) { saddles_of<3>(block, isovalue); }
void saddles4(FaceBlock<4>& block, double isovalue) { saddles_of<4>(block, isovalue); }

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(answer_all);
HWY_EXPORT(means3);
HWY_EXPORT(means4);
HWY_EXPORT(saddles3);
HWY_EXPORT(saddles4);

HWY_EXPORT(ask_all);

void ask(const FaceBlock<3>& block, std::span<const std::uint8_t> bits, const tables::CubeJoin* const* joins,
         JoinQuestions& questions) noexcept {
  HWY_DYNAMIC_DISPATCH(ask_all)(block, bits.data(), bits.size(), joins, questions);
}

void answer(JoinQuestions& questions, double isovalue) noexcept {
  HWY_DYNAMIC_DISPATCH(answer_all)(questions, isovalue);
}

template <>
void decide_by_means<3>(FaceBlock<3>& block, double isovalue) noexcept {
  HWY_DYNAMIC_DISPATCH(means3)(block, isovalue);
}
template <>
void decide_by_means<4>(FaceBlock<4>& block, double isovalue) noexcept {
  HWY_DYNAMIC_DISPATCH(means4)(block, isovalue);
}
template <>
void decide_by_saddles<3>(FaceBlock<3>& block, double isovalue) noexcept {
  HWY_DYNAMIC_DISPATCH(saddles3)(block, isovalue);
}
template <>
void decide_by_saddles<4>(FaceBlock<4>& block, double isovalue) noexcept {
  HWY_DYNAMIC_DISPATCH(saddles4)(block, isovalue);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
