// SPDX-License-Identifier: BSD-3-Clause
//
// Squares and cubes of the multilinear interpolant f, by the signs of polynomials in its values; see saddle.hpp.
//
// Let f have the isovalue subtracted, H = {f >= 0}, L = {f < 0}.
//
// Squares. An ambiguous square with high corners A, C and low ones B, D has its saddle at the value
// (A C - B D) / (A + C - B - D), whose denominator is positive: A and C are joined iff A C >= B D.
//
// Cubes. Cut the cube by the planes across one axis, at t in [0, 1]. In each, f is bilinear, with values A(t), B(t),
// C(t), D(t) at the corners, linear in t.
//
// First: from any point of H in a plane a path along the plane's two axes leads to a high corner of the plane and stays
// in H, since f is linear along each and so does not decrease one way. The same holds for L. So the pieces of H in the
// cube are what arises from the high parts of the four edges along the axis, two of which are joined where they are
// high in one plane and either neighbours (then the cube's surface joins them) or diagonal in an ambiguous plane with
// A C >= B D. (These pieces are closed, as H is; those of L, alike with A C > B D, are open, as L is.)
//
// Second: the high part of an edge hangs on a high corner of the cube, so it belongs to one region of H on the cube's
// surface (as the squares join corners). Two regions are joined inside the cube only by diagonal edges, inside the
// interval I of t where A and C are high and B and D are low. So are regions of L.
//
// Third: this must come out the same along every axis. Of all 656 signatures with decided squares there are 98 where
// joins of H along each of the three axes could lead to the same regions (and 98 for L, of which 8 are the same). In
// all of these H has two regions: three or four are never joined. Along one axis at least, just one pair of diagonal
// edges can do it. A test enumerates them. As the cube is a ball, the contour has as many pieces as H and L together,
// less one. That pieces with one loop are discs and those with two annuli is known (G. M. Nielson, On marching cubes,
// 2003); tests compare Euler characteristics.
//
// Fourth: q(t) = A C - B D is a quadratic. Let A and C be on different regions. At an end of I at which B or D becomes
// high the surface would join A and C: so there is none. At one where A or C becomes low, and at 0 and 1, where a
// square does not join them, q <= 0. So if they are joined, q has a maximum inside of I. With q(t) = q0 (1 - t)^2 + m t
// (1 - t) + q1 t^2, u0 = m - 2 q0 and u1 = m - 2 q1, it is at t : 1 - t = u0 : u1, if u0 and u1 are positive, and q >=
// 0 there iff m^2 >= 4 q0 q1 (the difference is the hyperdeterminant of the eight values, the same along every axis).
// If moreover A and C are high there, then B and D are low, or else the surface would join A and C. So the regions are
// joined iff
//     u0 > 0,  u1 > 0,  m^2 >= 4 q0 q1,  A0 u1 + A1 u0 >= 0,  C0 u1 + C1 u0 >= 0,
// where A0 and A1 are A at t = 0 and 1. For L, A and C being the low diagonal:
//     u0 > 0,  u1 > 0,  m^2 > 4 q0 q1,  A0 u1 + A1 u0 < 0,  C0 u1 + C1 u0 < 0.
#include "tegl/saddle.hpp"

#include <bit>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <type_traits>

#include <boost/multiprecision/cpp_int.hpp>

#include "tegl/generated/tables.hpp"

