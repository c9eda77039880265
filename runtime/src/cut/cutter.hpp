// SPDX-License-Identifier: BSD-3-Clause
//
// The cut of some simplices of a contour by a hyperplane: what all ways of cutting have in common.
#pragma once

#include <vector>

#include "cut/hyperplane_family.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The cut at `level` of the simplices `touching`: those that have vertices at or on both sides of it, ascending. No
/// other simplex of the contour has a part in the cut. O(c) for c of them, and O(c log c) if vertices lie at the level;
/// as much memory.
template <int N, class Real>
Contour<N - 1, Real> cut_simplices(const Contour<N, Real>& contour, const Section<N>& section, double level,
                                   const std::vector<Index>& touching);

}  // namespace tegl::detail
