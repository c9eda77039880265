// SPDX-License-Identifier: BSD-3-Clause
//
// Exact predicates by integers. The condition does not change if an axis is scaled, so the coordinates of each axis are
// multiplied by a power of two that makes all of them integers.
#include "intersect/exact_meeting.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <boost/multiprecision/cpp_int.hpp>

#include "intersect/meeting_tableau.hpp"

namespace tegl::detail {

namespace {

__extension__ using Short = __int128;
/// Products of two minors of coordinates with this number of bits or fewer fit into the type: 2 (4 bits + 10) + 1.
inline constexpr int kShortBits = 13;
using Long = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<1024, 1024, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, void>,
    boost::multiprecision::et_off>;
inline constexpr int kLongBits = 125;
using Unlimited =
    boost::multiprecision::number<boost::multiprecision::cpp_int_backend<>, boost::multiprecision::et_off>;

inline constexpr std::size_t kMostPoints = kMeetingColumns;

/// x = integer * 2^exponent. The integer is odd, or 0 with the largest exponent.
struct Dyadic {
  std::int64_t integer = 0;
  int exponent = std::numeric_limits<int>::max();
};

Dyadic dyadic_of(double x) {
  if (x == 0.0) return {};
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  const auto integer = static_cast<std::int64_t>(std::ldexp(fraction, std::numeric_limits<double>::digits));
  const int zeros = std::countr_zero(static_cast<std::uint64_t>(integer));
  return {integer / (std::int64_t{1} << zeros), exponent - std::numeric_limits<double>::digits + zeros};
}

/// Number of bits of an integer, without sign.
int width_of(std::int64_t x) { return static_cast<int>(std::bit_width(static_cast<std::uint64_t>(std::abs(x)))); }

/// Points with integer coordinates, relative to the first point.
class IntegerPoints {
 public:
  IntegerPoints(int dimension, std::span<const PointRef> points) : dimension_(static_cast<std::size_t>(dimension)) {
    for (std::size_t a = 0; a < dimension_; ++a) {
      int least = std::numeric_limits<int>::max(), most = std::numeric_limits<int>::min();
      for (std::size_t p = 0; p < points.size(); ++p) {
        const Dyadic x = parts_[p][a] = dyadic_of(points[p][a]);
        if (x.integer == 0) continue;
        least = std::min(least, x.exponent);
        most = std::max(most, x.exponent + width_of(x.integer));
      }
      least_[a] = least;
      if (most > least) bits_ = std::max(bits_, most - least + 1);  // one more for the difference of two
    }
    is_small_ = bits_ < 63;
    if (is_small_) subtract_first(points.size());
  }

  /// The largest number of bits of a coordinate, without sign.
  [[nodiscard]] int bits() const noexcept { return bits_; }
  [[nodiscard]] std::size_t dimension() const noexcept { return dimension_; }

  template <class Number>
  [[nodiscard]] std::array<Number, 4> point(std::size_t p) const {
    std::array<Number, 4> result{};
    for (std::size_t a = 0; a < dimension_; ++a) {
      if (is_small_)
        result[a] = Number(parts_[p][a].integer);
      else if constexpr (!std::is_same_v<Number, Short>)
        result[a] = integer<Number>(p, a) - integer<Number>(0, a);
    }
    return result;
  }

 private:
  void subtract_first(std::size_t count) {
    bits_ = 0;
    for (std::size_t a = 0; a < dimension_; ++a)
      for (std::size_t p = count; p-- > 0;) {  // the first point last
        parts_[p][a].integer = small(p, a) - small(0, a);
        bits_ = std::max(bits_, width_of(parts_[p][a].integer));
      }
  }
  [[nodiscard]] std::int64_t small(std::size_t p, std::size_t a) const {
    const Dyadic& x = parts_[p][a];
    return x.integer == 0 ? 0 : x.integer * (std::int64_t{1} << (x.exponent - least_[a]));
  }
  template <class Number>
  [[nodiscard]] Number integer(std::size_t p, std::size_t a) const {
    const Dyadic& x = parts_[p][a];
    return x.integer == 0 ? Number(0) : Number(Number(x.integer) << (x.exponent - least_[a]));
  }

