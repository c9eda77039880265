// SPDX-License-Identifier: BSD-3-Clause
//
// The three orders in which a contour is simplified: edges by quadrics, facets by curvature, vertices by distance.
#pragma once

#include <cstddef>

#include "simplify/edge_collapse.hpp"
#include "tegl/error.hpp"

namespace tegl::detail {

struct ShrinkGoal {
  std::size_t count = 0;     ///< stop at so many simplices
  double max_curvature = 0;  ///< facets alone
  const Progress* progress = nullptr;
  double from = 0, to = 1;  ///< the part of the whole work that this is, for `progress`
};

/// Each contracts until the goal is reached or nothing is left that may be contracted. Throws Cancelled.
template <int N>
void shrink_by_quadrics(Shrinker<N>& shrinker, const ShrinkGoal& goal);
template <int N>
void shrink_by_curvature(Shrinker<N>& shrinker, const ShrinkGoal& goal);
template <int N>
void shrink_by_distance(Shrinker<N>& shrinker, const ShrinkGoal& goal);

}  // namespace tegl::detail
