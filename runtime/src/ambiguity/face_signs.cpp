// SPDX-License-Identifier: BSD-3-Clause
//
// Decides faces by registers (see face_signs.hpp). Highway's foreach_target compiles this file once per instruction
// set.
#include "ambiguity/face_signs.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

#include "ambiguity/saddle.hpp"

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
template <class D>
struct Highs {
  using Bits = hn::RebindToUnsigned<D>;
  hn::Vec<Bits> bits;

  HWY_INLINE Highs() : bits(hn::Zero(Bits())) {}
  template <class M>
  HWY_INLINE void take(unsigned face, M is_high) {
    const Bits d;
    const auto bit = hn::Set(d, hn::TFromD<Bits>{1} << face);
#if HWY_TARGET <= HWY_AVX3
    if constexpr (sizeof(hn::TFromD<D>) == 4)
      bits.raw = _mm512_mask_or_epi32(bits.raw, is_high.raw, bits.raw, bit.raw);
    else
      bits.raw = _mm512_mask_or_epi64(bits.raw, is_high.raw, bits.raw, bit.raw);
#else
    bits = hn::Or(bits, hn::IfThenElseZero(hn::RebindMask(d, is_high), bit));
#endif
  }
  /// Stores the faces of the tiles from `at` on.
  template <int N>
  HWY_INLINE void store(std::size_t at, FaceBlock<N>& block) const {
    if constexpr (N == 3) {
#if HWY_TARGET <= HWY_AVX3
      auto* const to = reinterpret_cast<__m128i*>(block.high.data() + at);
      if constexpr (sizeof(hn::TFromD<D>) == 4)
        _mm_storeu_si128(to, _mm512_cvtepi32_epi8(bits.raw));
      else
        _mm_storel_epi64(to, _mm512_cvtepi64_epi8(bits.raw));
#else
      if constexpr (sizeof(hn::TFromD<D>) == 4) {
        const hn::Rebind<std::uint8_t, Bits> bytes;
        hn::StoreU(hn::DemoteTo(bytes, hn::BitCast(hn::RebindToSigned<Bits>(), bits)), bytes, block.high.data() + at);
      } else {
        alignas(64) std::uint64_t wide[hn::MaxLanes(Bits())];
        hn::Store(bits, Bits(), wide);
        for (std::size_t i = 0; i < hn::Lanes(Bits()); ++i) block.high[at + i] = static_cast<std::uint8_t>(wide[i]);
      }
#endif
    } else {
      hn::Store(bits, Bits(), block.high.data() + at);
    }
  }
};

/// The numbers that faces are decided by: the samples of a block.
template <int N>
struct Samples {
  using D = HWY_NAMESPACE::D;
  static constexpr double kUnitOfMeans = 0x1p-46, kUnitOfSaddles = 0x1p-47;
  static constexpr double kLeastOfMeans = 0.0, kMostOfMeans = 0x1p1000;
  static constexpr double kLeastOfSaddles = 0x1p-480, kMostOfSaddles = 0x1p500;
  static constexpr std::size_t kRows = FaceBlock<N>::kRows;

  const FaceBlock<N>& block;
  double isovalue;

  /// Some tiles, at their own positions or the next ones.
  HWY_INLINE auto at(std::size_t row, std::size_t place) const {
    return hn::LoadU(D(), block.samples[row].data() + place);
  }
};

/// The numbers that faces are decided by: the differences of a block's samples from the isovalue, rounded to 24 bits.
/// Twice as many lanes are as fast, and if rounding could decide a face, its samples are taken instead. With an error
/// of each difference of less than 2^-23.9 of it, the sum of 4 or 8 has one of less than 2^-21.9 of the sum of their
/// absolute values, and a determinant, fused or not, one of less than 2^-20.9 of the square of the largest. Differences
/// below 2^-126 have larger errors, so these bounds are taken of sums and squares that are far above. A difference that
/// is rounded to 0 keeps its sign, and one of 0 is +0.
template <int N>
class ShortDifferences {
 public:
  using D = hn::ScalableTag<float>;
  static constexpr float kUnitOfMeans = 0x1p-20f, kUnitOfSaddles = 0x1p-20f;
  static constexpr float kLeastOfMeans = 0x1p-100f, kMostOfMeans = 0x1p100f;
  static constexpr float kLeastOfSaddles = 0x1p-40f, kMostOfSaddles = 0x1p40f;
  static constexpr std::size_t kRows = FaceBlock<N>::kRows;
  static constexpr float isovalue = 0.0f;

