// SPDX-License-Identifier: BSD-3-Clause
//
// Many cuts of a contour across its last axis, of which a few are in memory at a time.
#pragma once

#include <cstddef>
#include <span>

#include "base/function_ref.hpp"
#include "tegl/contour.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// A cut, and the numbers of the values at which it is: several if values are equal modulo a period, or rounded.
/// `threads`: of this cut.
template <int N, class Real>
using UseCut =
    FunctionRef<void(std::span<const std::size_t> places, const Contour<N - 1, Real>& cut, unsigned threads)>;

/// Calls `use` for the cut at each of the values `at` of the last coordinate, in any order, on several threads at a
/// time. Cuts are those of `slice`; if they cross a period, those of `slice` at the place in it that begins at the
/// seam: if the period is oblique to the last axis, the cut at the value is this one, moved. The contour is moved to
/// all these places once. If there are fewer cuts than threads, they are made one at a time on all threads. Errors: as
/// `slice`; those of `use`; Cancelled. O(#S + #V + h) time without `use`, for h pairs of a simplex and a cut that it
/// touches, plus O(c log c) to move c simplices, and O(#V + c) more for each 256 cuts. N = 3 to 5.
template <int N, class Real>
void for_each_cut(const Contour<N, Real>& contour, std::span<const double> at, const WorkOptions& work,
                  UseCut<N, Real> use);

}  // namespace tegl::detail
