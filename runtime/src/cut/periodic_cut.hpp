// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of wrapped contours across a period: the simplices beside the hyperplane, next to each other.
//
// A contour with periods stands for its repetition by all multiples of the period's vector. Each point of the wrapped
// contour whose coordinate equals a place modulo the period is repeated once at this place, however the contour is
// divided at the seam. So the cut of the repetition by the hyperplane is the whole cut, and it is joined at the seam.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "base/periods.hpp"
#include "cut/hyperplane_family.hpp"
#include "tegl/contour.hpp"
#include "tegl/slice.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Whether hyperplanes cross a period, up to rounding.
template <int N>
bool crosses(const HyperplaneFamily<N>& family, const Period<N>& period) {
  const std::array<double, N - 1> vector = family.within(period.vector), dual = family.within(period.dual);
  double length = 0.0, inner = 0.0, share = 0.0;
  for (int a = 0; a < N; ++a) length += period.vector[a] * period.vector[a];
  for (int a = 0; a + 1 < N; ++a) inner += vector[a] * vector[a];
  for (int a = 0; a + 1 < N; ++a) share += dual[a] * vector[a];
  return std::abs(inner - length) > 1e-9 * length || std::abs(share - 1.0) > 1e-9;
}

/// How hyperplanes lie to the periods of a contour.
struct CrossedPeriods {
  std::size_t count = 0;   ///< how many they cross
  std::size_t period = 0;  ///< the last of these
  bool is_modulo = false;  ///< whether they are across an axis with this period along it: places are modulo it
};

template <int N>
CrossedPeriods crossed_periods(const HyperplaneFamily<N>& family, std::span<const Period<N>> periods) {
  CrossedPeriods result;
  for (std::size_t p = 0; p < periods.size(); ++p)
    if (crosses<N>(family, periods[p])) result = {result.count + 1, p, false};
  if (result.count != 1 || !family.is_across_axis()) return result;
  std::vector<Vector<N>> vectors;
  for (const Period<N>& period : periods) vectors.push_back(period.vector);
  result.is_modulo = period_along<N>(vectors, family.dropped_axis()) == result.period;
  return result;
}

/// The coordinate of the hyperplane <normal, x> = offset, moved by periods into the one that begins at the start of
/// `period`. For families across an axis.
template <int N>
double place_modulo(const HyperplaneFamily<N>& family, const Period<N>& period, double offset);

/// The simplices of a wrapped contour that touch places across an axis, moved there by multiples of one period. The
/// result has the other periods. A simplex that touches places in several multiples is there several times. Simplices
/// and vertices are in the order of the contour. `places`: coordinates rounded to Real, ascending. The contour
/// is one that require_sound accepts. InvalidArgument if a vertex is far from the period. O(#S + #V) time, plus O(c log
/// c) for c simplices of the result; 8 #V bytes plus O(c) memory.
template <int N, class Real>
Contour<N, Real> moved_to_places(const Contour<N, Real>& contour, std::size_t period, int axis,
                                 std::span<const double> places, const WorkOptions& work);

}  // namespace tegl::detail