  HWY_INLINE ShortDifferences(const FaceBlock<N>& block, double of) {
    const HWY_NAMESPACE::D d;
    const hn::Rebind<float, HWY_NAMESPACE::D> narrow;
    const auto minus = hn::Set(d, of == 0.0 ? 0.0 : -of);  // adding 0 makes 0 of -0
    const std::size_t last = std::min(block.kSamples, block.tiles + 16);  // with the rest of the last register
    for (std::size_t r = 0; r < kRows; ++r)
      for (std::size_t i = 0; i < last; i += hn::Lanes(d))
        hn::StoreU(hn::DemoteTo(narrow, hn::Add(hn::LoadU(d, block.samples[r].data() + i), minus)), narrow,
                   rows_[r].data() + i);
  }
  HWY_INLINE auto at(std::size_t row, std::size_t place) const { return hn::LoadU(D(), rows_[row].data() + place); }

 private:
  alignas(64) std::array<std::array<float, FaceBlock<N>::kPitch>, kRows> rows_;
};

/// Decides faces by the sums of their corners. `least`: smallest distance of a sum from its limit.
template <class D>
struct Means {
  using T = hn::TFromD<D>;
  Highs<D> highs;
  hn::Vec<D> least;
  T isovalue;

  HWY_INLINE explicit Means(T t) : least(hn::Set(D(), hwy::HighestValue<T>())), isovalue(t) {}
  template <class V>
  HWY_INLINE void take(unsigned face, unsigned corners, V sum) {
    const auto limit = hn::Set(D(), static_cast<T>(corners) * isovalue);
    highs.take(face, hn::Ge(sum, limit));
    least = hn::Min(least, hn::Abs(hn::Sub(sum, limit)));
  }
};

/// Bound of the rounding errors of all sums; infinite if values are too small for it, too large or not finite.
template <class From>
HWY_INLINE auto error_of_means(const From& from, std::size_t at) {
  const typename From::D d;
  using T = hn::TFromD<typename From::D>;
  auto size = hn::Set(d, T{2} * static_cast<T>(From::kRows) * std::abs(from.isovalue));
  for (std::size_t r = 0; r < From::kRows; ++r)
    size = hn::Add(size, hn::Add(hn::Abs(from.at(r, at)), hn::Abs(from.at(r, at + 1))));
  const auto infinite = hn::Set(d, static_cast<T>(HUGE_VAL));
  const auto in_range =
      hn::And(hn::Gt(size, hn::Set(d, From::kLeastOfMeans)), hn::Lt(size, hn::Set(d, From::kMostOfMeans)));
  return hn::IfThenElse(in_range, hn::Mul(size, hn::Set(d, From::kUnitOfMeans)), infinite);
}

/// Calls visit(number) for the numbers below Count, as constants.
template <unsigned Count, class Visit>
HWY_INLINE void unrolled(const Visit& visit) {
  [&]<unsigned... I>(std::integer_sequence<unsigned, I...>) HWY_ATTR {
    (visit(std::integral_constant<unsigned, I>{}), ...);
  }
  (std::make_integer_sequence<unsigned, Count>());
}

