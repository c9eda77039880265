// SPDX-License-Identifier: BSD-3-Clause
//
// Cut of some simplices of a contour by a hyperplane, shared by all cutting functions.
#pragma once

#include <span>

#include "cut/hyperplane_family.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The side of a level on which a vertex is. A vertex on the level counts as both.
enum class Side : unsigned char { below = 1, above = 2, on = 3 };

/// The cut at `level`. `touching`: ascending, all simplices with vertices at the level or on both sides of it; no other
/// simplex contributes to the cut. Threads: 0 for all of the machine; the result does not depend on them. O(c) time for
/// c of them, or O(c log c) if vertices lie at the level; O(c) memory. `sides`: of all vertices; empty if not known.
template <int N, class Real>
Contour<N - 1, Real> cut_simplices(const Contour<N, Real>& contour, const HyperplaneFamily<N>& family, double level,
                                   std::span<const Index> touching, unsigned threads = 1,
                                   std::span<const Side> sides = {});

}  // namespace tegl::detail
