// SPDX-License-Identifier: BSD-3-Clause
//
// The three orders of simplification: edges by quadrics, facets by curvature, vertices by distance.
#pragma once

#include <cstddef>
#include <functional>

#include "simplify/edge_collapse.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

struct CollapseGoal {
  std::size_t count = 0;     ///< stop at this number of simplices
  double max_curvature = 0;  ///< only for `collapse_by_curvature`
  bool by_mean = false;      ///< only for `collapse_by_quadrics`: by the mean of the squared distances, not their sum
  const Progress* progress = nullptr;
  double from = 0, to = 1;  ///< range of `progress` that this work covers
  unsigned threads = 1;     ///< only for `collapse_by_quadrics`; 0 for all of the machine
  /// Only for `collapse_by_quadrics`: contours of at least so many simplices are contracted in parts, at the same time,
  /// unless intersections are refused.
  /// Smaller ones are not worth the other order.
  std::size_t least_in_parts = 100'000;
  /// Called before the first contraction: from then on, one thread does much of the work.
  std::function<void()> ready = {};
};

/// Contracts until the goal is reached or no contraction is possible. Throws Cancelled.
template <int N>
void collapse_by_quadrics(EdgeCollapse<N>& collapse, const CollapseGoal& goal);
template <int N>
void collapse_by_curvature(EdgeCollapse<N>& collapse, const CollapseGoal& goal);
template <int N>
void collapse_by_distance(EdgeCollapse<N>& collapse, const CollapseGoal& goal);

}  // namespace tegl::detail
