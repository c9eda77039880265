// SPDX-License-Identifier: BSD-3-Clause
//
// How parallel hyperplanes lie to the lattice of a contour's periods.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "cut/hyperplane_family.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The periods of a contour as parallel hyperplanes see them: in another basis of the same lattice, so that at most one
/// vector of the basis crosses the hyperplanes. Such a basis exists if the heights of the periods are multiples of one
/// height. The sum of multiples of the contour's periods is the sum of multiples of these, and the reverse.
template <int N>
struct CrossedPeriods {
  bool any = false;       ///< whether the hyperplanes cross a period
  bool has_cuts = true;   ///< whether `slice` makes cuts of the wrapped contour (`cuts_wrapped`)
  bool is_other = false;  ///< whether the basis is another one than the contour's periods

  // if they cross one, and there are cuts:
  /// The basis vectors along the hyperplanes. Those of another basis are short, and so are their dual vectors.
  std::vector<Period<N>> within = {};
  Period<N> across = {};               ///< the basis vector that crosses them
  std::vector<double> times = {};      ///< how many times `across` is in each period of the contour
  double height = 0.0;                 ///< of `across`; may be negative
  /// Whether the hyperplanes are across an axis, and `across` is along it up to rounding. Then cuts at places that
  /// differ by multiples of it are equal.
  bool is_straight = false;
};

/// Parts of vectors are compared by axis, as axes may have different units. A part is taken for rounding if it is less
/// than a millionth of the longest part of a period along this axis; if all are less than a millionth of their vectors,
/// then all of them. Throws nothing. O(r³) for r periods.
template <int N>
CrossedPeriods<N> crossed_periods(const HyperplaneFamily<N>& family, std::span<const Period<N>> periods);

/// A hyperplane, moved by multiples of `across` to the period that begins at its start.
struct MovedLevel {
  double level;  ///< the height there
  double times;  ///< how many times `across` from there to the hyperplane; 0 if the cuts are equal (`is_straight`)
};

/// The hyperplane <normal, x> = offset, moved into the period; its height is rounded to Real across an axis, as those
/// of vertices. The hyperplanes cross a period and have cuts.
template <class Real, int N>
MovedLevel level_in_period(const HyperplaneFamily<N>& family, const CrossedPeriods<N>& crossed, double offset);

/// Throws InvalidArgument if the cut at this offset is moved from its period (not `is_straight`), and is far from it.
/// `names`: of the axes, for the message.
template <int N>
void require_near(const HyperplaneFamily<N>& family, const CrossedPeriods<N>& crossed,
                  std::span<const std::string> names, double offset);

/// Whether a height is at most 2^29 periods from the start of `across`. Farther ones are too inexact.
template <int N>
bool is_near_period(const CrossedPeriods<N>& crossed, double height);
/// Throws InvalidArgument: `what` has a height that is not near. Numbers are those of the given normal.
template <int N>
[[noreturn]] void fail_far(const HyperplaneFamily<N>& family, const CrossedPeriods<N>& crossed,
                           std::span<const std::string> names, const std::string& what, double height);

}  // namespace tegl::detail