/// Decides the faces along two axes across the row, and those that these span with the row. Unrolled, so that the
/// faces' numbers are constants.
template <int N, class From, class D>
HWY_INLINE void take_means_across(const From& from, std::size_t at, Means<D>& means) {
  constexpr FaceNumbers<N> kNumbers;
  unrolled<N * N * From::kRows>([&](auto number) HWY_ATTR {
    constexpr unsigned kA = number / From::kRows / N, kB = number / From::kRows % N, kRow = number % From::kRows;
    if constexpr (kA >= 1 && kB > kA) {
      constexpr unsigned kUpA = 1u << (kA - 1), kUpB = 1u << (kB - 1), kAxes = 1u << kA | 1u << kB;
      if constexpr ((kRow & (kUpA | kUpB)) == 0) {
        const auto sum = [&](std::size_t to) HWY_ATTR {
          return hn::Add(hn::Add(from.at(kRow, to), from.at(kRow | kUpA, to)),
                         hn::Add(from.at(kRow | kUpB, to), from.at(kRow | kUpA | kUpB, to)));
        };
        const auto here = sum(at), next = sum(at + 1);
        means.take(kNumbers.of[kAxes][kRow << 1], 4, here);
        means.take(kNumbers.of[kAxes][kRow << 1 | 1], 4, next);
        means.take(kNumbers.of[kAxes | 1][kRow << 1], 8, hn::Add(here, next));
      }
    }
  });
}

/// Decides the squares along the row.
template <int N, class From, class D>
HWY_INLINE void take_means_along(const From& from, std::size_t at, Means<D>& means) {
  constexpr FaceNumbers<N> kNumbers;
  unrolled<N * From::kRows>([&](auto number) HWY_ATTR {
    constexpr unsigned kA = number / From::kRows, kRow = number % From::kRows;
    if constexpr (kA >= 1) {
      constexpr unsigned kUp = 1u << (kA - 1);
      if constexpr ((kRow & kUp) == 0) {
        const auto here = hn::Add(from.at(kRow, at), from.at(kRow | kUp, at));
        const auto next = hn::Add(from.at(kRow, at + 1), from.at(kRow | kUp, at + 1));
        means.take(kNumbers.of[1u << kA | 1u][kRow << 1], 4, hn::Add(here, next));
      }
    }
  });
}

/// Decides the tesseract and its cubes across the row.
HWY_INLINE void take_means_of_rows(const Samples<4>& from, std::size_t at, bool cubes, Means<D>& means) {
  const auto sum = [&](std::size_t to) HWY_ATTR {
    auto result = from.at(0, to);
    for (std::size_t row = 1; row < from.kRows; ++row) result = hn::Add(result, from.at(row, to));
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
      const auto scaled = hn::Mul(hn::LoadU(d, block.samples[r].data() + i), scale);
      so_far = hn::And(so_far, hn::And(hn::Eq(hn::Round(scaled), scaled), hn::Lt(hn::Abs(scaled), most)));
    }
  return hn::AllTrue(d, so_far);
}

/// The tiles from `at` on for which rounding may decide a face, as bits; those past the end of the row are not masked.
HWY_INLINE std::uint64_t unsure_from(std::size_t at, hn::Mask<D> sure) {
#if HWY_TARGET <= HWY_AVX3
  const std::uint64_t bits = sure.raw;
#else
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(D(), sure, bytes);
  const std::uint64_t bits = bytes[0];
#endif
  static_assert(hn::MaxLanes(D()) <= 8);
  return (~bits & ((1u << hn::Lanes(D())) - 1)) << at;
}

/// Sets `unsure`, but to none if nothing was rounded: if the samples are multiples of 2^-10 and less than `limit`.
template <int N>
HWY_INLINE void set_unsure(FaceBlock<N>& block, std::uint64_t unsure, bool may_be_exact, double limit) {
  block.unsure = unsure & (~std::uint64_t{0} >> (kWordBits - block.tiles));
  if (block.unsure != 0 && may_be_exact && are_whole(block, limit)) block.unsure = 0;
}

/// Decides as many faces as there are lanes. Returns the tiles of which rounding cannot decide a face.
template <int N, class From>
HWY_INLINE auto means_at(const From& from, std::size_t at, FaceBlock<N>& block) {
  Means<typename From::D> means(from.isovalue);
  take_means_across<N>(from, at, means);
  take_means_along<N>(from, at, means);
  if constexpr (N == 4) take_means_of_rows(from, at, true, means);
  means.highs.store(at, block);
  return hn::Gt(means.least, error_of_means(from, at));
}