namespace tegl::detail {

namespace {

using facets::Choice;

/// A value minus the isovalue spans 2^-1074 ... 2^1025; the polynomials have degree 4 at most.
inline constexpr unsigned kExactBits = 4 * (1025 + 1074) + 16;
using Exact = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<kExactBits, kExactBits, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, void>,
    boost::multiprecision::et_off>;

/// x * y, of polynomials of degree 2. The library multiplies numbers of 40 limbs and more by Karatsuba's method, which
/// takes memory and leaves a leading zero in numbers of a fixed size (Boost 1.74): so one factor is cut in two.
template <class Number>
Number product(const Number& x, const Number& y) noexcept {
  return x * y;
}
template <>
Exact product(const Exact& x, const Exact& y) noexcept {
  constexpr unsigned kHalf = 33 * 64;
  const Exact size = abs(y), upper = size >> kHalf, lower = size - (upper << kHalf);
  const Exact result = ((x * upper) << kHalf) + x * lower;
  return y.sign() < 0 ? Exact(-result) : result;
}

/// Differences of at most 14 bits beside the sign, and of at most 30: the polynomials have four times as many and 5
/// more.
using Short = std::int64_t;
inline constexpr int kShortBits = 14;
using Middle = boost::multiprecision::int128_t;
inline constexpr int kMiddleBits = 30;

/// x = integer * 2^exponent; infinite as 2^1024.
struct Dyadic {
  std::int64_t integer;
  int exponent;
};

Dyadic dyadic(double x) noexcept {
  if (!std::isfinite(x)) return {x > 0.0 ? 1 : -1, std::numeric_limits<double>::max_exponent};
  if (x == 0.0) return {0, std::numeric_limits<double>::max_exponent};
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  auto integer = static_cast<std::int64_t>(std::ldexp(fraction, std::numeric_limits<double>::digits));
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(integer));
  return {integer / (std::int64_t{1} << zeros), exponent - std::numeric_limits<double>::digits + zeros};
}

/// Values minus the isovalue, times a power of two that makes all of them integers.
template <std::size_t kCorners>
std::array<Exact, kCorners> exact_differences(const std::array<double, kCorners>& values, double isovalue) noexcept {
  std::array<Dyadic, kCorners> parts;
  const Dyadic zero = dyadic(isovalue);
  int least = zero.exponent;
  for (std::size_t v = 0; v < kCorners; ++v) {
    parts[v] = dyadic(values[v]);
    least = std::min(least, parts[v].exponent);
  }
  const auto scaled = [&](const Dyadic& x) { return Exact(x.integer) << (x.exponent - least); };
  std::array<Exact, kCorners> result;
  for (std::size_t v = 0; v < kCorners; ++v) result[v] = scaled(parts[v]) - scaled(zero);
  return result;
}

/// The same as integers of kMiddleBits, the largest of just as many, if that is possible: whole numbers of few bits,
/// and floats of similar size.
template <std::size_t kCorners>
bool middle_differences(const std::array<double, kCorners>& values, double isovalue,
                        std::array<std::int64_t, kCorners>& result) noexcept {
  std::array<double, kCorners> differences;
  double most = 0.0;
  for (std::size_t v = 0; v < kCorners; ++v) {
    const double difference = differences[v] = values[v] - isovalue;
    // What was rounded off (D. E. Knuth, The Art of Computer Programming, vol. 2, 4.2.2).
    const double value_part = difference + isovalue;
    const double rest = (values[v] - value_part) + ((value_part - difference) - isovalue);
    if (!(rest == 0.0)) return false;  // or no number: infinite values
    most = std::max(most, std::abs(difference));
  }
  constexpr double kLeast = 0x1p-900, kMost = 0x1p+900;
  if (!(most >= kLeast && most <= kMost)) return false;
  const double scale = std::ldexp(1.0, kMiddleBits - 1 - std::ilogb(most));
  for (std::size_t v = 0; v < kCorners; ++v) {
    const double scaled = differences[v] * scale;
    result[v] = static_cast<std::int64_t>(scaled);
    if (static_cast<double>(result[v]) != scaled || (result[v] == 0 && differences[v] != 0.0)) return false;
  }
  return true;
}

/// A value minus the isovalue, rounded.
struct Difference {
  double value;
};

/// A number computed in doubles from differences, and the same with all signs positive. The relative error of a
/// difference is u = 2^-53; a sum adds one u, a product the errors of its factors and one u, relative to `size`. Of the
/// polynomials here, of degree 4 at most, none reaches 18 u. What underflows is far below kTiny; what overflows is
/// unsure.
struct Rounded {
  double value, size;

