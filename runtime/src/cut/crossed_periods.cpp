// SPDX-License-Identifier: BSD-3-Clause
//
// Based on: the Euclidean algorithm, on the heights of periods over a hyperplane.
#include "cut/crossed_periods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/orthonormal.hpp"
#include "base/slice_at.hpp"
#include "tegl/error.hpp"
#include "tegl/slice.hpp"

namespace tegl {
namespace detail {
namespace {

constexpr double kRounding = 1e-6;
/// Parts of a normal, beside the largest one: of doubles, such as cos(π/2), and of numbers in single precision.
constexpr double kNormalRounding = 16 * std::numeric_limits<double>::epsilon();
constexpr double kSingleRounding = 1e-7;
/// Multiples of periods in a basis. With more, real numbers would seem to be multiples of one height.
constexpr double kMostTimes = 32;
constexpr double kFarthest = 1 << 29;  ///< periods to vertices and levels

/// The vectors of periods without their parts that are rounding. A part that carries a share of its period (the product
/// with the dual vector does not depend on units) is none.
template <int N>
std::vector<Vector<N>> without_rounding(std::span<const Period<N>> periods) {
  std::vector<Vector<N>> vectors;
  std::vector<double> lengths;
  for (const Period<N>& period : periods) {
    vectors.push_back(period.vector);
    double square = 0.0;
    for (const double part : period.vector) square += part * part;
    lengths.push_back(std::sqrt(square));
  }
  for (int a = 0; a < N; ++a) {
    const auto is_small = [&](std::size_t p, double beside) {
      return std::abs(vectors[p][a]) <= kRounding * beside && std::abs(vectors[p][a] * periods[p].dual[a]) <= kRounding;
    };
    double most = 0.0;
    bool are_all_small = true;
    for (std::size_t p = 0; p < periods.size(); ++p) {
      most = std::max(most, std::abs(vectors[p][a]));
      are_all_small = are_all_small && is_small(p, lengths[p]);
    }
    for (std::size_t p = 0; p < periods.size(); ++p)
      if (are_all_small || is_small(p, most)) vectors[p][a] = 0.0;
  }
  return vectors;
}

/// The longest part of a vector along each axis.
template <int N>
Vector<N> longest_parts(const std::vector<Vector<N>>& vectors) {
  Vector<N> longest{};
  for (const Vector<N>& vector : vectors)
    for (int a = 0; a < N; ++a) longest[a] = std::max(longest[a], std::abs(vector[a]));
  return longest;
}

/// A normal without its parts that are rounding. Along an axis of periods, they may be those of single precision if
/// heights do not depend on them either.
template <int N>
Vector<N> without_rounding(Vector<N> normal, const Vector<N>& longest) {
  double most = 0.0, highest = 0.0;
  for (int a = 0; a < N; ++a) {
    most = std::max(most, std::abs(normal[a]));
    highest = std::max(highest, std::abs(normal[a]) * longest[a]);
  }
  for (double& part : normal) {
    const double height = std::abs(part) * longest[&part - normal.data()];
    if (std::abs(part) <= kNormalRounding * most ||
        (std::abs(part) <= kSingleRounding * most && height > 0.0 && height <= kRounding * highest))
      part = 0.0;
  }
  return normal;
}

/// Whether all axes that the normal has a part along are combinations of the vectors. If not, cuts would drift along an
/// axis that is not periodic. Axes are divided by `longest`, so that their units do not matter.
template <int N>
bool are_axes_combinations(const Vector<N>& normal, std::vector<Vector<N>> vectors, const Vector<N>& longest) {
  OrthonormalVectors<N> span;
  for (Vector<N>& vector : vectors) {
    double square = 0.0;
    for (int a = 0; a < N; ++a) {
      if (longest[a] > 0.0) vector[a] /= longest[a];
      square += vector[a] * vector[a];
    }
    span.add(vector, kRounding * std::sqrt(square));
  }
  for (int a = 0; a < N; ++a) {
    if (normal[a] == 0.0) continue;
    double square = 0.0;
    for (const double part : span.rest_of(unit_vector<N>(a))) square += part * part;
    if (square > kRounding * kRounding) return false;
  }
  return true;
}

/// A basis of the lattice of periods, first the periods themselves.
template <int N>
struct LatticeBasis {
  std::vector<Period<N>> periods;
  std::vector<Vector<N>> vectors;          ///< without_rounding
  std::vector<double> heights;             ///< of these
  std::vector<std::vector<double>> sums;   ///< by basis vector: how many times it has each period of the contour
  std::vector<std::vector<double>> times;  ///< by basis vector: how many times it is in each period of the contour