/// Decides the faces of a block's tiles: by `decide(from, at)`, which returns the tiles of which rounding cannot decide
/// a face. Returns the tiles of such faces, as bits.
template <int N, class Decide>
HWY_INLINE std::uint64_t decide_block(FaceBlock<N>& block, double isovalue, const Decide& decide) {
  const D d;
  const Samples<N> samples{block, isovalue};
  std::uint64_t unsure = 0;
  if constexpr (N == 3 && HWY_TARGET != HWY_SCALAR) {
    const ShortDifferences<N> differences(block, isovalue);
    const typename ShortDifferences<N>::D twice;
    for (std::size_t i = 0; i < block.tiles; i += hn::Lanes(twice)) {
      const auto sure = decide(differences, i);
      if (HWY_LIKELY(hn::AllTrue(twice, hn::Or(sure, hn::Not(hn::FirstN(twice, block.tiles - i)))))) continue;
      for (const std::size_t at : {i, i + hn::Lanes(d)}) unsure |= unsure_from(at, decide(samples, at));
    }
  } else {
    for (std::size_t i = 0; i < block.tiles; i += hn::Lanes(d)) unsure |= unsure_from(i, decide(samples, i));
  }
  return unsure;
}

template <int N>
HWY_INLINE void means_of(FaceBlock<N>& block, double isovalue) {
  const std::uint64_t unsure = decide_block(
      block, isovalue, [&](const auto& from, std::size_t at) HWY_ATTR { return means_at<N>(from, at, block); });
  // Sums of 16 are then exact.
  set_unsure(block, unsure, true, 0x1p36);
}

/// Decides squares by their saddles. `least`: smallest absolute determinant.
template <class D>
struct Saddles {
  using T = hn::TFromD<D>;
  Highs<D> highs;
  hn::Vec<D> least;

  HWY_INLINE Saddles() : least(hn::Set(D(), hwy::HighestValue<T>())) {}
  /// Arguments: corner 0, its two neighbours, and the opposite corner, each minus the isovalue. -0 is a low value.
  template <class V>
  HWY_INLINE void take(unsigned face, V first, V second, V third, V last) {
    const D d;
    const auto determinant = hn::MulSub(first, last, hn::Mul(second, third));
    const auto of_high = hn::Xor(determinant, hn::And(first, hn::SignBit(d)));  // -0, if it is zero, counts as zero
    highs.take(face, hn::Ge(of_high, hn::Zero(d)));
    least = hn::Min(least, hn::Abs(determinant));
  }
  /// Tiles of which rounding cannot decide a square. `largest`: greatest absolute value of their differences. The
  /// rounding errors of a determinant of samples, fused or not, are at most 2^-50 of its square, if no product is
  /// denormal.
  template <class From>
  HWY_INLINE auto sure(hn::Vec<D> largest) const {
    const D d;
    const auto in_range =
        hn::And(hn::Gt(largest, hn::Set(d, From::kLeastOfSaddles)), hn::Lt(largest, hn::Set(d, From::kMostOfSaddles)));
    const auto error = hn::Mul(hn::Mul(largest, largest), hn::Set(d, From::kUnitOfSaddles));
    return hn::And(in_range, hn::Gt(least, error));
  }
};