  static constexpr double kTiny = 0x1p-960;
  static constexpr double kError = 0x1p-48;  // 32 u
};

Rounded operator+(Rounded x, Rounded y) noexcept { return {x.value + y.value, x.size + y.size}; }
Rounded operator-(Rounded x, Rounded y) noexcept { return {x.value - y.value, x.size + y.size}; }
Rounded operator*(Rounded x, Rounded y) noexcept { return {x.value * y.value, x.size * y.size + Rounded::kTiny}; }
Rounded operator*(Difference x, Rounded y) noexcept {
  return {x.value * y.value, std::abs(x.value) * y.size + Rounded::kTiny};
}
Rounded operator*(Difference x, Difference y) noexcept {
  const double value = x.value * y.value;
  return {value, std::abs(value) + Rounded::kTiny};
}

enum class Answer : std::uint8_t { no, yes, unsure };

Answer is_positive(const Rounded& x) noexcept {
  const double error = x.size * Rounded::kError;
  // Without branches, which noise would mislead.
  const unsigned is_yes = x.value > error ? 1 : 0, is_no = x.value < -error ? 1 : 0;
  return static_cast<Answer>(2 - is_yes - 2 * is_no);
}
Answer is_negative(const Rounded& x) noexcept { return is_positive({-x.value, x.size}); }
Answer is_not_negative(const Rounded& x) noexcept { return is_positive(x); }

Answer answer_of(bool is_so) noexcept { return is_so ? Answer::yes : Answer::no; }
int sign_of(Short x) noexcept { return (x > 0) - (x < 0); }
template <class Integer>
int sign_of(const Integer& x) noexcept {
  return x.sign();
}
template <class Integer>
Answer is_positive(const Integer& x) noexcept {
  return answer_of(sign_of(x) > 0);
}
template <class Integer>
Answer is_negative(const Integer& x) noexcept {
  return answer_of(sign_of(x) < 0);
}
template <class Integer>
Answer is_not_negative(const Integer& x) noexcept {
  return answer_of(sign_of(x) >= 0);
}

/// One `no` is enough for no; all `yes` for yes.
Answer all_of(std::initializer_list<Answer> answers) noexcept {
  Answer result = Answer::yes;
  for (const Answer answer : answers) {
    if (answer == Answer::no) return answer;
    if (answer == Answer::unsure) result = answer;
  }
  return result;
}

/// The corners of a square, by their numbers in the tile.
using Square = std::array<std::uint8_t, 4>;

/// Whether an ambiguous square joins its high corners. A question is asked of f(corner).
struct SquareQuestion {
  Square square;
  bool first_is_high;

  template <class Values>
  Answer operator()(const Values& f) const noexcept {
    const auto determinant = f(square[0]) * f(square[3]) - f(square[1]) * f(square[2]);
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(determinant)>, Rounded>) {
      // What is zero is unsure: the sign alone differs, and no branch hangs on it.
      const Rounded of_high = {first_is_high ? determinant.value : -determinant.value, determinant.size};
      return is_positive(of_high);
    } else {
      if (first_is_high) return is_not_negative(determinant);
      return answer_of(is_positive(determinant) == Answer::no);
    }
  }
};

/// The corners of square 2 a + side.
constexpr std::array<Square, 6> kSquares = {
    {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}}};

/// A pair of diagonal edges along an axis: the lower corners of A, C and of the two others, B, D.
struct Pair {
  std::uint8_t a, c, b, d, step;
};
constexpr std::array<Pair, 6> kPairs = {
    {{0, 6, 2, 4, 1}, {2, 4, 0, 6, 1}, {0, 5, 1, 4, 2}, {1, 4, 0, 5, 2}, {0, 3, 1, 2, 4}, {1, 2, 0, 3, 4}}};

/// For an entry of kTile3Resolved: the pair that can join two regions of a sign, + 1; 0: none can.
struct Joins {
  std::uint8_t high = 0, low = 0;
};

/// Regions of the corners of one sign, as the cube's surface joins them.
class Regions {
 public:
  Regions(unsigned corners, unsigned ambiguous, unsigned joined_squares) {
    for (std::uint8_t v = 0; v < 8; ++v) region_[v] = v;
    for (unsigned v = 0; v < 8; ++v)
      for (unsigned step = 1; step < 8; step *= 2)
        if (((corners >> v) & 1u) != 0 && ((corners >> (v ^ step)) & 1u) != 0) join(v, v ^ step);
    for (unsigned q = 0; q < 6; ++q) {
      if (((ambiguous & joined_squares) >> q & 1u) == 0) continue;
      const auto& s = kSquares[q];
      if ((corners >> s[0] & 1u) != 0)
        join(s[0], s[3]);
      else
        join(s[1], s[2]);
    }
  }
  [[nodiscard]] std::uint8_t operator[](unsigned corner) const { return region_[corner]; }

  void join(unsigned v, unsigned w) {
    const std::uint8_t from = region_[v], to = region_[w];
    std::replace(region_.begin(), region_.end(), from, to);
  }
  /// How many, of the corners given.
  [[nodiscard]] int count(unsigned corners) const {
    unsigned seen = 0;
    for (unsigned v = 0; v < 8; ++v)
      if ((corners >> v & 1u) != 0) seen |= 1u << region_[v];
    return std::popcount(seen);
  }

 private:
  std::array<std::uint8_t, 8> region_{};
};

