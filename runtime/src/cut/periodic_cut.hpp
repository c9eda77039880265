// SPDX-License-Identifier: BSD-3-Clause
//
// Cuts of wrapped contours across a period: the simplices beside the hyperplane, next to each other.
//
// A contour with periods stands for its repetition by all sums of multiples of their vectors. Each point of the wrapped
// contour whose height equals a level modulo the period across is repeated once at this level, modulo the other
// periods, however the contour is divided at the seam. So the cut of the repetition by the hyperplane is the whole cut,
// and it is joined at the seam.
#pragma once

#include <span>

#include "cut/crossed_periods.hpp"
#include "cut/hyperplane_family.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// The simplices of a wrapped contour that touch hyperplanes across a period, moved there by multiples of it. The
/// result has the other periods (`crossed.within`). A simplex that touches levels in several multiples is there several
/// times. Simplices and vertices are in the order of the contour. `levels`: ascending, of `level_in_period`. The
/// contour is one that require_sound accepts; `crossed`: of its periods, with cuts. Throws InvalidArgument if the basis
/// is another one and a simplex is as long as half a period of it, or if a vertex is far from the period.
/// O(#S log k + #V) time for k levels, plus O(c log c) for c simplices of the result; 8 #V bytes for each period of the
/// contour that is crossed, plus O(c) memory.
template <int N, class Real>
Contour<N, Real> moved_to_levels(const Contour<N, Real>& contour, const HyperplaneFamily<N>& family,
                                 const CrossedPeriods<N>& crossed, std::span<const double> levels,
                                 const WorkOptions& work);

/// Moves a cut within its hyperplanes, as the cut that is `times` the period across further is: into its own periods.
/// O(#V) time.
template <int N, class Real>
void move_within(Contour<N - 1, Real>& cut, const HyperplaneFamily<N>& family, const CrossedPeriods<N>& crossed,
                 double times, unsigned threads);

}  // namespace tegl::detail