/// Returns the greatest absolute value of the corners minus the isovalue.
template <int N, class From, class D>
HWY_INLINE auto take_saddles(const From& from, std::size_t at, Saddles<D>& saddles) {
  constexpr FaceNumbers<N> kNumbers;
  using T = hn::TFromD<D>;
  // Adding 0 and not subtracting it makes 0 of -0.
  [[maybe_unused]] const auto minus = hn::Set(D(), from.isovalue == T{0} ? T{0} : -from.isovalue);
  const auto difference = [&](std::size_t row, std::size_t to) HWY_ATTR {
    if constexpr (std::is_same_v<From, ShortDifferences<N>>)
      return from.at(row, to);  // -0 if a low value was rounded
    else
      return hn::Add(from.at(row, to), minus);
  };
  auto largest = hn::Zero(D());
  for (unsigned row = 0; row < From::kRows; ++row)
    for (unsigned side = 0; side < 2; ++side) largest = hn::Max(largest, hn::Abs(difference(row, at + side)));
  unrolled<N * From::kRows>([&](auto number) HWY_ATTR {
    constexpr unsigned kA = number / From::kRows, kRow = number % From::kRows;
    if constexpr (kA >= 1) {
      constexpr unsigned kUpA = 1u << (kA - 1);
      if constexpr ((kRow & kUpA) == 0) {
        saddles.take(kNumbers.of[1u << kA | 1u][kRow << 1], difference(kRow, at), difference(kRow, at + 1),
                     difference(kRow | kUpA, at), difference(kRow | kUpA, at + 1));
        unrolled<2 * N>([&](auto other) HWY_ATTR {
          constexpr unsigned kB = other / 2, kSide = other % 2;
          if constexpr (kB > kA) {
            constexpr unsigned kUpB = 1u << (kB - 1);
            if constexpr ((kRow & kUpB) == 0)
              saddles.take(kNumbers.of[1u << kA | 1u << kB][kRow << 1 | kSide], difference(kRow, at + kSide),
                           difference(kRow | kUpA, at + kSide), difference(kRow | kUpB, at + kSide),
                           difference(kRow | kUpA | kUpB, at + kSide));
          }
        });
      }
    }
  });
  return largest;
}

/// As means_at.
template <int N, class From>
HWY_INLINE auto saddles_at(const From& from, std::size_t at, FaceBlock<N>& block) {
  Saddles<typename From::D> saddles;
  const auto largest = take_saddles<N>(from, at, saddles);
  auto sure = saddles.template sure<From>(largest);
  if constexpr (N == 4) {
    Means<typename From::D> means(from.isovalue);
    take_means_of_rows(from, at, false, means);
    saddles.highs.bits = hn::Or(saddles.highs.bits, means.highs.bits);
    sure = hn::And(sure, hn::Gt(means.least, error_of_means(from, at)));
  }
  saddles.highs.store(at, block);
  return sure;
}

template <int N>
HWY_INLINE void saddles_of(FaceBlock<N>& block, double isovalue) {
  const std::uint64_t unsure = decide_block(
      block, isovalue, [&](const auto& from, std::size_t at) HWY_ATTR { return saddles_at<N>(from, at, block); });
  // Differences then have 25 bits, and products 50.
  constexpr double kMost = 0x1p14;
  const bool is_whole = std::abs(isovalue) < kMost && std::nearbyint(0x1p10 * isovalue) == 0x1p10 * isovalue;
  set_unsure(block, unsure, is_whole, kMost);
}

/// Conditions that numbers are positive (or not negative): lanes where all hold for certain, and where one certainly
/// fails.
struct Conditions {
  hn::Mask<D> all, none;

  HWY_INLINE Conditions() : all(hn::Eq(hn::Zero(D()), hn::Zero(D()))), none(hn::Lt(hn::Zero(D()), hn::Zero(D()))) {}
  /// `error`: of the number.
  HWY_INLINE void take(hn::Vec<D> number, hn::Vec<D> error) {
    all = hn::And(all, hn::Gt(number, error));
    none = hn::Or(none, hn::Lt(number, hn::Neg(error)));
  }
};