/// Whether a pair of edges could join two regions. `corners`: those of the regions' sign.
bool could_join(const Pair& pair, unsigned corners, const Regions& regions) {
  const auto has = [&](unsigned v) { return (corners >> v & 1u) != 0; };
  const auto end_of = [&](unsigned v) { return has(v) ? v : v + pair.step; };
  const auto stays = [&](unsigned v) { return has(v) && has(v + pair.step); };
  const unsigned a = end_of(pair.a), c = end_of(pair.c);
  return has(a) && has(c) && !stays(pair.b) && !stays(pair.d) && regions[a] != regions[c];
}

/// The pair that decides whether regions are joined, + 1; 0: none are. Third, above.
std::uint8_t deciding_pair(unsigned corners, unsigned ambiguous, unsigned joined_squares) {
  const Regions regions(corners, ambiguous, joined_squares);
  if (regions.count(corners) != 2) return 0;
  std::uint8_t deciding = 0;
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    const bool first = could_join(kPairs[2 * axis], corners, regions);
    const bool second = could_join(kPairs[2 * axis + 1], corners, regions);
    if (!first && !second) return 0;
    if (first != second) deciding = static_cast<std::uint8_t>(2 * axis + (first ? 1 : 2));
  }
  return deciding;
}

struct JoinTable {
  std::array<Joins, 656> of;

  JoinTable() {
    for (unsigned s = 0; s < 256; ++s) {
      const unsigned ambiguous = tables::kTile3Resolved.ambiguous_squares[s];
      unsigned entry = tables::kTile3Resolved.first_entry[s], high = 0;
      do {
        of[entry++] = {deciding_pair(s, ambiguous, high), deciding_pair(~s & 0xffu, ambiguous, ~high)};
        high = (high - ambiguous) & ambiguous;
      } while (high != 0);
    }
  }
};

const Joins& joins_of(unsigned entry) noexcept {
  static const JoinTable table;
  return table.of[entry];
}

/// Whether A and C of a pair of edges are joined inside the cube: fourth, above.
struct PairQuestion {
  Pair pair;
  bool high;

  template <class Values>
  Answer operator()(const Values& f) const noexcept {
    const auto &a0 = f(pair.a), &a1 = f(pair.a + pair.step), &c0 = f(pair.c), &c1 = f(pair.c + pair.step);
    const auto &b0 = f(pair.b), &b1 = f(pair.b + pair.step), &d0 = f(pair.d), &d1 = f(pair.d + pair.step);
    const auto q0 = a0 * c0 - b0 * d0, q1 = a1 * c1 - b1 * d1;
    const auto m = a0 * c1 + a1 * c0 - b0 * d1 - b1 * d0;
    const auto u0 = m - q0 - q0, u1 = m - q1 - q1;
    const Answer is_inside = all_of({is_positive(u0), is_positive(u1)});
    if (is_inside == Answer::no) return is_inside;
    const auto a = a0 * u1 + a1 * u0, c = c0 * u1 + c1 * u0, q = product(q0, q1);
    const auto hyperdeterminant = product(m, m) - q - q - q - q;
    if (high) return all_of({is_inside, is_not_negative(a), is_not_negative(c), is_not_negative(hyperdeterminant)});
    return all_of({is_inside, is_negative(a), is_negative(c), is_positive(hyperdeterminant)});
  }
};

/// A cube whose squares are decided, by the answers to questions about it; nothing if one of them is unsure.
struct CentreDecider {
  unsigned entry;

  template <class Values>
  bool operator()(const Values& f, Choice& result) const noexcept {
    result = Choice::separate;
    const Joins& joins = joins_of(entry);
    for (const bool high : {true, false}) {
      const std::uint8_t pair = high ? joins.high : joins.low;
      if (pair == 0) continue;
      const Answer is_joined = PairQuestion{kPairs[pair - 1u], high}(f);
      if (is_joined == Answer::unsure) return false;
      if (is_joined == Answer::no) continue;
      result = high ? Choice::high : Choice::low;
      break;
    }
    return true;
  }
};

/// The same of a cube as a whole.
struct CubeDecider {
  unsigned signature;