  std::size_t dimension_;
  std::array<std::array<Dyadic, 4>, kMostPoints> parts_{};
  std::array<int, 4> least_{};
  int bits_ = 0;
  bool is_small_ = false;  ///< parts_ have the differences from the first point, without exponents
};

/// numerator / denominator, rounded.
template <class Number>
double ratio(const Number& numerator, const Number& denominator) {
  if constexpr (std::is_same_v<Number, Unlimited>) {
    return static_cast<double>(boost::multiprecision::cpp_rational(boost::multiprecision::cpp_int(numerator),
                                                                   boost::multiprecision::cpp_int(denominator)));
  } else {
    return static_cast<double>(numerator) / static_cast<double>(denominator);
  }
}

struct Groups {
  std::span<const PointRef> common, first, second;

  [[nodiscard]] std::size_t size() const { return common.size() + first.size() + second.size(); }
  [[nodiscard]] bool in_second(std::size_t column) const { return column >= common.size() + first.size(); }
};

/// The point whose weights solve the tableau.
template <class Number>
void place_of(const MeetingTableau<Number, false>& tableau, std::size_t dimension, std::span<const PointRef> points,
              const Groups& groups, double* place) {
  std::array<double, 4> sum{};
  double total = 0.0;
  tableau.visit_weights([&](std::size_t column, const Number& numerator, const Number& denominator) {
    const double weight = std::max(0.0, ratio(numerator, denominator));
    if (groups.in_second(column)) return;
    total += weight;
    for (std::size_t a = 0; a < dimension; ++a) sum[a] += weight * points[column][a];
  });
  for (std::size_t a = 0; a < dimension; ++a) place[a] = sum[a] / total;
}

template <class Number>
bool meet_in(const IntegerPoints& integers, std::span<const PointRef> points, const Groups& groups, double* place) {
  MeetingTableau<Number, false> tableau(integers.dimension(), groups.common.size(), groups.size());
  for (std::size_t column = 0; column < groups.size(); ++column)
    tableau.set_column(column, integers.point<Number>(column), groups.in_second(column));
  const bool meet = tableau.solve(Number(0), std::numeric_limits<std::size_t>::max()).value();
  if (meet) place_of(tableau, integers.dimension(), points, groups, place);
  return meet;
}

/// Calls visit with a number of the shortest integer type that suffices.
template <class Visit>
bool with_integers(const IntegerPoints& integers, const Visit& visit) {
  if (integers.bits() <= kShortBits) return visit(Short());
  if (integers.bits() <= kLongBits) return visit(Long());
  return visit(Unlimited());
}

/// Eliminates the edges from the first point by exact pivots: a row of zeros remains if they are dependent.
template <class Number>
bool are_dependent_in(const IntegerPoints& integers, std::size_t count) {
  std::array<std::array<Number, 4>, kMostPoints> rows;  // edges from the first point
  for (std::size_t p = 1; p < count; ++p) rows[p - 1] = integers.point<Number>(p);
  Number denominator(1);
  std::array<bool, 4> used{};
  for (std::size_t r = 0; r + 1 < count; ++r) {
    std::size_t column = 0;
    while (column < integers.dimension() && (used[column] || rows[r][column] == 0)) ++column;
    if (column == integers.dimension()) return true;
    used[column] = true;
    const Number pivot = rows[r][column];
    for (std::size_t i = r + 1; i + 1 < count; ++i) {
      const Number factor = rows[i][column];
      for (std::size_t a = 0; a < integers.dimension(); ++a)
        rows[i][a] = Number(Number(rows[i][a] * pivot) - Number(factor * rows[r][a])) / denominator;
    }
    denominator = pivot;
  }
  return false;
}

}  // namespace

bool meet_exactly(int dimension, std::span<const PointRef> common, std::span<const PointRef> first,
                  std::span<const PointRef> second, double* place) {
  std::array<PointRef, kMostPoints> all{};
  const Groups groups{common, first, second};
  auto next = std::copy(common.begin(), common.end(), all.begin());
  next = std::copy(first.begin(), first.end(), next);
  std::copy(second.begin(), second.end(), next);
  const std::span<const PointRef> points = std::span(all).first(groups.size());
  const IntegerPoints integers(dimension, points);
  return with_integers(integers, [&](auto zero) { return meet_in<decltype(zero)>(integers, points, groups, place); });
}

bool are_dependent(int dimension, std::span<const PointRef> points) {
  const IntegerPoints integers(dimension, points);
  return with_integers(integers, [&](auto zero) { return are_dependent_in<decltype(zero)>(integers, points.size()); });
}

}  // namespace tegl::detail