/// Stores the answers to the questions from `i` on. Up to the next whole register more are written.
HWY_INLINE void store_answers(hn::Mask<D> is_yes, hn::Mask<D> is_no, std::size_t i, JoinQuestions& questions) {
#if HWY_TARGET <= HWY_AVX3
  const auto yes = static_cast<__mmask16>(is_yes.raw), known = static_cast<__mmask16>(is_yes.raw | is_no.raw);
  const __m128i answers = _mm_mask_mov_epi8(_mm_set1_epi8(JoinQuestions::unsure), known, _mm_maskz_set1_epi8(yes, 1));
  static_assert(JoinQuestions::no == 0 && JoinQuestions::yes == 1);
  _mm_storel_epi64(reinterpret_cast<__m128i*>(questions.answers.data() + i), answers);
#else
  const D d;
  alignas(64) double result[hn::MaxLanes(d)];
  const auto of_others = hn::IfThenElse(is_no, hn::Zero(d), hn::Set(d, 2.0));
  hn::Store(hn::IfThenElse(is_yes, hn::Set(d, 1.0), of_others), d, result);
  for (std::size_t j = 0; j < hn::Lanes(d) && i + j < questions.count; ++j)
    questions.answers[i + j] = static_cast<JoinQuestions::Answer>(static_cast<int>(result[j]));
#endif
}