  template <class Values>
  bool operator()(const Values& f, CubeDecision& result) const noexcept {
    result = {};
    unsigned entry = tables::kTile3Resolved.first_entry[signature], bit = 1;
    for (unsigned rest = tables::kTile3Resolved.ambiguous_squares[signature]; rest != 0; rest &= rest - 1, bit *= 2) {
      const auto q = static_cast<unsigned>(std::countr_zero(rest));
      const Answer is_high = SquareQuestion{kSquares[q], (signature >> kSquares[q][0] & 1u) != 0}(f);
      if (is_high == Answer::unsure) return false;
      const unsigned is_joined = is_high == Answer::yes ? 1 : 0;
      result.high_squares = static_cast<std::uint8_t>(result.high_squares | is_joined << q);
      entry += is_joined * bit;
    }
    return CentreDecider{entry}(f, result.centre);
  }
};

struct SquareDecider {
  bool first_is_high;

  template <class Values>
  bool operator()(const Values& f, bool& result) const noexcept {
    const Answer answer = SquareQuestion{{0, 1, 2, 3}, first_is_high}(f);
    result = answer == Answer::yes;
    return answer != Answer::unsure;
  }
};

template <class Result, std::size_t kCorners, class Decider>
Result decide_exactly(const std::array<double, kCorners>& values, double isovalue, const Decider& decider) noexcept {
  const auto differences = exact_differences(values, isovalue);
  Result result{};
  decider([&](unsigned v) -> const Exact& { return differences[v]; }, result);
  return result;
}

/// Where rounding could decide: by the shortest integers that will do.
template <class Result, std::size_t kCorners, class Decider>
[[gnu::noinline, gnu::cold]] Result decide_by_integers(const std::array<double, kCorners>& values, double isovalue,
                                                       const Decider& decider) noexcept {
  std::array<std::int64_t, kCorners> differences;
  if (!middle_differences(values, isovalue, differences)) return decide_exactly<Result>(values, isovalue, decider);
  constexpr int kSpare = kMiddleBits - kShortBits;
  std::int64_t bits = 0;
  for (const std::int64_t difference : differences) bits |= difference;
  Result result{};
  if (bits % (std::int64_t{1} << kSpare) == 0)
    decider([&](unsigned v) { return Short{differences[v] / (std::int64_t{1} << kSpare)}; }, result);
  else
    decider([&](unsigned v) { return Middle(differences[v]); }, result);
  return result;
}

template <class Result, std::size_t kCorners, class Decider>
Result decide(const std::array<double, kCorners>& values, double isovalue, const Decider& decider) noexcept {
  std::array<double, kCorners> differences;
  for (std::size_t v = 0; v < kCorners; ++v) differences[v] = values[v] - isovalue;
  Result result{};
  if (decider([&](unsigned v) { return Difference{differences[v]}; }, result)) return result;
  return decide_by_integers<Result>(values, isovalue, decider);
}

}  // namespace

bool square_is_high(const std::array<double, 4>& values, double isovalue) noexcept {
  return decide<bool>(values, isovalue, SquareDecider{values[0] >= isovalue});
}

bool square_is_high_exactly(const std::array<double, 4>& values, double isovalue) noexcept {
  return decide_exactly<bool>(values, isovalue, SquareDecider{values[0] >= isovalue});
}

CubeDecision decide_cube(const std::array<double, 8>& values, double isovalue, unsigned signature) noexcept {
  return decide<CubeDecision>(values, isovalue, CubeDecider{signature});
}

const std::array<CubeJoin, 656>& cube_joins() noexcept {
  static const auto kJoins = [] {
    std::array<CubeJoin, 656> result{};
    for (unsigned entry = 0; entry < result.size(); ++entry) {
      const Joins& joins = joins_of(entry);
      CubeJoin& join = result[entry];
      join.pairs = static_cast<std::uint8_t>((joins.high != 0) + (joins.low != 0));
      if (join.pairs != 1) continue;
      join.high = joins.high != 0;
      const Pair& pair = kPairs[(join.high ? joins.high : joins.low) - 1u];
      unsigned at = 0;
      for (const std::uint8_t lower : {pair.a, pair.c, pair.b, pair.d})
        for (const unsigned end : {unsigned{lower}, unsigned{lower} + pair.step})
          join.corners[at++] = static_cast<std::uint8_t>(end);
    }
    return result;
  }();
  return kJoins;
}

Choice decide_centre(const std::array<double, 8>& values, double isovalue, unsigned entry) noexcept {
  return decide<Choice>(values, isovalue, CentreDecider{entry});
}

CubeDecision decide_cube_exactly(const std::array<double, 8>& values, double isovalue) noexcept {
  return decide_exactly<CubeDecision>(values, isovalue, CubeDecider{signature_of(values, isovalue)});
}

}  // namespace tegl::detail
