// SPDX-License-Identifier: BSD-3-Clause
//
// Polya-Burnside count for the n-cube from cycle types.
//
// A conjugacy class of B_n is a pair of partitions, of a and of n - a: the lengths of the positive and of the
// negative cycles of axes. All that Burnside's lemma needs follows from them:
//   elements   2^n n! / prod over cycle lengths k of either sign, m of them: (2k)^m m!
//   fixed      g^m splits a cycle of length k into d = gcd(k, m) cycles; they are positive, with 2^d corners of the
//              k-cube fixed, unless the cycle is negative and m / d odd: then no corner is fixed
//   cycles     on corners: the mean of fixed(g^m) over one period m = 1 ... L, L a multiple of g's order
//   odd        a negative cycle moves every corner in every odd power, so that there is no corner cycle of odd length;
//              without negative cycles corner 0 up to conjugation is fixed, a cycle of length 1
//   det        (-1)^(k-1) for each positive and (-1)^k for each negative cycle
#include "symmetry/counting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/error.hpp"

namespace tegl::gen {
namespace {

/// All partitions of n, parts descending.
std::vector<std::vector<int>> partitions(int n, int largest) {
  if (n == 0) {
    return {{}};
  }
  std::vector<std::vector<int>> result;
  for (int part = std::min(n, largest); part >= 1; --part) {
    for (std::vector<int>& rest : partitions(n - part, part)) {
      rest.insert(rest.begin(), part);
      result.push_back(std::move(rest));
    }
  }
  return result;
}

/// Product of (2k)^m m! over the distinct lengths k, with m cycles each: the number of ways in which elements of B_n
/// that commute with g act on the cycles of one sign.
std::uint64_t centraliser_factor(const std::vector<int>& lengths) {
  std::uint64_t factor = 1;
  std::uint64_t repeats = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    repeats = i > 0 && lengths[i] == lengths[i - 1] ? repeats + 1 : 1;
    factor *= 2 * static_cast<std::uint64_t>(lengths[i]) * repeats;
  }
  return factor;
}

/// Number of corners fixed by g^m.
std::uint64_t fixed_corners(const CycleType& type, int m) {
  std::uint64_t fixed = 1;
  for (const int k : type.positive) {
    fixed <<= std::gcd(k, m);
  }
  for (const int k : type.negative) {
    const int d = std::gcd(k, m);
    if (m / d % 2 != 0) {
      return 0;
    }
    fixed <<= d;
  }
  return fixed;
}

std::uint64_t count_corner_cycles(const CycleType& type) {
  int period = 1;
  for (const int k : type.positive) {
    period = std::lcm(period, k);
  }
  for (const int k : type.negative) {
    period = std::lcm(period, 2 * k);
  }
  std::uint64_t fixed = 0;
  for (int m = 1; m <= period; ++m) {
    fixed += fixed_corners(type, m);
  }
  const auto divisor = static_cast<std::uint64_t>(period);
  if (fixed % divisor != 0) {
    throw Error(ErrorCode::Internal, fmt::format("{} fixed corners in {} powers: expected a multiple", fixed, period));
  }
  return fixed / divisor;
}

int determinant_of(const CycleType& type) {
  int reflections = 0;
  for (const int k : type.positive) {
    reflections += k - 1;
  }
  for (const int k : type.negative) {
    reflections += k;
  }
  return reflections % 2 == 0 ? 1 : -1;
}

}  // namespace

std::vector<CycleType> cycle_types(int n) {
  const std::uint64_t order = group_order(n, GroupKind::Full, false);
  std::vector<CycleType> types;
  std::uint64_t elements = 0;
  for (int in_positive = 0; in_positive <= n; ++in_positive) {
    for (const std::vector<int>& positive : partitions(in_positive, in_positive)) {
      for (const std::vector<int>& negative : partitions(n - in_positive, n - in_positive)) {
        CycleType type;
        type.positive = positive;
        type.negative = negative;
        type.elements = order / (centraliser_factor(positive) * centraliser_factor(negative));
        type.corner_cycles = count_corner_cycles(type);
        type.det = determinant_of(type);
        elements += type.elements;
        types.push_back(std::move(type));
      }
    }
  }
  if (elements != order) {
    throw Error(ErrorCode::Internal,
                fmt::format("the cycle types of the {}-cube have {} elements: expected {}", n, elements, order));
  }
  return types;
}

WideUint burnside_orbits(int n, GroupKind kind, bool inversion) {
  const std::size_t order = group_order(n, kind, inversion);
  WideUint sum;
  for (const CycleType& type : cycle_types(n)) {
    if (kind == GroupKind::Rotations && type.det < 0) {
      continue;
    }
    WideUint fixed = WideUint::power_of_two(static_cast<int>(type.corner_cycles));
    fixed *= type.elements;
    sum += fixed;
    if (inversion && type.corner_cycles_all_even()) {
      sum += fixed;
    }
  }
  return sum.exactly_divided_by(order);
}

}  // namespace tegl::gen