/// Answers as many questions as there are lanes, from `i` on. Same test as PairQuestion (saddle.cpp), without branches.
HWY_INLINE void answer_some(JoinQuestions& questions, double isovalue, std::size_t i) {
  const D d;
  const auto zero = hn::Zero(d);
  auto largest = zero;
  const auto end = [&](std::size_t e) HWY_ATTR {
    const auto difference = hn::Sub(hn::LoadU(d, questions.ends[e].data() + i), hn::Set(d, isovalue));
    largest = hn::Max(largest, hn::Abs(difference));
    return difference;
  };
  const auto twice = [](hn::Vec<D> x) HWY_ATTR { return hn::Add(x, x); };
  const auto sum_of_products = [](hn::Vec<D> x, hn::Vec<D> y, hn::Vec<D> z, hn::Vec<D> w)
                                   HWY_ATTR { return hn::Add(hn::Mul(x, y), hn::Mul(z, w)); };
  const auto difference_of_products = [](hn::Vec<D> x, hn::Vec<D> y, hn::Vec<D> z, hn::Vec<D> w)
                                          HWY_ATTR { return hn::Sub(hn::Mul(x, y), hn::Mul(z, w)); };
  // the polynomials of PairQuestion
  const auto a0 = end(0), a1 = end(1), c0 = end(2), c1 = end(3), b0 = end(4), b1 = end(5), d0 = end(6), d1 = end(7);
  const auto q0 = difference_of_products(a0, c0, b0, d0), q1 = difference_of_products(a1, c1, b1, d1);
  const auto m = hn::Sub(sum_of_products(a0, c1, a1, c0), sum_of_products(b0, d1, b1, d0));
  const auto u0 = hn::Sub(m, twice(q0)), u1 = hn::Sub(m, twice(q1));
  const auto a = sum_of_products(a0, u1, a1, u0), c = sum_of_products(c0, u1, c1, u0);
  const auto hyperdeterminant = hn::Sub(hn::Mul(m, m), twice(twice(hn::Mul(q0, q1))));
  const auto sign = hn::LoadU(d, questions.sign.data() + i);
  // Answers in rounded arithmetic. Bounds of the numbers by the largest difference M, with all signs positive: u: 8
  // M^2; a, c: 16 M^3; the hyperdeterminant: 32 M^4. Each term is rounded less than 12 times; no power of M is
  // denormal.
  const auto square = hn::Mul(largest, largest);
  const auto unit = hn::Set(d, 0x1p-48);
  const auto error_of_u = hn::Mul(square, hn::Mul(unit, hn::Set(d, 8.0)));
  const auto error_of_ends = hn::Mul(hn::Mul(error_of_u, largest), hn::Set(d, 2.0));
  const auto infinite = hn::Set(d, HUGE_VAL);
  const auto in_range = hn::And(hn::Gt(largest, hn::Set(d, 0x1p-230)), hn::Lt(largest, hn::Set(d, 0x1p230)));
  Conditions conditions;
  conditions.take(u0, hn::IfThenElse(in_range, error_of_u, infinite));
  conditions.take(u1, error_of_u);
  conditions.take(hn::Mul(sign, a), error_of_ends);
  conditions.take(hn::Mul(sign, c), error_of_ends);
  conditions.take(hyperdeterminant, hn::Mul(hn::Mul(error_of_u, square), hn::Set(d, 4.0)));
  const auto used = hn::FirstN(d, questions.count - i);
  auto is_yes = conditions.all, is_no = hn::And(in_range, conditions.none);
  if (!hn::AllFalse(d, hn::AndNot(hn::Or(is_yes, is_no), used))) {
    // Nothing was rounded if all values and the isovalue are multiples of 1/2 with 10 bits. A zero then counts as high.
    const auto is_short = [&](hn::Vec<D> value) HWY_ATTR {
      const auto halves = hn::Add(value, value);
      return hn::And(hn::Eq(hn::Round(halves), halves), hn::Le(hn::Abs(value), hn::Set(d, 0x1p9)));
    };
    auto is_whole = is_short(hn::Set(d, isovalue));
    for (const auto& values : questions.ends) is_whole = hn::And(is_whole, is_short(hn::LoadU(d, values.data() + i)));
    const auto least = hn::IfThenElse(hn::Gt(sign, zero), zero, hn::Set(d, 0x1p-60));  // below any such number
    const auto is_so = [&](hn::Vec<D> x) HWY_ATTR { return hn::Ge(hn::Mul(sign, x), least); };
    const auto is_inside = hn::And(hn::Gt(u0, zero), hn::Gt(u1, zero));
    const auto exactly = hn::And(hn::And(is_inside, hn::Ge(hyperdeterminant, least)), hn::And(is_so(a), is_so(c)));
    is_yes = hn::Or(hn::And(is_whole, exactly), hn::AndNot(is_whole, is_yes));
    is_no = hn::Or(hn::AndNot(exactly, is_whole), hn::AndNot(is_whole, is_no));
  }
  store_answers(is_yes, is_no, i, questions);
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

void ask_all(const FaceBlock<3>& block, const OpenCubes& cubes, JoinQuestions& questions) {
  const auto& joins = cube_joins();
  // the corners of one tile are a register, from which its ends are picked
  for (std::size_t q = 0; q < cubes.count; q += 8) {
    __m512d rows[8];
    for (std::size_t j = 0; j < 8; ++j) {
      const std::size_t i = std::min(q + j, cubes.count - 1), place = cubes.places[i];
      const auto two = [&](std::size_t row) HWY_ATTR { return _mm_loadu_pd(block.samples[row].data() + place); };
      const tables::CubeJoin& join = joins[cubes.entries[i]];
      const __m256d lower = _mm256_insertf128_pd(_mm256_castpd128_pd256(two(0)), two(1), 1);
      const __m256d upper = _mm256_insertf128_pd(_mm256_castpd128_pd256(two(2)), two(3), 1);
      const __m512i ends = _mm512_cvtepu8_epi64(_mm_loadu_si64(join.corners.data()));
      rows[j] = _mm512_permutexvar_pd(ends, _mm512_insertf64x4(_mm512_castpd256_pd512(lower), upper, 1));
      questions.sign[q + j] = JoinQuestions::kSigns[join.high];
    }
    store_transposed(rows, questions.ends[0].data() + q, JoinQuestions::kMost);
  }
  questions.count = cubes.count;
}

#else

void ask_all(const FaceBlock<3>& block, const OpenCubes& cubes, JoinQuestions& questions) {
  const auto& joins = cube_joins();
  for (std::size_t q = 0; q < cubes.count; ++q)
    questions.add(joins[cubes.entries[q]],
                  [&](unsigned corner) { return block.samples[corner >> 1][cubes.places[q] + (corner & 1u)]; });
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

void ask(const FaceBlock<3>& block, const OpenCubes& cubes, JoinQuestions& questions) noexcept {
  HWY_DYNAMIC_DISPATCH(ask_all)(block, cubes, questions);
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
