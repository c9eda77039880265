// SPDX-License-Identifier: BSD-3-Clause
//
// Hydrogen-like orbitals.
//
// Based on: L. Pauling and E. B. Wilson, Introduction to Quantum Mechanics, 1935, chapter 5; Laguerre polynomials by
// their recurrence.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "field/field_parts.hpp"

namespace tegl::detail {

namespace {

void require_possible(const Orbital& orbital) {
  if (orbital.n < 1 || orbital.n > 12 || orbital.l < 0 || orbital.l >= orbital.n || std::abs(orbital.m) > orbital.l)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("quantum numbers n = {}, l = {}, m = {}; expected n from 1 to 12, l < n, |m| <= l",
                            orbital.n, orbital.l, orbital.m));
}

double factorial(int n) { return std::tgamma(n + 1.0); }

/// The associated Laguerre polynomial L_k^a(x).
double laguerre(int k, double a, double x) {
  double before = 1;
  if (k == 0) return before;
  double here = 1 + a - x;
  for (int i = 1; i < k; ++i) before = std::exchange(here, ((2 * i + 1 + a - x) * here - (i + a) * before) / (i + 1));
  return here;
}

/// The associated Legendre function P_l^m(x) for m >= 0, without the sign (-1)^m.
double legendre(int l, int m, double x) {
  double here = 1;
  const double sine = std::sqrt(std::max(0.0, 1 - x * x));
  for (int i = 1; i <= m; ++i) here *= (2 * i - 1) * sine;
  double before = 0;
  for (int i = m; i < l; ++i) before = std::exchange(here, ((2 * i + 1) * x * here - (i + m) * before) / (i - m + 1));
  return here;
}

double wave(const Orbital& of, double x, double y, double z) {
  constexpr double kPi = std::numbers::pi;
  const double r = std::sqrt(x * x + y * y + z * z);
  const double rho = 2 * r / of.n;
  const int m = std::abs(of.m);
  const double radial =
      std::sqrt(std::pow(2.0 / of.n, 3) * factorial(of.n - of.l - 1) / (2.0 * of.n * factorial(of.n + of.l))) *
      std::exp(-rho / 2) * std::pow(rho, of.l) * laguerre(of.n - of.l - 1, 2.0 * of.l + 1, rho);
  const double phi = std::atan2(y, x);
  const double around = of.m == 0 ? 1 : std::numbers::sqrt2 * (of.m > 0 ? std::cos(m * phi) : std::sin(m * phi));
  const double angular = std::sqrt((2.0 * of.l + 1) / (4 * kPi) * factorial(of.l - m) / factorial(of.l + m)) *
                         legendre(of.l, m, r > 0 ? z / r : 1) * around;
  return radial * angular;
}

}  // namespace

Field make_orbital(int dim, const Orbital& first, const Orbital& second, double extent) {
  require_possible(first);
  if (dim >= 4) require_possible(second);
  return field_by_point(dim, [=](const FieldPoint& at) {
    const double x = at[0] * extent;
    const double y = dim == 2 ? 0 : at[1] * extent;
    const double z = (dim == 2 ? at[1] : at[2]) * extent;
    const double one = wave(first, x, y, z);
    if (dim < 4) return one;
    const double other = wave(second, x, y, z);
    const double angle = std::numbers::pi / 4 * (1 + (dim == 5 ? at[4] : 0));
    const double of_first = std::cos(angle) * one, of_second = std::sin(angle) * other;
    return of_first * of_first + of_second * of_second + 2 * of_first * of_second * std::cos(std::numbers::pi * at[3]);
  });
}

}  // namespace tegl::detail