  /// Subtracts a multiple of one vector of the basis from another one. Their dual vectors change the other way round.
  void subtract(std::size_t from, double multiple, std::size_t other) {
    const auto add = [](auto& sum, const auto& part, double factor) {
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * part[i];
    };
    add(periods[from].vector, periods[other].vector, -multiple);
    add(vectors[from], vectors[other], -multiple);
    add(sums[from], sums[other], -multiple);
    heights[from] -= multiple * heights[other];
    add(periods[other].dual, periods[from].dual, multiple);
    add(times[other], times[from], multiple);
    periods[other].start += multiple * periods[from].start;
  }
  [[nodiscard]] bool is_small() const {
    for (const auto* rows : {&sums, &times})
      for (const std::vector<double>& row : *rows)
        for (const double factor : row)
          if (std::abs(factor) > kMostTimes) return false;
    return true;
  }
};

/// Changes a basis until at most one vector has a height above `rounding`: returns its number. None if the heights are
/// no small multiples of one height.
template <int N>
std::optional<std::size_t> reduce_heights(LatticeBasis<N>& basis, double rounding, bool& is_other) {
  const std::vector<double>& heights = basis.heights;
  while (true) {
    std::size_t least = heights.size();
    for (std::size_t p = 0; p < heights.size(); ++p)
      if (std::abs(heights[p]) > rounding &&
          (least == heights.size() || std::abs(heights[p]) < std::abs(heights[least])))
        least = p;
    bool are_others_within = true;
    for (std::size_t p = 0; p < heights.size(); ++p) {
      if (p == least || !(std::abs(heights[p]) > rounding)) continue;
      basis.subtract(p, std::round(heights[p] / heights[least]), least);
      are_others_within = false;
      is_other = true;
    }
    if (!basis.is_small()) return std::nullopt;
    if (are_others_within) return least;
  }
}

/// The inner product of vectors whose axes are divided by `longest`, so that their units do not matter.
template <int N>
double scaled_product(const Vector<N>& a, const Vector<N>& b, const Vector<N>& longest) {
  double sum = 0.0;
  for (int i = 0; i < N; ++i)
    if (longest[i] > 0.0) sum += a[i] / longest[i] * (b[i] / longest[i]);
  return sum;
}

/// Subtracts vectors along the hyperplanes from longer ones, until none gets shorter: simplices have smaller shares of
/// short periods.
template <int N>
void shorten_within(LatticeBasis<N>& basis, std::size_t across, const Vector<N>& longest) {
  const std::size_t count = basis.vectors.size();
  constexpr double kShorter = 1.0 - 1e-9;  // so that rounding does not go on
  bool is_shorter = true;
  while (is_shorter) {
    is_shorter = false;
    for (std::size_t p = 0; p < count; ++p)
      for (std::size_t q = 0; q < count; ++q) {
        if (p == q || p == across || q == across) continue;
        const Vector<N>&from = basis.vectors[p], &other = basis.vectors[q];
        const double square = scaled_product<N>(other, other, longest), both = scaled_product<N>(from, other, longest);
        const double multiple = std::round(both / square);
        const double before = scaled_product<N>(from, from, longest);
        if (multiple == 0.0 || !(before + multiple * (multiple * square - 2.0 * both) < kShorter * before)) continue;
        basis.subtract(p, multiple, q);
        is_shorter = true;
      }
  }
}

/// Lays the dual vectors of periods along the hyperplanes into these: the product with such a period does not change by
/// multiples of the normal, but points have smaller shares. The periods keep their starts at the start of `across`.
template <int N>
void lay_duals_within(CrossedPeriods<N>& crossed, const Vector<N>& normal, const Vector<N>& longest) {
  double square = 0.0;
  for (int a = 0; a < N; ++a) square += normal[a] * longest[a] * (normal[a] * longest[a]);
  for (Period<N>& period : crossed.within) {
    double both = 0.0;
    for (int a = 0; a < N; ++a) both += period.dual[a] * longest[a] * (normal[a] * longest[a]);
    for (int a = 0; a < N; ++a) period.dual[a] -= both / square * normal[a];
    period.start -= both / square * crossed.across.start * crossed.height;
  }
}

}  // namespace

template <int N>
CrossedPeriods<N> crossed_periods(const HyperplaneFamily<N>& family, std::span<const Period<N>> periods) {
  CrossedPeriods<N> result;
  LatticeBasis<N> basis{{periods.begin(), periods.end()}, without_rounding<N>(periods), {}, {}, {}};
  const Vector<N> longest = longest_parts<N>(basis.vectors);
  const Vector<N> normal = without_rounding<N>(family.normal(), longest);
  double most = 0.0;
  for (std::size_t p = 0; p < periods.size(); ++p) {
    double height = 0.0, sum = 0.0;
    for (int a = 0; a < N; ++a) {
      const double part = normal[a] * basis.vectors[p][a];
      height += part;
      sum += std::abs(part);
    }
    basis.heights.push_back(std::abs(height) > kRounding * sum ? height : 0.0);
    most = std::max(most, sum);
    std::vector<double>& row = basis.sums.emplace_back(periods.size(), 0.0);
    row[p] = 1.0;
  }
  basis.times = basis.sums;
  const double rounding = kRounding * most;
  const auto is_above = [](double least) { return [least](double height) { return std::abs(height) > least; }; };
  result.any = std::any_of(basis.heights.begin(), basis.heights.end(), is_above(0.0));
  if (!result.any) return result;
  // a height that is rounding beside those of other periods, but not beside its own parts, is no multiple of theirs
  result.has_cuts = are_axes_combinations<N>(normal, basis.vectors, longest) &&
                    std::count_if(basis.heights.begin(), basis.heights.end(), is_above(0.0)) ==
                        std::count_if(basis.heights.begin(), basis.heights.end(), is_above(rounding));
  if (!result.has_cuts) return result;
  const std::optional<std::size_t> across = reduce_heights(basis, rounding, result.is_other);
  result.has_cuts = across.has_value();
  if (!across) return result;
  if (result.is_other) shorten_within<N>(basis, *across, longest);
  for (std::size_t p = 0; p < periods.size(); ++p)
    if (p != *across) result.within.push_back(basis.periods[p]);
  result.across = basis.periods[*across];
  result.times = basis.times[*across];
  result.height = family.height(result.across.vector);
  if (result.is_other) lay_duals_within<N>(result, family.normal(), longest);
  result.is_straight = family.is_across_axis();
  for (int a = 0; a < N; ++a)
    if (a != family.dropped_axis() && std::abs(basis.vectors[*across][a]) > kRounding * longest[a])
      result.is_straight = false;
  return result;
}

template <class Real, int N>
MovedLevel level_in_period(const HyperplaneFamily<N>& family, const CrossedPeriods<N>& crossed, double offset) {
  const double level = family.template level<double>(offset);
  const bool is_place = family.is_across_axis();
  const double sign = is_place ? family.sign() : 1.0;
  const double along = sign * crossed.height, start = crossed.across.start * along;
  const double moved = place_in_period(sign * level, std::min(start, start + along), std::abs(along));
  return {sign * (is_place ? static_cast<double>(rounded_at<Real>(moved)) : moved),
          crossed.is_straight ? 0.0 : std::round((sign * level - moved) / along)};
}

template <int N>
void require_near(const HyperplaneFamily<N>& family, const CrossedPeriods<N>& crossed,
                  std::span<const std::string> names, double offset) {
  const double level = family.template level<double>(offset);
  if (crossed.any && !crossed.is_straight && !is_near_period(crossed, level))
    fail_far(family, crossed, names, "a slice across a period", level);
}

template <int N>
bool is_near_period(const CrossedPeriods<N>& crossed, double height) {
  return std::abs(height / crossed.height - crossed.across.start) <= kFarthest;
}

template <int N>
void fail_far(const HyperplaneFamily<N>& family, const CrossedPeriods<N>& crossed, std::span<const std::string> names,
              const std::string& what, double height) {
  const bool is_place = family.is_across_axis();
  const double factor = is_place ? family.sign() : family.unit();  // from heights to the numbers that were given
  const int axis = family.dropped_axis();
  const std::string& name = names[static_cast<std::size_t>(axis)];
  throw Error(
      ErrorCode::InvalidArgument,
      fmt::format("{} has {}, with the period {} from {}; expected at most {} periods from there", what,
                  is_place ? fmt::format("the coordinate {} along {}", factor * height,
                                         name.empty() ? fmt::format("axis {}", axis) : "the axis " + name)
                           : fmt::format("the coordinate {} along the normal", factor * height),
                  std::abs(factor * crossed.height), factor * crossed.across.start * crossed.height, kFarthest));
}

#define TEGL_INSTANTIATE_CROSSED(N)                                                                              \
  template CrossedPeriods<N> crossed_periods(const HyperplaneFamily<N>&, std::span<const Period<N>>);            \
  template MovedLevel level_in_period<float>(const HyperplaneFamily<N>&, const CrossedPeriods<N>&, double);      \
  template MovedLevel level_in_period<double>(const HyperplaneFamily<N>&, const CrossedPeriods<N>&, double);     \
  template void require_near(const HyperplaneFamily<N>&, const CrossedPeriods<N>&, std::span<const std::string>, \
                             double);                                                                            \
  template bool is_near_period(const CrossedPeriods<N>&, double);                                                \
  template void fail_far(const HyperplaneFamily<N>&, const CrossedPeriods<N>&, std::span<const std::string>,     \
                         const std::string&, double);
TEGL_INSTANTIATE_CROSSED(3)
TEGL_INSTANTIATE_CROSSED(4)
TEGL_INSTANTIATE_CROSSED(5)
#undef TEGL_INSTANTIATE_CROSSED

}  // namespace detail

double place_in_period(double place, double first, double period) {
  if (!std::isfinite(place) || !(period > 0.0) || !std::isfinite(period)) return place;
  const double moved = place - std::floor((place - first) / period) * period;
  return moved >= first + period ? first : std::max(moved, first);
}

template <int N>
requires DimensionBetween<N, 3, 5>
bool cuts_wrapped(std::type_identity_t<std::span<const Period<N>>> periods, const Hyperplane<N>& hyperplane) {
  return detail::crossed_periods<N>(detail::HyperplaneFamily<N>(hyperplane.normal), periods).has_cuts;
}

template <int N>
requires DimensionBetween<N, 3, 5> std::optional<CutPeriod<N>> cut_period(
    std::type_identity_t<std::span<const Period<N>>> periods, const std::type_identity_t<Vector<N>>& normal) {
  const detail::HyperplaneFamily<N> family(normal);
  const detail::CrossedPeriods<N> crossed = detail::crossed_periods<N>(family, periods);
  if (!crossed.any || !crossed.has_cuts) return std::nullopt;
  CutPeriod<N> period{crossed.across.vector, crossed.height * family.unit(), 0.0, crossed.is_straight};
  const double start = crossed.across.start * period.length;
  period.first = std::min(start, start + period.length);
  if (period.length < 0.0) {
    period.length = -period.length;
    for (double& part : period.vector) part = -part;
  }
  return period;
}

#define TEGL_INSTANTIATE_CUT_PERIODS(N)                                            \
  template bool cuts_wrapped<N>(std::span<const Period<N>>, const Hyperplane<N>&); \
  template std::optional<CutPeriod<N>> cut_period<N>(std::span<const Period<N>>, const Vector<N>&);
TEGL_INSTANTIATE_CUT_PERIODS(3)
TEGL_INSTANTIATE_CUT_PERIODS(4)
TEGL_INSTANTIATE_CUT_PERIODS(5)
#undef TEGL_INSTANTIATE_CUT_PERIODS

}  // namespace tegl
